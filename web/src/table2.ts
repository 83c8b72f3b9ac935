// The paper's Table 2: its 23 experiments, what is printed, and what three rules say here.
import type { Core, Scene, Table2Row } from "./core";
import { byId, make, sensorsOf } from "./dom";
import type { Geometry } from "./geometry";
import { stateWords } from "./machine";
import { Run } from "./run";
import { kPresets, sceneOf } from "./scenes";

/** The first station with the fault: the tool has proven itself by then. */
const kFaultStation = 9;

export const experimentFaults = (row: Table2Row): string[] => row.faults.map((text) => `${text}@station${kFaultStation}`);

/** The scene of one experiment on the paper's tool. */
export function experimentScene(geometry: Pick<Geometry, "axes" | "chips" | "noise_mps2">, row: Table2Row): Scene {
  const preset = kPresets.find((one) => one.id === "table2")!;
  return sceneOf(geometry, { ...preset.scene, faults: experimentFaults(row) });
}

/** What the rules say at the end of a run. */
function outcome(core: Core, run: Run, row: Table2Row): string[] {
  const end = run.count - 1;
  const who = (bits: number) => (bits ? sensorsOf(bits) : "-");
  const ever = (list: Int32Array) => list.reduce((all, bits) => all | bits, 0);
  const plumb = run.blamed("plumb")[end];
  const state = stateWords(core.words.states[run.of(end, "state")]);
  return [
    who(row.isolated),
    who(ever(run.blamed("paper"))),
    plumb ? who(plumb) : row.faulty ? `- (${state})` : "-",
    who(ever(run.blamed("px4"))),
    plumb === row.faulty ? "right" : plumb & ~row.faulty ? "blames a healthy one" : "withheld",
  ];
}

export class Table2 {
  private chosen = 2;
  private playing = 0;
  private frame = 0;
  private done = new Map<number, string[]>();

  /** `choose`: play this experiment in the view; `hold`: step nothing meanwhile, for there is one core. */
  constructor(
    private readonly core: Core,
    private readonly choose: (row: Table2Row) => void,
    private readonly hold: () => void,
  ) {}

  /** The view steps something else. */
  stop(): void {
    if (this.playing === 0) return;
    cancelAnimationFrame(this.frame);
    this.playing = 0;
    this.draw();
  }

  show(on: boolean): void {
    byId("table2").hidden = !on;
    if (on) this.draw();
  }

  /** The experiment that is chosen. */
  now(): Table2Row {
    return this.core.words.table2[this.chosen - 1];
  }

  private draw(): void {
    const head = ["experiment", "faulty", "voltage", "isolated, printed", "paper's rule here", "plumb", "PX4", "plumb's answer"];
    const rows = this.core.words.table2.map((row) => {
      const said = this.done.get(row.number) ?? [row.isolated ? sensorsOf(row.isolated) : "-", "", "", "", ""];
      const play = make("button", { type: "button", class: "link", "aria-pressed": String(row.number === this.chosen), onclick: () => {
        this.chosen = row.number;
        this.draw();
        this.choose(row);
      } }, `no. ${row.number}`);
      return make("tr", { class: row.number === this.chosen ? "is-chosen" : undefined },
        ...[play, row.faulty ? sensorsOf(row.faulty) : "-", row.level, ...said].map((cell) => make("td", {}, cell)));
    });
    const all = make("button", { type: "button", id: "table2-all", disabled: this.playing > 0, onclick: () => this.playAll() },
      this.playing ? `Playing ${this.playing} of ${rows.length}` : "Play all 23");
    byId("table2").replaceChildren(
      make("div", { class: "card wide low", tabindex: 0, role: "region", "aria-label": "Table 2 of the paper" },
        make("table", {}, make("thead", {}, make("tr", {}, ...head.map((text) => make("th", { scope: "col" }, text)))), make("tbody", {}, ...rows))),
      make("div", { class: "controls" }, all),
      make("p", { class: "note" }, "Printed: Seyed Moosavi, Moaveni, Moshiri, Arvan, Sensors 2018, Table 2, CC BY 4.0. Random is one level here, drawn and kept. Two faulty sensors of four cannot be isolated: plumb then withholds its output."),
    );
  }

  /** One experiment a frame; the one that is shown comes back at the end. */
  private playAll(): void {
    const shape = { axes: this.core.builtin("paper-tetrahedron"), chips: [0, 0, 0, 0], noise_mps2: 2e-4 * 9.80665 };
    const rows = this.core.words.table2;
    const next = (k: number) => {
      if (k === rows.length) {
        this.stop();
        this.choose(rows[this.chosen - 1]);
        return;
      }
      this.playing = k + 1;
      const scene = experimentScene(shape, rows[k]);
      const begun = this.core.begin(scene);
      while (this.core.run(1000) > 0) continue;
      this.done.set(rows[k].number, outcome(this.core, new Run(this.core, scene, begun, this.core.records()), rows[k]));
      this.draw();
      this.frame = requestAnimationFrame(() => next(k + 1));
    };
    this.playing = 1;
    this.draw();
    this.hold();
    this.frame = requestAnimationFrame(() => next(0));
  }
}
