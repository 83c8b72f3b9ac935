// Which fault sets still explain what was seen: they become fewer with every attitude.
import { byId, make, sensorsOf } from "./dom";
import { unitsOf, unitWords } from "./geometry";
import type { Run } from "./run";

/** s_i of a sensor that no explanation leaves healthy. */
const kNone = 255;

/** The explanations at sample k, in words and as one mark for each unit. */
export function showSets(run: Run, k: number): void {
  const chips = run.scene.chips;
  const out = run.of(k, "excluded") | run.of(k, "provisionally_excluded");
  const suspects = run.of(k, "suspects");
  const least = run.flight ? run.of(k, "hypotheses") : leastFaults(run, k);
  const units = unitsOf(chips);
  const marks = units.map((unit) => {
    const [kind, words] =
      (unit & out) !== 0 ? ["is-out", "excluded"]
      : least > 0 && (unit & suspects) !== 0 ? ["is-suspect", least === 1 ? "explains all" : "in an explanation"]
      : least > 0 ? ["is-cleared", "does not explain it"]
      : ["", ""];
    return make("li", { class: kind }, unitWords(chips, unit), words ? make("span", { class: "note" }, ` ${words}`) : null);
  });
  const sets = run.flight || run.of(k, "hypotheses") === 0 ? "" : `${run.of(k, "hypotheses")} of ${mostSets(run)} sets of sensors are still consistent, after ${run.of(k, "on_record")} attitudes on record. `;
  const words =
    least === 0 && !run.flight && run.of(k, "hypotheses") === 0 ? "Those in service leave no set that could be tested against another."
    : least === 0 ? "No fault is needed to explain what was read."
    : least === kNone ? "No fault set that can be searched for explains it."
    : least === 1 ? `One fault explains it: ${sensorsOf(suspects)}${count(units, suspects) > 1 ? ", and which one is open." : "."}`
    : `It takes ${least} faults at least to explain it.`;
  byId("sets").replaceChildren(make("p", { "aria-live": "off" }, sets + words), make("ul", { class: "sets", "aria-label": "Units" }, ...marks));
}

/** Most steps that are listed. */
const kSteps = 10;

/** Every time that an attitude took explanations away: who could still be the faulty one. */
export function listShrinking(run: Run, seek: (time_s: number) => void): void {
  const chips = run.scene.chips;
  const units = unitsOf(chips);
  const items: HTMLElement[] = [];
  let before = "";
  const [tick, event] = [run.column("tick"), run.column("event")];
  for (let k = 0; k < run.count && items.length < kSteps; ++k) {
    if (tick[k] === 0 && event[k] < 0) continue; // between two blocks nothing is decided; a flight has no ticks
    const least = run.flight ? run.of(k, "hypotheses") : leastFaults(run, k);
    const suspects = run.of(k, "suspects");
    const sets = run.flight ? 0 : run.of(k, "hypotheses");
    const now = least > 0 && (suspects || least === kNone) ? `${least} ${suspects} ${sets}` : "";
    if (now !== before && now) {
      const named = units.filter((unit) => unit & suspects).map((unit) => unitWords(chips, unit));
      const who = least === kNone ? "nothing that can be searched for" : `${least > 1 ? `${least} faults, of ` : ""}${named.join(" or ")}${named.length === 1 ? " alone" : ""}`;
      const time_s = run.of(k, "time_s");
      items.push(make("li", {}, make("button", { type: "button", class: "link", onclick: () => seek(time_s) }, `${time_s.toFixed(run.flight ? 3 : 2)} s: ${who}${run.flight ? "" : `, ${sets} of ${mostSets(run)} sets left`}`)));
    }
    before = now;
  }
  byId("shrink-head").hidden = items.length === 0;
  byId("shrink").hidden = items.length === 0;
  byId("shrink").replaceChildren(...items);
}

function leastFaults(run: Run, k: number): number {
  const out = run.of(k, "excluded") | run.of(k, "provisionally_excluded") | run.of(k, "absent");
  const monitored = run.scene.axes.map((_, i) => i).filter((i) => !((out >> i) & 1));
  return Math.min(...monitored.map((i) => run.of(k, `minimum_faults_${i + 1}`)), kNone);
}

let counted: Run | null = null;
let most = 0;
function mostSets(run: Run): number {
  if (counted !== run) most = run.column("hypotheses").reduce((a, b) => Math.max(a, b), 0);
  counted = run;
  return most;
}

const count = (units: number[], bits: number): number => units.filter((unit) => (unit & bits) !== 0).length;
