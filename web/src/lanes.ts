// The state as a band, and under it every sensor: when it is faulty, and which rule says so.
import { byId, make, sensorsOf } from "./dom";
import { kStateColours } from "./machine";

/** What stands left and right of the time axis of every picture [px]. */
export const kLeft = 68;
export const kRight = 14;

/** One number a sample; sets of sensors as bits. */
export interface LaneData {
  sensors: number;
  time: ArrayLike<number>;
  state: ArrayLike<number>;
  /** In the order of `kLanes`; empty where a rule is not there. */
  sets: ArrayLike<number>[];
}

/** Who says it, its colour, and how strongly it is drawn. */
export const kLanes: [string, string, number][] = [
  ["really faulty", "--ink", 0.75],
  ["plumb suspects", "#2f78b7", 0.45],
  ["plumb excludes", "#2f78b7", 1],
  ["the paper's rule excludes", "#d0553c", 1],
  ["PX4 blames", "#8f55c4", 1],
];
/** Which strip of a sensor's row each is drawn in: suspicion and exclusion share one. */
const kStrip = [0, 1, 1, 2, 3];

const kBand = 22;
const kRow = 27;
const ink = (name: string): string => (name.startsWith("--") ? getComputedStyle(document.documentElement).getPropertyValue(name).trim() : name);

export class Lanes {
  private readonly canvas = make("canvas", { role: "img" });
  private readonly mark = make("div", { class: "now-mark" });
  private readonly labels = make("div", { class: "lane-labels", "aria-hidden": "true" });
  private data: LaneData | null = null;
  private duration = 1;
  private now = 0;

  constructor(seek: (time_s: number) => void) {
    const legend = make("ul", { class: "legend" }, ...kLanes.map(([words, colour, strength]) =>
      make("li", {}, make("span", { class: "swatch", style: `background:${colour.startsWith("--") ? `var(${colour})` : colour};opacity:${strength}` }), words)));
    byId("lanes").append(make("div", { class: "lanes" }, this.labels, this.canvas, this.mark), legend);
    this.canvas.addEventListener("pointerdown", (event) => {
      const frame = this.canvas.getBoundingClientRect();
      seek((this.duration * (event.clientX - frame.left)) / frame.width);
    });
    new ResizeObserver(() => this.draw()).observe(byId("lanes"));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  show(data: LaneData, duration: number): void {
    this.data = data;
    this.duration = duration;
    this.labels.replaceChildren(make("span", { style: `height:${kBand}px` }, "state"),
      ...Array.from({ length: data.sensors }, (_, i) => make("span", { style: `height:${kRow}px` }, `a${i + 1}`)));
    const ever = kLanes.map(([words], k) => `${words}: ${sensorsOf(union(data.sets[k]))}`);
    this.canvas.setAttribute("aria-label", `The state and every sensor over time. ${ever.join("; ")}. The table below says more.`);
    this.draw();
  }

  cursor(time_s: number): void {
    this.now = time_s;
    this.mark.style.transform = `translateX(${((this.canvas.clientWidth * time_s) / this.duration).toFixed(1)}px)`;
  }

  private draw(): void {
    const data = this.data;
    const width = this.canvas.parentElement!.clientWidth - kLeft - kRight;
    if (!data || width <= 0) return;
    const height = kBand + data.sensors * kRow;
    const ratio = devicePixelRatio;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    this.canvas.style.height = `${height}px`;
    const context = this.canvas.getContext("2d")!;
    context.scale(ratio, ratio);
    const at = (k: number) => (data.time[Math.min(k, data.time.length - 1)] / this.duration) * width;
    runs(data.state, (value) => value + 1, (from, to, value) => {
      context.fillStyle = kStateColours[value - 1];
      context.fillRect(at(from), 0, Math.max(1, at(to) - at(from)), kBand - 4);
    });
    context.fillStyle = ink("--line");
    for (let i = 0; i < data.sensors; ++i) context.fillRect(0, kBand + i * kRow + kRow - 2, width, 1);
    kLanes.forEach(([, colour, strength], lane) => {
      context.fillStyle = ink(colour);
      context.globalAlpha = strength;
      for (let i = 0; i < data.sensors; ++i) {
        const top = kBand + i * kRow + 6 * kStrip[lane];
        runs(data.sets[lane] ?? [], (bits) => (bits >> i) & 1, (from, to) => context.fillRect(at(from), top, Math.max(1.5, at(to) - at(from)), 5));
      }
    });
    context.globalAlpha = 1;
    this.cursor(this.now);
  }
}

function union(list: ArrayLike<number>): number {
  let all = 0;
  for (let k = 0; k < list.length; ++k) all |= list[k];
  return all;
}

/** Calls back for each run of equal values that are not zero. */
function runs(list: ArrayLike<number>, f: (x: number) => number, found: (from: number, to: number, value: number) => void): void {
  let from = 0;
  for (let k = 1; k <= list.length; ++k) {
    const value = f(list[from]);
    if (k < list.length && f(list[k]) === value) continue;
    if (value) found(from, k, value);
    from = k;
  }
}
