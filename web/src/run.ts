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
  private readonly columns = new Map<string, Float64Array>();

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

  /** All figures of a name, one a sample. */
  column(name: string): Float64Array {
    let out = this.columns.get(name);
    if (!out) {
      out = new Float64Array(this.count);
      const at = this.core.at[name];
      for (let k = 0; k < out.length; ++k) out[k] = this.records[k * this.width + at];
      this.columns.set(name, out);
    }
    return out;
  }

  has(rule: Rule): boolean {
    if (rule === "paper") return this.begun.paper_absent === "";
    return rule !== "px4" || this.begun.px4_units.length > 0;
  }

  /** Bits of the sensors that a rule holds for faulty, one set a sample. */
  blamed(rule: Rule): Int32Array {
    const names = { plumb: ["excluded", "provisionally_excluded"], paper: ["paper_out"], px4: ["px4_selector", "px4_voter"], plain: [] }[rule];
    const out = new Int32Array(this.count);
    for (const name of this.has(rule) ? names : []) this.column(name).forEach((bits, k) => (out[k] |= bits));
    return out;
  }

  /** Name of the error of a rule's output. */
  errorName(rule: Rule): string {
    if (this.flight) return { plumb: "force_error_mps2", paper: "paper_error_rad", px4: "px4_force_mps2", plain: "plain_force_mps2" }[rule];
    return { plumb: "error_rad", paper: "paper_error_rad", px4: "px4_error_rad", plain: "plain_rad" }[rule];
  }

  /** The validity from which on a rule takes its output for good, and where it stands; null: always. */
  private trusted(rule: Rule): [string, number] | null {
    const { validities, flight_validities } = this.core.words;
    if (rule === "plumb") return ["validity", (this.flight ? flight_validities : validities).length - 1];
    return rule === "paper" ? ["paper_validity", validities.length - 1] : null;
  }

  /** Whom a rule may blame: units as it knows them, with a faulty member. */
  private mayBlame(rule: Rule, faulty: number): number {
    const own = rule === "px4" ? this.begun.px4_units.filter((unit) => unit & faulty) : [];
    return own.reduce((all, unit) => all | unit, wholeUnits(this.scene.chips, faulty));
  }

  score(rule: Rule): Score {
    const out: Score = { right_s: NaN, wrong: 0, worst: NaN, bound: NaN };
    const [time, faulty, blamed, error] = [this.column("time_s"), this.column("faulty"), this.blamed(rule), this.column(this.errorName(rule))];
    const trusted = this.trusted(rule);
    const validity = trusted ? this.column(trusted[0]) : null;
    let ever = 0;
    let may = 0;
    let worst = -1;
    for (let k = 0; k < this.count; ++k) {
      if (faulty[k] & ~ever) {
        ever |= faulty[k];
        may = this.mayBlame(rule, ever);
      }
      if (blamed[k] & may && Number.isNaN(out.right_s)) out.right_s = time[k];
      out.wrong |= blamed[k] & ~may;
      if (validity && validity[k] !== trusted![1]) continue;
      if (error[k] > (worst < 0 ? -1 : error[worst])) worst = k;
    }
    if (worst < 0) return out;
    out.worst = error[worst];
    if (rule === "plumb") out.bound = this.of(worst, this.flight ? "force_bound_mps2" : "protection_rad");
    return out;
  }

  /** When the first sensor failed; NaN: never. */
  onset_s(): number {
    const first = this.column("faulty").findIndex((bits) => bits !== 0);
    return first < 0 ? NaN : this.of(first, "time_s");
  }
}
