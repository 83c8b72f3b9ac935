// Faults as the page shows them, and as the text that core and tool read: "a2:bias=50mg0@station6+station20".
import type { CatalogueEntry } from "./core";
import { make } from "./dom";

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
  sensor: string;
  word: string;
  /** As in the text, with its unit; empty: the default of the catalogue. */
  size: string;
  station: number;
  /** Stations; 0: for good. */
  lasts: number;
}

export function parseFault(text: string): Fault {
  const found = /^(\w+):([\w-]+)(?:=([^@]*))?@station(\d+)(?:\+station(\d+))?$/.exec(text);
  if (!found) throw new Error(`${text} is no fault of this page`);
  return { sensor: found[1], word: found[2], size: found[3] ?? "", station: Number(found[4]), lasts: Number(found[5] ?? 0) };
}

export function faultText(fault: Fault): string {
  const size = fault.size === "" ? "" : `=${fault.size}`;
  return `${fault.sensor}:${fault.word}${size}@station${fault.station}${fault.lasts ? `+station${fault.lasts}` : ""}`;
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
  private sensors = 4;
  private stations = 14;

  constructor(
    private readonly host: HTMLElement,
    private readonly catalogue: CatalogueEntry[],
    private readonly changed: () => void,
  ) {}

  show(faults: Fault[], sensors: number, stations: number): void {
    this.faults = faults;
    this.sensors = sensors;
    this.stations = stations;
    this.draw();
  }

  add(): void {
    const sensor = `a${1 + (this.faults.length % this.sensors)}`;
    this.faults.push({ sensor, word: "bias", size: "50mg0", station: Math.min(4, this.stations), lasts: 0 });
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
    for (let i = 1; i <= this.sensors; ++i) sensor.append(make("option", { selected: fault.sensor === `a${i}` }, `a${i}`));
    if (whole) sensor.replaceChildren(make("option", { value: "log", selected: true }, "all"));
    sensor.addEventListener("change", () => {
      fault.sensor = sensor.value;
      this.changed();
    });
    const kinds = make("select", { ...name("Kind"), class: "grow" });
    const simple = make("optgroup", { label: "with a size" });
    for (const one of kKinds) simple.append(make("option", { value: one.word, selected: one.word === fault.word }, one.words));
    const listed = make("optgroup", { label: "fault catalogue" });
    for (const one of this.catalogue) {
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
    parts.push(this.onset(fault, name("First station")));
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
    const output = make("output", {}, String(fault.station));
    const slider = make("input", { ...name, type: "range", min: 1, max: this.stations, value: fault.station });
    slider.addEventListener("input", () => {
      fault.station = slider.valueAsNumber;
      output.textContent = String(fault.station);
      this.changed();
    });
    return make("label", { class: "slider" }, make("span", {}, "from station"), slider, output);
  }
}
