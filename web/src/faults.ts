// Faults as the page shows them, and as the text that core and tool read: "a2:bias=50mg0@station6+station20".
import type { CatalogueEntry } from "./core";
import { make } from "./dom";
import { chipsIn, unitWords, unitOf } from "./geometry";

interface Kind {
  word: string;
  words: string;
  unit: string;
  least: number;
  most: number;
  start: number;
  /** The slider is a logarithm. */
  log?: boolean;
  whole?: boolean;
}

const kKinds: Kind[] = [
  { word: "stuck", words: "stands at a voltage", unit: "V", least: -5, most: 5, start: 0 },
  { word: "bias", words: "reads too much", unit: "mg0", least: 0.1, most: 1000, start: 50, log: true },
  { word: "drift", words: "drifts away", unit: "mg0/s", least: 0.01, most: 100, start: 1, log: true },
  { word: "scale", words: "scale factor times", unit: "", least: 0.5, most: 1.5, start: 1.1 },
  { word: "noise", words: "noise on top", unit: "mg0", least: 0.1, most: 200, start: 5, log: true },
  { word: "turned", words: "axis turned", unit: "deg", least: 0.01, most: 45, start: 2, log: true },
  { word: "missing", words: "does not deliver", unit: "%", least: 1, most: 100, start: 30 },
  { word: "gravity", words: "gravity is longer", unit: "mg0", least: 0.1, most: 100, start: 3, log: true, whole: true },
  { word: "shake", words: "the tool shakes", unit: "g0", least: 0.001, most: 1, start: 0.1, log: true, whole: true },
];

export interface Fault {
  /** "a2", "chip2", or "log" for all. */
  sensor: string;
  word: string;
  /** As in the text, with its unit; empty: the default of the catalogue. */
  size: string;
  /** Station or, in a flight, seconds. */
  onset: number;
  unit: "station" | "s";
  /** In the same unit; 0: for good. */
  lasts: number;
}

export function parseFault(text: string): Fault {
  const found = /^(\w+):([\w-]+)(?:=([^@]*))?@(?:station(\d+)|([\d.]+)s)(?:\+(?:station(\d+)|([\d.]+)s))?$/.exec(text);
  if (!found) throw new Error(`${text} is no fault of this page`);
  const [, sensor, word, size, station, seconds, stations, time_s] = found;
  return { sensor, word, size: size ?? "", onset: Number(station ?? seconds), unit: station ? "station" : "s", lasts: Number(stations ?? time_s ?? 0) };
}

export function faultText(fault: Fault): string {
  const size = fault.size === "" ? "" : `=${fault.size}`;
  const at = (value: number) => (fault.unit === "s" ? `${value}s` : `station${value}`);
  return `${fault.sensor}:${fault.word}${size}@${at(fault.onset)}${fault.lasts ? `+${at(fault.lasts)}` : ""}`;
}

/** The same faults for the core, which knows sensors alone: a chip's are those of each of its sensors. */
export function onSensors(faults: string[], chips: number[]): string[] {
  return faults.flatMap((text) => {
    const chip = /^chip(\d+):/.exec(text);
    if (!chip) return [text];
    const members = chips.flatMap((one, i) => (one === Number(chip[1]) ? [`a${i + 1}`] : []));
    return members.map((sensor) => text.replace(/^chip\d+/, sensor));
  });
}

const kSteps = 1000;
const toSlider = (kind: Kind, value: number): number =>
  kind.log
    ? (kSteps * Math.log(value / kind.least)) / Math.log(kind.most / kind.least)
    : (kSteps * (value - kind.least)) / (kind.most - kind.least);
const fromSlider = (kind: Kind, part: number): number => {
  const value = kind.log
    ? kind.least * Math.pow(kind.most / kind.least, part / kSteps)
    : kind.least + ((kind.most - kind.least) * part) / kSteps;
  return Number(value.toPrecision(kind.log ? 2 : 3));
};

/** The rows in which faults are set. */
export class FaultList {
  faults: Fault[] = [];
  private chips: number[] = [];
  /** Stations, or seconds of a flight. */
  private length = 14;
  private unit: Fault["unit"] = "station";

  constructor(
    private readonly host: HTMLElement,
    private readonly catalogue: CatalogueEntry[],
    private readonly changed: () => void,
  ) {}

  show(faults: Fault[], chips: number[], length: number, unit: Fault["unit"]): void {
    this.faults = faults;
    this.chips = chips;
    this.length = length;
    this.unit = unit;
    this.draw();
  }

  add(): void {
    const sensor = `a${1 + (this.faults.length % this.chips.length)}`;
    const [size, onset] = this.unit === "s" ? ["500mg0", 2] : ["50mg0", 4];
    this.faults.push({ sensor, word: "bias", size, onset: Math.min(onset, this.length), unit: this.unit, lasts: 0 });
    this.draw();
    this.changed();
  }

