// The second view: the monitor, stepped in the page over a tool that breaks.
import { Core, Refusal, type Begun, type Scene } from "./core";
import type { Geometry } from "./design";
import { byId, deg, degrees, figure, make, sensorsOf, table } from "./dom";
import { FaultList, faultText, parseFault } from "./faults";
import { kStateColours, Machine, stateWords } from "./machine";
import { kPresets, sceneOf } from "./scenes";
import { Sphere } from "./sphere";
import { degreesFor, Timeline, type Series } from "./timeline";

/** What one slice of stepping may take of a frame [ms]. */
const kSlice_ms = 7;
const kSliceSamples = 50;

export class Break {
  private readonly machine: Machine;
  private readonly timeline = new Timeline((time_s) => this.seek(time_s));
  private readonly faults: FaultList;
  private readonly sphere = new Sphere("Down as it is and as plumb says it is, in the frame of the tool. The figures beside say the same.");
  private readonly scrub = byId<HTMLInputElement>("scrub");
  private scene: Scene;
  private begun: Begun | null = null;
  private records = new Float64Array();
  private now = 0;
  private playing = false;
  private frame = 0;
  private waiting = 0;
  private shown = -1;
  private preset = kPresets[0];

  constructor(
    private readonly core: Core,
    private readonly designed: () => Geometry,
  ) {
    this.machine = new Machine(core.words);
    this.faults = new FaultList(byId("faults"), core.words.catalogue, () => this.later());
    this.scene = sceneOf([], 0, {});
    byId("direction").append(this.sphere.element);
    const choice = byId<HTMLSelectElement>("preset");
    for (const one of kPresets) choice.append(make("option", { value: one.id }, one.words));
    choice.addEventListener("change", () => this.choose(choice.value));
    const tool = byId<HTMLSelectElement>("tool");
    tool.addEventListener("change", () => this.retool());
    byId("add-fault").addEventListener("click", () => this.faults.add());
    byId("play").addEventListener("click", () => this.toggle());
    this.scrub.addEventListener("input", () => this.seek(this.scrub.valueAsNumber));
    this.choose(kPresets[0].id);
  }

  /** The geometry of the first view has changed. */
  redesigned(): void {
    if (byId<HTMLSelectElement>("tool").value === "design") this.retool();
  }

  choose(id: string): void {
    this.preset = kPresets.find((one) => one.id === id)!;
    byId<HTMLSelectElement>("tool").value = "preset";
    byId("preset-what").textContent = this.preset.what;
    this.retool();
  }

  private retool(): void {
    const own = byId<HTMLSelectElement>("tool").value === "design";
    const geometry = this.designed();
    const axes = own ? geometry.axes : this.core.builtin(this.preset.geometry);
    const noise = own ? geometry.noise_mps2 : 2e-4 * 9.80665;
    this.scene = sceneOf(axes, noise, this.preset.scene);
    const faults = this.scene.faults.map(parseFault).filter((f) => f.sensor === "log" || Number(f.sensor.slice(1)) <= axes.length);
    this.faults.show(faults, axes.length, this.scene.stations);
    this.restart();
  }

  private later(): void {
    clearTimeout(this.waiting);
    this.waiting = window.setTimeout(() => this.restart(), 60);
  }

  private restart(): void {
    clearTimeout(this.waiting);
    cancelAnimationFrame(this.frame);
    this.scene.faults = this.faults.faults.map(faultText);
    const problem = byId("break-error");
    try {
      this.begun = this.core.begin(this.scene);
      problem.hidden = true;
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      problem.hidden = false;
      problem.textContent = error.message;
      this.begun = null;
      return;
    }
    this.scrub.max = String(this.begun.duration_s);
    document.body.dataset.run = "stepping";
    this.frame = requestAnimationFrame(() => this.slice());
  }

