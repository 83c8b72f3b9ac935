// The second view: the monitor, stepped in the page over a tool that breaks.
import { Core, isFlight, Refusal, type Begun, type Motion, type Scene, type Table2Row } from "./core";
import { byId, deg, degrees, figure, make, sensorsOf, table } from "./dom";
import { FaultList, faultText, onSensors, parseFault, type Fault } from "./faults";
import { shapeOf, type Geometry } from "./geometry";
import { Lanes } from "./lanes";
import { kStateColours, Machine, stateWords } from "./machine";
import { Rules } from "./rules";
import { Run } from "./run";
import { kPresets, sceneOf } from "./scenes";
import { listShrinking, showSets } from "./sets";
import { Sphere, type Direction } from "./sphere";
import { experimentFaults, Table2 } from "./table2";
import { drawable, Timeline, type Series } from "./timeline";

/** What one slice of stepping may take of a frame [ms]. */
const kSlice_ms = 6;
const kSliceSamples = 50;

const kMotions: [Motion, string][] = [
  ["stations", "From station to station"],
  ["roll", "Roll test"],
  ["drone", "Flight: drone"],
  ["drilling", "Flight: turning drill string"],
  ["car", "Flight: car"],
  ["launch", "Flight: launcher"],
];

/** What the address of the page keeps of this view. */
export interface SharedRun {
  story: string;
  tool: string;
  motion: Motion;
  faults: string[];
  /** 0: the end */
  time_s: number;
}

export class Break {
  private readonly machine: Machine;
  private readonly timeline = new Timeline((time_s) => this.seek(time_s));
  private readonly lanes = new Lanes((time_s) => this.seek(time_s));
  private readonly rules: Rules;
  private readonly table2: Table2;
  private readonly faults: FaultList;
  private readonly sphere = new Sphere("The true direction and what plumb says, in the frame of the tool. The figures beside say the same.");
  private readonly scrub = byId<HTMLInputElement>("scrub");
  private scene: Scene;
  private run: Run | null = null;
  private duration = 0;
  private now = 0;
  private playing = false;
  private frame = 0;
  private waiting = 0;
  private shown = -1;
  private preset = kPresets[0];

  constructor(
    private readonly core: Core,
    private readonly designed: () => Geometry,
    private readonly changed: () => void,
  ) {
    this.machine = new Machine(core.words);
    this.rules = new Rules(core);
    this.table2 = new Table2(core, (row) => this.experiment(row), () => this.hold());
    this.faults = new FaultList(byId("faults"), core.words.catalogue, () => this.later());
    this.scene = sceneOf({ axes: [], chips: [], noise_mps2: 0 }, {});
    byId("direction").append(this.sphere.element);
    const choice = byId<HTMLSelectElement>("preset");
    for (const one of kPresets) choice.append(make("option", { value: one.id }, one.words));
    choice.addEventListener("change", () => this.choose(choice.value));
    byId("tool").addEventListener("change", () => this.retool());
    const motion = byId<HTMLSelectElement>("motion");
    for (const [value, words] of kMotions) motion.append(make("option", { value }, words));
    motion.addEventListener("change", () => this.move(motion.value as Motion));
    byId("add-fault").addEventListener("click", () => this.faults.add());
    byId("play").addEventListener("click", () => this.toggle());
    this.scrub.addEventListener("input", () => this.seek(this.scrub.valueAsNumber));
    this.choose(kPresets[0].id);
  }

  /** The geometry of the first view has changed. */
  redesigned(): void {
    if (byId<HTMLSelectElement>("tool").value === "design") this.retool();
  }

  shared(): SharedRun {
    return { story: this.preset.id, tool: byId<HTMLSelectElement>("tool").value, motion: this.scene.motion, faults: this.faults.faults.map(faultText), time_s: this.now < this.duration ? this.now : 0 };
  }

  restore(run: Partial<SharedRun>): void {
    const story = run.story ?? this.preset.id;
    if (!kPresets.some((one) => one.id === story)) throw new Error(`there is no story ${story}`);
    byId<HTMLSelectElement>("preset").value = story;
    this.choose(story);
    byId<HTMLSelectElement>("tool").value = run.tool ?? "preset";
    this.retool();
    if (run.motion) {
      byId<HTMLSelectElement>("motion").value = run.motion;
      this.move(run.motion);
    }
    this.now = run.time_s ?? 0;
    if (run.faults) this.setFaults(run.faults.map(parseFault));
  }