  private draw(): void {
    this.host.replaceChildren(...this.faults.map((fault, k) => this.row(fault, k)));
    if (this.faults.length === 0) this.host.append(make("p", { class: "note" }, "No fault: every sensor is healthy."));
  }

  private row(fault: Fault, k: number): HTMLElement {
    const name = (what: string) => ({ "aria-label": `${what} of fault ${k + 1}` });
    const kind = kKinds.find((one) => one.word === fault.word);
    const entry = this.catalogue.find((one) => one.id === fault.word);
    const whole = kind?.whole ?? entry?.whole_log ?? fault.sensor === "log";
    const refresh = () => {
      this.draw();
      this.changed();
    };
    const sensor = make("select", name("Sensor"));
    this.chips.forEach((_, i) => sensor.append(make("option", { value: `a${i + 1}`, selected: fault.sensor === `a${i + 1}` }, `a${i + 1}`)));
    for (const chip of chipsIn(this.chips)) {
      const words = unitWords(this.chips, unitOf(this.chips, this.chips.indexOf(chip)));
      sensor.append(make("option", { value: `chip${chip}`, selected: fault.sensor === `chip${chip}` }, words));
    }
    if (whole) sensor.replaceChildren(make("option", { value: "log", selected: true }, "all"));
    sensor.addEventListener("change", () => {
      fault.sensor = sensor.value;
      this.changed();
    });
    const kinds = make("select", { ...name("Kind"), class: "grow" });
    const simple = make("optgroup", { label: "with a size" });
    const possible = (all: boolean) => !all || this.unit === "station"; // in flight there is no gravity to be wrong
    for (const one of kKinds.filter((k) => possible(k.whole ?? false))) simple.append(make("option", { value: one.word, selected: one.word === fault.word }, one.words));
    const listed = make("optgroup", { label: "fault catalogue" });
    for (const one of this.catalogue.filter((c) => possible(c.whole_log))) {
      listed.append(make("option", { value: one.id, selected: one.id === fault.word, title: one.source }, `${one.id} ${one.title}`));
    }
    kinds.append(simple, listed);
    if (!kind && !entry) kinds.prepend(make("option", { value: fault.word, selected: true }, `${fault.word} ${fault.size}`));
    kinds.addEventListener("change", () => {
      fault.word = kinds.value;
      const now = kKinds.find((one) => one.word === fault.word);
      fault.size = now ? `${now.start}${now.unit}` : "";
      const all = now?.whole ?? this.catalogue.find((one) => one.id === fault.word)?.whole_log ?? false;
      if (all) fault.sensor = "log";
      else if (fault.sensor === "log") fault.sensor = "a1";
      refresh();
    });
    const parts: HTMLElement[] = [sensor, kinds];
    if (kind) parts.push(this.size(fault, kind, name("Size")));
    parts.push(this.onset(fault, name(this.unit === "s" ? "First second" : "First station")));
    parts.push(
      make("button", { type: "button", class: "quiet", "aria-label": `Remove fault ${k + 1}`, onclick: () => {
        this.faults.splice(k, 1);
        refresh();
      } }, "Remove"),
    );
    return make("fieldset", { class: "fault" }, make("legend", {}, `Fault ${k + 1}`), ...parts);
  }

  private size(fault: Fault, kind: Kind, name: Record<string, string>): HTMLElement {
    const value = parseFloat(fault.size);
    const words = (size: string) => size.replace(/([\d.])([a-zA-Z%])/, "$1 $2");
    const output = make("output", {}, words(fault.size));
    const slider = make("input", { ...name, type: "range", min: 0, max: kSteps, value: toSlider(kind, value), "aria-valuetext": words(fault.size) });
    slider.addEventListener("input", () => {
      fault.size = `${fromSlider(kind, slider.valueAsNumber)}${kind.unit}`;
      output.textContent = words(fault.size);
      slider.setAttribute("aria-valuetext", words(fault.size));
      this.changed();
    });
    return make("label", { class: "slider" }, make("span", {}, "size"), slider, output);
  }

  private onset(fault: Fault, name: Record<string, string>): HTMLElement {
    const output = make("output", {}, "");
    const [words, step, least] = this.unit === "s" ? ["from second", 0.1, 0.5] : ["from station", 1, 1];
    const slider = make("input", { ...name, type: "range", min: least, max: this.length, step, value: fault.onset });
    const show = () => (output.textContent = this.unit === "s" ? `${fault.onset.toFixed(1)} s` : String(fault.onset));
    slider.addEventListener("input", () => {
      fault.onset = slider.valueAsNumber;
      show();
      this.changed();
    });
    show();
    return make("label", { class: "slider" }, make("span", {}, words), slider, output);
  }
}