  /** Steps until the frame is used up; when all samples are through, shows them. */
  private slice(): void {
    const end = performance.now() + kSlice_ms;
    let stepped = 1;
    while (stepped > 0 && performance.now() < end) stepped = this.core.run(kSliceSamples);
    if (stepped > 0) {
      this.frame = requestAnimationFrame(() => this.slice());
      return;
    }
    this.records = this.core.records().slice();
    this.timeline.show(this.series(), this.begun!.duration_s);
    this.listEvents();
    if (this.now === 0 || this.now > this.begun!.duration_s) this.now = this.begun!.duration_s;
    this.shown = -1;
    this.showNow();
    document.body.dataset.run = this.core.digest();
    if (this.playing) this.frame = requestAnimationFrame((at) => this.tick(at, at));
  }

  private width(): number {
    return this.core.words.records.length;
  }
  private count(): number {
    return this.records.length / this.width();
  }
  private of(k: number, name: string): number {
    return this.records[k * this.width() + this.core.at[name]];
  }

  private series(): Series {
    const column = <T>(name: string, f: (x: number) => T): T[] => Array.from({ length: this.count() }, (_, k) => f(this.of(k, name)));
    const plain = (x: number): number => x;
    const some = (x: number): number | null => (x > 0 && Number.isFinite(x) ? x : null); // for a logarithm
    return {
      time: column("time_s", plain),
      state: column("state", plain),
      statistic: column("statistic", some),
      limit: column("limit", some),
      error_deg: column("error_rad", degreesFor),
      plain_deg: column("plain_rad", degreesFor),
      protection_deg: column("protection_rad", degreesFor),
    };
  }

  private toggle(): void {
    this.playing = !this.playing;
    byId("play").textContent = this.playing ? "Pause" : "Play";
    if (!this.playing || !this.begun) return;
    if (this.now >= this.begun.duration_s) this.now = 0;
    this.frame = requestAnimationFrame((at) => this.tick(at, at));
  }

  private tick(at: number, before: number): void {
    if (!this.playing || !this.begun) return;
    this.now += ((at - before) / 1000) * Number(byId<HTMLSelectElement>("speed").value);
    if (this.now >= this.begun.duration_s) {
      this.now = this.begun.duration_s;
      this.toggle();
    }
    this.showNow();
    if (this.playing) this.frame = requestAnimationFrame((next) => this.tick(next, at));
  }

  private seek(time_s: number): void {
    this.now = Math.max(0, Math.min(time_s, this.begun?.duration_s ?? 0));
    this.showNow();
  }

  /** The last sample at or before the time that is shown. */
  private sampleNow(): number {
    let low = 0;
    let high = this.count() - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.of(middle, "time_s") <= this.now) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  private showNow(): void {
    const k = this.sampleNow();
    this.scrub.value = String(this.now);
    byId("time").textContent = `${this.now.toFixed(1)} s`;
    this.scrub.setAttribute("aria-valuetext", `${this.now.toFixed(1)} seconds`);
    this.timeline.cursor(this.now);
    if (k === this.shown || this.count() === 0) return;
    this.shown = k;
    const words = this.core.words;
    const state = this.of(k, "state");
    let event = k;
    while (event > 0 && this.of(event, "event") < 0) --event;
    const happened = this.of(event, "event") >= 0;
    const said = happened ? `${words.events[this.of(event, "event")].replaceAll("_", " ")} at ${this.of(event, "time_s").toFixed(2)} s` : "";
    this.machine.show(state, happened ? this.of(event, "from") : -1, happened ? this.of(event, "to") : -1, said);
    byId("machine").setAttribute("aria-label", `State ${stateWords(words.states[state])}. ${said ? `Last event: ${said}.` : ""}`);
    this.tellVerdict(k, state);
    this.drawDirection(k);
  }