  /** The scene as files of the tool. */
  files(): Record<string, string> {
    return this.core.files();
  }

  choose(id: string): void {
    this.preset = kPresets.find((one) => one.id === id)!;
    byId<HTMLSelectElement>("tool").value = "preset";
    byId("preset-what").textContent = this.preset.what;
    this.table2.show(id === "table2");
    this.now = 0;
    this.retool();
  }

  private geometry(): Pick<Geometry, "axes" | "chips" | "noise_mps2"> {
    if (byId<HTMLSelectElement>("tool").value === "design") return this.designed();
    return { ...shapeOf(this.core, this.preset.geometry), noise_mps2: 2e-4 * 9.80665 };
  }

  private retool(): void {
    const geometry = this.geometry();
    this.scene = sceneOf(geometry, this.preset.scene);
    byId<HTMLSelectElement>("motion").value = this.scene.motion;
    const texts = this.preset.id === "table2" ? experimentFaults(this.table2.now()) : (this.preset.scene.faults ?? []);
    const there = (fault: Fault) =>
      fault.sensor === "log" || (fault.sensor.startsWith("chip") ? geometry.chips.includes(Number(fault.sensor.slice(4))) : Number(fault.sensor.slice(1)) <= geometry.axes.length);
    this.setFaults(texts.map(parseFault).filter(there));
  }

  /** The same tool and faults, moved otherwise. */
  private move(motion: Motion): void {
    const before = isFlight(this.scene.motion);
    this.scene = { ...this.scene, motion };
    const flight = isFlight(motion);
    const faults = this.faults.faults.filter((fault) => !flight || fault.sensor !== "log");
    if (before === flight) return this.setFaults(faults);
    this.setFaults(faults.map((fault): Fault => ({ ...fault, lasts: 0, ...(flight ? { unit: "s", onset: 2 } : { unit: "station", onset: 4 }) })));
  }

  private setFaults(faults: Fault[]): void {
    const flight = isFlight(this.scene.motion);
    this.faults.show(faults, this.scene.chips, flight ? this.scene.duration_s : this.scene.stations, flight ? "s" : "station");
    this.restart();
  }

  private experiment(row: Table2Row): void {
    this.setFaults(experimentFaults(row).map(parseFault));
  }

  private later(): void {
    clearTimeout(this.waiting);
    this.waiting = window.setTimeout(() => this.restart(), 60);
  }

  /** Steps and shows nothing until the next start. */
  private hold(): void {
    clearTimeout(this.waiting);
    cancelAnimationFrame(this.frame);
    document.body.dataset.run = "stepping";
  }

  private restart(): void {
    this.hold();
    this.table2.stop();
    this.scene.faults = onSensors(this.faults.faults.map(faultText), this.scene.chips);
    const problem = byId("break-error");
    try {
      const begun = this.core.begin(this.scene);
      problem.hidden = true;
      this.frame = requestAnimationFrame(() => this.slice(begun));
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      problem.hidden = false;
      problem.textContent = error.message;
      this.run = null;
    }
  }

  /** Steps until the frame is used up; when all samples are through, shows them. */
  private slice(begun: Begun): void {
    const end = performance.now() + kSlice_ms;
    let stepped = 1;
    while (stepped > 0 && performance.now() < end) stepped = this.core.run(kSliceSamples);
    if (stepped > 0) {
      this.frame = requestAnimationFrame(() => this.slice(begun));
      return;
    }
    const run = new Run(this.core, { ...this.scene }, begun, this.core.records().slice());
    this.run = run;
    this.duration = begun.duration_s;
    this.scrub.max = String(begun.duration_s);
    const steps = [
      () => this.timeline.show(this.series(run), begun.duration_s),
      () => this.showLanes(run),
      () => this.rules.show(run),
      () => this.listEvents(run),
      () => listShrinking(run, (time_s) => this.seek(time_s)),
      () => this.reveal(run),
    ];
    this.frame = requestAnimationFrame(() => this.present(steps, 0));
  }

  /** One picture a frame, so that none is held up. */
  private present(steps: (() => void)[], at: number): void {
    steps[at]();
    if (at + 1 < steps.length) this.frame = requestAnimationFrame(() => this.present(steps, at + 1));
  }

  private reveal(run: Run): void {
    byId("machine-card").hidden = run.flight;
    if (this.now === 0 || this.now > this.duration) this.now = this.duration;
    this.shown = -1;
    this.showNow();
    document.body.dataset.run = this.core.digest();
    this.changed();
    if (this.playing) this.frame = requestAnimationFrame((at) => this.tick(at, at));
  }

