// One run that was stepped: its records by name, and what each rule made of it.
import type { Begun, Core, Scene } from "./core";
import { isFlight } from "./core";
import { wholeUnits } from "./geometry";

/** What one rule said over a whole run. */
export interface Score {
  /** Units that it excluded or left that were really faulty, and when the first of them; NaN: none. */
  right_s: number;
  /** Sensors that it blamed though their unit was healthy. */
  wrong: number;
  /** Largest error of an output that it took for good: rad at rest, m/s^2 in flight. */
  worst: number;
  /** The bound that plumb stated with it; NaN: none. */
  bound: number;
}

export type Rule = "plumb" | "paper" | "px4" | "plain";

export class Run {
  readonly flight: boolean;
  private readonly width: number;

  constructor(
    private readonly core: Core,
    readonly scene: Scene,
    readonly begun: Begun,
    private readonly records: Float64Array,
  ) {
    this.width = core.words.records.length;
    this.flight = isFlight(scene.motion);
  }

  get count(): number {
    return this.records.length / this.width;
  }

  of(k: number, name: string): number {
    return this.records[k * this.width + this.core.at[name]];
  }

  column<T>(name: string, f: (x: number) => T): T[] {
    const at = this.core.at[name];
    return Array.from({ length: this.count }, (_, k) => f(this.records[k * this.width + at]));
  }

  has(rule: Rule): boolean {
    if (rule === "paper") return this.begun.paper_absent === "";
    return rule !== "px4" || this.begun.px4_units.length > 0;
  }

  /** Bits of the sensors that a rule holds for faulty at sample k. */
  blamed(rule: Rule, k: number): number {
    if (rule === "plumb") return this.of(k, "excluded") | this.of(k, "provisionally_excluded");
    if (rule === "paper") return this.of(k, "paper_out") | 0;
    return rule === "px4" ? this.of(k, "px4_selector") | this.of(k, "px4_voter") : 0;
  }

  /** Name of the error of a rule's output. */
  errorName(rule: Rule): string {
    if (this.flight) return { plumb: "force_error_mps2", paper: "paper_error_rad", px4: "px4_force_mps2", plain: "plain_force_mps2" }[rule];
    return { plumb: "error_rad", paper: "paper_error_rad", px4: "px4_error_rad", plain: "plain_rad" }[rule];
  }

  /** Whether a rule takes its output of sample k for good. */
  trusts(rule: Rule, k: number): boolean {
    const valid = this.core.words.validities.length - 1;
    if (rule === "plumb") return this.of(k, "validity") === (this.flight ? this.core.words.flight_validities.length - 1 : valid);
    return rule !== "paper" || this.of(k, "paper_validity") === valid;
  }

  /** Whom a rule may blame: units as it knows them, with a faulty member. */
  private mayBlame(rule: Rule, faulty: number): number {
    const own = rule === "px4" ? this.begun.px4_units.filter((unit) => unit & faulty) : [];
    return own.reduce((all, unit) => all | unit, wholeUnits(this.scene.chips, faulty));
  }

  score(rule: Rule): Score {
    const out: Score = { right_s: NaN, wrong: 0, worst: NaN, bound: NaN };
    let faulty = 0;
    for (let k = 0; k < this.count; ++k) {
      faulty |= this.of(k, "faulty");
      const may = this.mayBlame(rule, faulty);
      const blamed = this.blamed(rule, k);
      if (blamed & may && Number.isNaN(out.right_s)) out.right_s = this.of(k, "time_s");
      out.wrong |= blamed & ~may;
      const error = this.of(k, this.errorName(rule));
      if (!this.trusts(rule, k) || error <= out.worst || !Number.isFinite(error)) continue;
      out.worst = error;
      if (rule === "plumb") out.bound = this.of(k, this.flight ? "force_bound_mps2" : "protection_rad");
    }
    return out;
  }

  /** When the first sensor failed; NaN: never. */
  onset_s(): number {
    for (let k = 0; k < this.count; ++k) if (this.of(k, "faulty")) return this.of(k, "time_s");
    return NaN;
  }
}
