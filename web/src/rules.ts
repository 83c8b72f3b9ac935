// What three rules say of the same samples: plumb, the paper's, and PX4's choice between units of three sensors.
import type { Core } from "./core";
import { byId, deg, figure, make, sensorsOf, table } from "./dom";
import { kStateColours, stateWords } from "./machine";
import type { Rule, Run, Score } from "./run";

const kRules: [Rule, string][] = [
  ["plumb", "plumb"],
  ["paper", "the paper's rule"],
  ["px4", "PX4's choice of a unit"],
  ["plain", "all sensors averaged"],
];

export class Rules {
  private run: Run | null = null;
  private scores = new Map<Rule, Score>();
  private blamed = new Map<Rule, Int32Array>();
  private now: HTMLElement[][] = [];

  constructor(private readonly core: Core) {}

  show(run: Run): void {
    this.run = run;
    this.scores = new Map(kRules.filter(([rule]) => run.has(rule)).map(([rule]) => [rule, run.score(rule)]));
    this.blamed = new Map(kRules.map(([rule]) => [rule, run.blamed(rule)]));
    this.now = kRules.map(() => ["says", "blames", "off"].map(() => make("span")));
    const rows = kRules.map(([rule, words], r) => [words, ...this.now[r], ...this.summary(rule)]);
    byId("rules").replaceChildren(
      table("Three rules on the same samples", ["rule", "says now", "blames now", "off now by", "named a faulty one", "blamed a healthy one", "largest error it took for good"], rows));
    byId("rules-words").textContent = this.notes();
  }

  at(k: number): void {
    const run = this.run;
    if (!run) return;
    kRules.forEach(([rule], r) => {
      const [says, blames, off] = this.now[r];
      if (!run.has(rule)) return says.replaceChildren("not there");
      says.replaceChildren(this.says(rule, k));
      blames.textContent = rule === "plain" ? "nobody, ever" : this.blames(rule, k);
      off.textContent = this.size(run.of(k, run.errorName(rule)));
    });
  }

  private says(rule: Rule, k: number): Node | string {
    const run = this.run!;
    const words = this.core.words;
    if (rule === "plain") return "an answer";
    if (rule === "px4") return `uses ${sensorsOf(run.of(k, "px4_in_use"))}`;
    if (run.flight) return words.flight_validities[run.of(k, "validity")];
    const [state, validity] = rule === "paper" ? ["paper_state", "paper_validity"] : ["state", "validity"];
    const which = run.of(k, state);
    const pill = make("span", { class: "state", style: `--state:${kStateColours[which]}` }, stateWords(words.states[which]));
    return make("span", {}, pill, ` output ${words.validities[run.of(k, validity)]}`);
  }

  private blames(rule: Rule, k: number): string {
    const run = this.run!;
    const blamed = this.blamed.get(rule)?.[k] ?? 0;
    const suspects = rule === "plumb" ? run.of(k, "suspects") : rule === "paper" ? run.of(k, "paper_suspects") : 0;
    if (blamed) return sensorsOf(blamed);
    return suspects ? `suspects ${sensorsOf(suspects)}` : "nobody";
  }

  private size(error: number): string {
    return this.run!.flight ? figure(error, "m/s\u00b2") : deg(error);
  }

  private summary(rule: Rule): (string | Node)[] {
    const score = this.scores.get(rule);
    if (!score) return ["", "", ""];
    const onset = this.run!.onset_s();
    const late = score.right_s - onset;
    const right = Number.isNaN(onset) ? "nothing to name" : Number.isNaN(late) ? "never" : `after ${figure(late, "s")}`;
    const wrong = score.wrong ? make("span", { class: "tone-bad" }, sensorsOf(score.wrong)) : "no";
    const bound = Number.isNaN(score.bound) ? "" : `, bound ${this.size(score.bound)}`;
    return [right, rule === "plain" ? "no" : wrong, this.size(score.worst) + bound];
  }

  private notes(): string {
    const { begun, flight } = this.run!;
    const out: string[] = [];
    if (begun.paper_absent) out.push(`The paper's rule is not there: ${begun.paper_absent}.`);
    const units = begun.px4_units.map(sensorsOf).join("; ");
    if (begun.px4_units.length === 0) out.push("PX4 needs chips of three axes, and this array has none.");
    else if (begun.px4_units.length === 1) out.push(`PX4 chooses between chips of three axes. Here it has one (${units}) and nothing to compare it with.`);
    else out.push(`PX4 chooses between ${units}; its limits are those that it ships with (1 m/s\u00b2 for 2 m/s).`);
    out.push(flight ? "Taken for good: bounded, as plumb says it; PX4 and the average always are." : "Taken for good: output valid; PX4 and the average always are.");
    return out.join(" ");
  }
}