  private series(run: Run): Series {
    const of = (name: string, f: (x: number) => number | null): (number | null)[] => Array.from(run.column(name), f);
    const some = (x: number): number | null => (x > 0 && Number.isFinite(x) ? x : null); // for a logarithm
    const size = run.flight ? drawable : (x: number) => drawable(degrees(x));
    const off = (["plain", "paper", "px4", "plumb"] as const).map((rule) => (run.has(rule) ? of(run.errorName(rule), size) : []));
    return {
      time: run.column("time_s"),
      test: run.flight ? null : [of("statistic", some), of("limit", some)],
      off: [...off, of(run.flight ? "force_bound_mps2" : "protection_rad", size)],
      unit: run.flight ? "m/s\u00b2" : "deg",
    };
  }

  private showLanes(run: Run): void {
    const [time, state, faulty, suspects] = ["time_s", "state", "faulty", "suspects"].map((name) => run.column(name));
    const sets = [faulty, suspects, run.blamed("plumb"), run.blamed("paper"), run.blamed("px4")];
    this.lanes.show({ sensors: run.scene.axes.length, time, state, sets }, this.duration);
  }

  private toggle(): void {
    this.playing = !this.playing;
    byId("play").textContent = this.playing ? "Pause" : "Play";
    this.changed();
    if (!this.playing || !this.run) return;
    if (this.now >= this.duration) this.now = 0;
    this.frame = requestAnimationFrame((at) => this.tick(at, at));
  }

  private tick(at: number, before: number): void {
    if (!this.playing || !this.run) return;
    this.now += ((at - before) / 1000) * Number(byId<HTMLSelectElement>("speed").value);
    if (this.now >= this.duration) {
      this.now = this.duration;
      this.toggle();
    }
    this.showNow();
    if (this.playing) this.frame = requestAnimationFrame((next) => this.tick(next, at));
  }

  private seek(time_s: number): void {
    this.now = Math.max(0, Math.min(time_s, this.duration));
    this.showNow();
    this.changed();
  }