  private tellVerdict(k: number, state: number): void {
    const words = this.core.words;
    const text = (name: string) => (name || "none").replaceAll("_", " ");
    const name = make("span", { class: "state", style: `--state:${kStateColours[state]}` }, stateWords(words.states[state]));
    const n = this.scene.axes.length;
    const least = Array.from({ length: n }, (_, i) => this.of(k, `minimum_faults_${i + 1}`));
    const rows: [string, Node | string][] = [
      ["state", name],
      ["output", words.validities[this.of(k, "validity")]],
      ["cause", text(words.causes[this.of(k, "cause")])],
      ["statistic / limit", `${figure(this.of(k, "statistic"), "")} / ${figure(this.of(k, "limit"), "")}`],
      ["in service", sensorsOf(this.of(k, "in_service"))],
      ["provisionally excluded", sensorsOf(this.of(k, "provisionally_excluded"))],
      ["excluded", sensorsOf(this.of(k, "excluded"))],
      ["suspected", sensorsOf(this.of(k, "suspects"))],
      ["really faulty", sensorsOf(this.of(k, "faulty"))],
      ["consistent fault sets", `${this.of(k, "hypotheses")} after ${this.of(k, "on_record")} attitudes on record`],
      ["fewest faults with each sensor healthy", least.map((x, i) => `a${i + 1}: ${x === 255 ? "none" : x}`).join(", ")],
      ["direction off by", deg(this.of(k, "error_rad"))],
      ["without plumb", deg(this.of(k, "plain_rad"))],
      ["protection level", deg(this.of(k, "protection_rad"))],
    ];
    byId("verdict").replaceChildren(table("The verdict at this time", ["figure", "value"], rows));
  }

  private drawDirection(k: number): void {
    const vector = (of: string): [number, number, number] => [this.of(k, `${of}_x`), this.of(k, `${of}_y`), this.of(k, `${of}_z`)];
    const truth = vector("true");
    const told = vector("told");
    const level = this.of(k, "protection_rad");
    const off = this.of(k, "error_rad");
    const known = Math.hypot(...told) > 0;
    // Tenths of a degree are not to be seen: the cone is drawn so much larger, and the angle between the two with it.
    const larger = Number.isFinite(level) && level < 0.2 ? Math.pow(10, Math.ceil(Math.log10(0.1 / level))) : 1;
    const directions = [{ label: "down", colour: kStateColours[5], axis: truth }];
    if (known) {
      const shownTold = spread(truth, told, larger);
      directions.push({ label: "plumb", colour: kStateColours[2], axis: shownTold, ...(Number.isFinite(level) ? { cone: level * larger } : {}) });
    }
    this.sphere.show(directions);
    const scale = larger > 1 ? ` Angles drawn ${larger} times as large.` : "";
    byId("direction-words").textContent = known
      ? `Down as it is, and as plumb says, with the cone of its protection level (${deg(level)}).${scale}${Number.isFinite(off) ? ` Off by ${figure(degrees(off), "deg")}.` : ""}`
      : "plumb says no direction yet.";
  }

  private listEvents(): void {
    const words = this.core.words;
    const items: HTMLElement[] = [];
    for (let k = 0; k < this.count(); ++k) {
      if (this.of(k, "event") < 0) continue;
      const time = this.of(k, "time_s");
      const event = words.events[this.of(k, "event")].replaceAll("_", " ");
      const [from, to] = ["from", "to"].map((side) => stateWords(words.states[this.of(k, side)]));
      const sensors = this.of(k, "event_sensors");
      const text = `${time.toFixed(2)} s: ${event === "none" ? words.causes[this.of(k, "event_cause")].replaceAll("_", " ") : event}${sensors ? ` (${sensorsOf(sensors)})` : ""}${from === to ? "" : `, ${from} to ${to}`}`;
      items.push(make("li", {}, make("button", { type: "button", class: "link", onclick: () => this.seek(time) }, text)));
    }
    byId("events").replaceChildren(...(items.length ? items : [make("li", {}, "Nothing happened.")]));
    byId("fault-words").textContent = this.begun!.faults.length ? `${this.begun!.faults.join("; ")}.` : "Every sensor is healthy.";
  }
}

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
