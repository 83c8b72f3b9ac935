// The core of plumb, compiled to WebAssembly: text in, text and records out.

export type Vec3 = [number, number, number];

export interface CatalogueEntry {
  id: string;
  name: string;
  title: string;
  source: string;
  known_limit: string;
  whole_log: boolean;
  parameters: { name: string; unit: string; standard: string; sweep: string }[];
}

/** A row of the paper's Table 2 as it is printed; sets of sensors as bits. */
export interface Table2Row {
  number: number;
  faulty: number;
  level: string;
  detected: boolean;
  isolated: number;
  faults: string[];
}

export interface Vocabulary {
  capacity: number;
  states: string[];
  events: string[];
  causes: string[];
  validities: string[];
  modes: string[];
  table: { mode: number; event: number; target: string }[];
  catalogue: CatalogueEntry[];
  records: string[];
  table2: Table2Row[];
  flight_events: string[];
  flight_causes: string[];
  flight_validities: string[];
}

/** From station to station, a roll test, or a flight. */
export type Motion = "stations" | "roll" | "drone" | "drilling" | "car" | "launch";
export const isFlight = (motion: Motion): boolean => motion !== "stations" && motion !== "roll";

export interface Scene {
  axes: Vec3[];
  /** The chip of every sensor, counted from 1; 0: a unit of its own. */
  chips: number[];
  motion: Motion;
  /** Of a flight. */
  duration_s: number;
  noise_mps2: number;
  truth_seed: number;
  stand_seed: number;
  seed: number;
  stations: number;
  inclination_deg: number;
  build_deg: number;
  toolface_step_deg: number;
  dwell_s: number;
  move_s: number;
  vibration_mps2: number;
  faults: string[];
  requests: string[];
}

export interface Begun {
  samples: number;
  duration_s: number;
  stations: number;
  faults: string[];
  /** Why the paper's rule is not there; empty where it is. */
  paper_absent: string;
  /** Bits of the sensors of each unit that PX4 chooses between. */
  px4_units: number[];
}

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  plumb_text(bytes: number): number;
  plumb_answer(): number;
  plumb_vocabulary(): number;
  plumb_builtin(): number;
  plumb_study(): number;
  plumb_begin(): number;
  plumb_files(): number;
  plumb_run(samples: number): number;
  plumb_records(): number;
  plumb_record_count(): number;
  plumb_digest(): number;
}

/** What the core refuses: what was found, and how to mend it. */
export class Refusal extends Error {}

/** The core asks the machine for nothing: what its C library would ask for is refused. */
function nothing(module: WebAssembly.Module): WebAssembly.Imports {
  const imports: Record<string, Record<string, () => number>> = {};
  for (const wanted of WebAssembly.Module.imports(module)) {
    (imports[wanted.module] ??= {})[wanted.name] = () => 52; // wasi: not supported
  }
  return imports;
}

export class Core {
  readonly words: Vocabulary;
  /** Where a figure stands in a record. */
  readonly at: Record<string, number> = {};

  private constructor(private readonly wasm: Exports) {
    wasm._initialize();
    this.words = JSON.parse(this.answer(wasm.plumb_vocabulary()));
    this.words.records.forEach((name, k) => (this.at[name] = k));
  }

  static async load(bytes: BufferSource): Promise<Core> {
    const module = await WebAssembly.compile(bytes);
    const instance = await WebAssembly.instantiate(module, nothing(module));
    return new Core(instance.exports as unknown as Exports);
  }

  builtin(name: string): Vec3[] {
    this.ask(name);
    return this.told(this.wasm.plumb_builtin());
  }

  // eslint-disable-next-line @typescript-eslint/no-explicit-any
  study(design: { name: string; axes: Vec3[]; chips?: number[]; noise_mps2: number; samples: number; map?: number }): any {
    this.ask(JSON.stringify(design));
    return this.told(this.wasm.plumb_study());
  }

  begin(scene: Scene): Begun {
    this.ask(JSON.stringify(scene));
    return this.told(this.wasm.plumb_begin());
  }

  /** The scene that began last as files of the tool, by name. */
  files(): Record<string, string> {
    return this.told(this.wasm.plumb_files());
  }

  /** Steps at most so many samples; 0 at the end. */
  run(samples: number): number {
    return this.wasm.plumb_run(samples);
  }

  /** All records so far: `words.records.length` numbers each. They move with the next step. */
  records(): Float64Array {
    const count = this.wasm.plumb_record_count() * this.words.records.length;
    return new Float64Array(this.wasm.memory.buffer, this.wasm.plumb_records(), count);
  }

  /** Over every field of every verdict, as the native build prints it. */
  digest(): string {
    return this.digests()[0];
  }

  /** Over what was decided: states, causes, sets of sensors and events alone. */
  decisions(): string {
    return this.digests()[1];
  }

  private digests(): [string, string] {
    const halves = [...new Float64Array(this.wasm.memory.buffer, this.wasm.plumb_digest(), 4)].map((half) => half.toString(16).padStart(8, "0"));
    return [halves[0] + halves[1], halves[2] + halves[3]];
  }

  private ask(text: string): void {
    const bytes = new TextEncoder().encode(text);
    const at = this.wasm.plumb_text(bytes.length);
    new Uint8Array(this.wasm.memory.buffer, at, bytes.length).set(bytes);
  }

  private answer(length: number): string {
    return new TextDecoder().decode(new Uint8Array(this.wasm.memory.buffer, this.wasm.plumb_answer(), length));
  }

  // eslint-disable-next-line @typescript-eslint/no-explicit-any
  private told(length: number): any {
    const said = JSON.parse(this.answer(length));
    if (said !== null && typeof said === "object" && "error" in said) throw new Refusal(said.error);
    return said;
  }
}