  /** The last sample at or before the time that is shown. */
  private sampleNow(run: Run): number {
    let low = 0;
    let high = run.count - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (run.of(middle, "time_s") <= this.now) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  private showNow(): void {
    const run = this.run;
    if (!run || run.count === 0) return;
    const k = this.sampleNow(run);
    this.scrub.value = String(this.now);
    byId("time").textContent = `${this.now.toFixed(1)} s`;
    this.scrub.setAttribute("aria-valuetext", `${this.now.toFixed(1)} seconds`);
    this.timeline.cursor(this.now);
    this.lanes.cursor(this.now);
    if (k === this.shown) return;
    this.shown = k;
    const state = run.of(k, "state");
    if (!run.flight) this.showMachine(run, k, state);
    this.tellVerdict(run, k, state);
    this.rules.at(k);
    showSets(run, k);
    this.drawDirection(run, k);
  }

  private showMachine(run: Run, k: number, state: number): void {
    const words = this.core.words;
    let event = k;
    while (event > 0 && run.of(event, "event") < 0) --event;
    const happened = run.of(event, "event") >= 0;
    const said = happened ? `${words.events[run.of(event, "event")].replaceAll("_", " ")} at ${run.of(event, "time_s").toFixed(2)} s` : "";
    this.machine.show(state, happened ? run.of(event, "from") : -1, happened ? run.of(event, "to") : -1, said);
    byId("machine").setAttribute("aria-label", `State ${stateWords(words.states[state])}. ${said ? `Last event: ${said}.` : ""}`);
  }

  private tellVerdict(run: Run, k: number, state: number): void {
    const words = this.core.words;
    const text = (name: string) => (name || "none").replaceAll("_", " ");
    const pill = (name: string) => make("span", { class: "state", style: `--state:${kStateColours[state]}` }, name);
    const who: [string, string][] = [
      ["in service", sensorsOf(run.of(k, "in_service"))],
      ["provisionally excluded", sensorsOf(run.of(k, "provisionally_excluded"))],
      ["excluded", sensorsOf(run.of(k, "excluded"))],
      ["suspected", sensorsOf(run.of(k, "suspects"))],
      ["really faulty", sensorsOf(run.of(k, "faulty"))],
    ];
    const force = (name: string) => figure(run.of(k, name), "m/s\u00b2");
    const rows: [string, Node | string][] = run.flight
      ? [
          ["motion monitor", pill(kFlightWords[state])],
          ["output", words.flight_validities[run.of(k, "validity")]],
          ["cause", text(words.flight_causes[run.of(k, "cause")])],
          ...who.filter(([name]) => name !== "excluded"),
          ["specific force off by", force("force_error_mps2")],
          ["its bound", force("force_bound_mps2")],
        ]
      : [
          ["state", pill(stateWords(words.states[state]))],
          ["output", words.validities[run.of(k, "validity")]],
          ["cause", text(words.causes[run.of(k, "cause")])],
          ["statistic / limit", `${figure(run.of(k, "statistic"), "")} / ${figure(run.of(k, "limit"), "")}`],
          ...who,
          ["direction off by", deg(run.of(k, "error_rad"))],
          ["protection level", deg(run.of(k, "protection_rad"))],
        ];
    byId("verdict").replaceChildren(table("The verdict at this time", ["figure", "value"], rows));
  }

  private drawDirection(run: Run, k: number): void {
    const vector = (of: string): [number, number, number] => [run.of(k, `${of}_x`), run.of(k, `${of}_y`), run.of(k, `${of}_z`)];
    const truth = vector("true");
    const told = vector("told");
    const level = run.of(k, "protection_rad");
    const off = run.of(k, "error_rad");
    const what = run.flight ? ["force", "The specific force as it is"] : ["down", "Down as it is"];
    const known = Math.hypot(...told) > 0;
    // Tenths of a degree are not to be seen: the cone is drawn so much larger, and the angle between the two with it.
    const larger = Number.isFinite(level) && level < 0.2 ? Math.pow(10, Math.ceil(Math.log10(0.1 / level))) : 1;
    const directions: Direction[] = [{ label: what[0], colour: kStateColours[5], axis: truth }];
    if (known) {
      const shownTold = spread(truth, told, larger);
      directions.push({ label: "plumb", colour: kStateColours[2], axis: shownTold, ...(Number.isFinite(level) ? { cone: level * larger } : {}) });
    }
    this.sphere.show(directions);
    const scale = larger > 1 ? ` Angles drawn ${larger} times as large.` : "";
    byId("direction-words").textContent = known
      ? `${what[1]}, and as plumb says, with the cone of its ${run.flight ? "bound" : "protection level"} (${deg(level)}).${scale}${Number.isFinite(off) ? ` Off by ${figure(degrees(off), "deg")}.` : ""}`
      : "plumb says no direction yet.";
  }

  private listEvents(run: Run): void {
    const words = this.core.words;
    const names = run.flight ? words.flight_events : words.events;
    const items: HTMLElement[] = [];
    for (let k = 0; k < run.count; ++k) {
      if (run.of(k, "event") < 0) continue;
      const time = run.of(k, "time_s");
      const event = names[run.of(k, "event")].replaceAll("_", " ");
      const [from, to] = ["from", "to"].map((side) => stateWords(words.states[run.of(k, side)]));
      const sensors = run.of(k, "event_sensors");
      const text = `${time.toFixed(2)} s: ${event === "none" ? words.causes[run.of(k, "event_cause")].replaceAll("_", " ") : event}${sensors ? ` (${sensorsOf(sensors)})` : ""}${from === to || run.flight ? "" : `, ${from} to ${to}`}`;
      items.push(make("li", {}, make("button", { type: "button", class: "link", onclick: () => this.seek(time) }, text)));
    }
    byId("events").replaceChildren(...(items.length ? items : [make("li", {}, "Nothing happened.")]));
    byId("fault-words").textContent = run.begun.faults.length ? `${run.begun.faults.join("; ")}.` : "Every sensor is healthy.";
  }
}

/** What the states of a flight's record mean. */
const kFlightWords = ["nothing found", "alarm", "named"];

/** The direction whose angle from `from` is so many times that of `to`. */
function spread(from: number[], to: number[], times: number): [number, number, number] {
  const unit = (v: number[]) => v.map((x) => x / Math.hypot(...v));
  const [a, b] = [unit(from), unit(to)];
  const across = b.map((x, k) => x - a[k] * (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]));
  const sine = Math.hypot(...across);
  if (sine < 1e-12) return a as [number, number, number];
  const angle = Math.min(Math.PI, times * Math.atan2(sine, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]));
  return a.map((x, k) => Math.cos(angle) * x + (Math.sin(angle) * across[k]) / sine) as [number, number, number];
}
