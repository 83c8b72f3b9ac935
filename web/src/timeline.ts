// Charts over time: statistic against limit, and how far the output of each rule is off.
import uPlot from "uplot";
import { byId } from "./dom";
import { kLeft, kRight } from "./lanes";
import { kStateColours } from "./machine";

/** Null where there is no figure. */
type Figures = ArrayLike<number | null>;

export interface Series {
  time: ArrayLike<number>;
  /** Statistic and limit of the test that decided; none in a flight. */
  test: Figures[] | null;
  /** In the order of `kOff`. */
  off: Figures[];
  unit: string;
}

/** All sensors, plumb, its bound, the paper's rule, PX4. */
const kOff: [string, string, Partial<uPlot.Series>][] = [
  ["all sensors, no monitor", "--soft", {}],
  ["the paper's rule", "#d0553c", {}],
  ["PX4", "#8f55c4", {}],
  ["plumb", kStateColours[0], { width: 2 }],
  ["plumb's bound", kStateColours[5], { dash: [5, 4] }],
];
const kTest: typeof kOff = [
  ["statistic", kStateColours[2], {}],
  ["limit", kStateColours[5], { dash: [5, 4] }],
];

const ink = (name: string): string => (name.startsWith("--") ? getComputedStyle(document.documentElement).getPropertyValue(name).trim() : name);
const kHeight = 190;
const kLabel = 16;

/** Least figure that is drawn: a logarithm has no zero. */
const kLeast = 1e-4;

export class Timeline {
  private charts: uPlot[] = [];
  private marks: HTMLElement[] = [];
  private data: Series | null = null;
  private built = "";
  private now = 0;
  private duration = 1;

  constructor(private readonly seek: (time_s: number) => void) {
    new ResizeObserver(() => this.resize()).observe(byId("timeline"));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.build());
  }

  private width(): number {
    return Math.max(200, byId("charts").clientWidth);
  }

  show(data: Series, duration: number): void {
    this.data = data;
    this.duration = duration;
    if (this.built !== kindOf(data)) this.build();
    const lists = [...(data.test ? [data.test] : []), data.off.filter((figures) => figures.length > 0)].map((figures) => [data.time, ...figures] as unknown as uPlot.AlignedData);
    this.charts.forEach((chart, k) => {
      chart.batch(() => {
        chart.setData(lists[k], false);
        chart.setScale("x", { min: 0, max: duration });
      });
    });
    this.cursor(this.now);
  }

  cursor(time_s: number): void {
    this.now = time_s;
    this.charts.forEach((chart, k) => (this.marks[k].style.transform = `translateX(${(((chart.width - kLeft - kRight) * time_s) / this.duration).toFixed(1)}px)`));
  }

  private options(title: string, series: uPlot.Series[], units: string): uPlot.Options {
    const axis = { stroke: ink("--soft"), grid: { stroke: ink("--line"), width: 1 }, ticks: { stroke: ink("--line"), width: 1 } };
    return {
      title,
      width: this.width(),
      height: kHeight,
      padding: [null, kRight, null, 0],
      cursor: { drag: { x: false, y: false }, points: { show: false } },
      legend: { show: true, live: false },
      scales: { x: { time: false }, y: { distr: 3 } },
      axes: [
        { ...axis, size: 34 },
        {
          ...axis,
          size: units ? kLeft - kLabel : kLeft,
          label: units || undefined,
          labelSize: kLabel,
          // Of a logarithm the powers of ten alone: their parts would fill a small chart with lines.
          splits: (_: uPlot, __: number, min: number, max: number) => powers(min, max),
          values: (_: uPlot, at: (number | null)[]) => at.map((v) => (v === null ? "" : String(v))),
        },
      ],
      series: [{ label: "time", value: (_, v) => (v === null ? "" : `${v.toFixed(2)} s`) }, ...series],
      hooks: {
        ready: [
          (chart) => {
            const mark = document.createElement("div");
            mark.className = "now-mark in-chart";
            chart.over.append(mark);
            this.marks.push(mark);
            chart.over.addEventListener("pointerdown", (event) => this.seek(chart.posToVal(event.offsetX, "x")));
          },
        ],
      },
    };
  }

  private build(): void {
    for (const chart of this.charts) chart.destroy();
    this.marks = [];
    const data = this.data;
    if (!data) return;
    byId("charts").replaceChildren();
    byId("charts").classList.toggle("is-one", data.test === null);
    this.built = kindOf(data);
    const lines = (of: typeof kOff): uPlot.Series[] =>
      of.map(([label, colour, more]) => ({ label, stroke: ink(colour), width: 1.5, points: { show: false }, ...more }));
    const there = kOff.map((one, k) => [one, data.off[k]] as const).filter(([, figures]) => figures.length > 0).map(([one]) => one);
    const charts: [string, uPlot.Series[], string][] = [
      ...(data.test ? [["Statistic of the test that decided, against its limit", lines(kTest), ""] as [string, uPlot.Series[], string]] : []),
      [data.test ? "How far the direction is off" : "How far the specific force is off", lines(there), data.unit],
    ];
    this.charts = charts.map(([title, series, units]) =>
      new uPlot(this.options(title, series, units), [[], ...series.map(() => [])] as unknown as uPlot.AlignedData, byId("charts")));
    this.show(data, this.duration);
  }

  private resize(): void {
    const width = this.width();
    for (const chart of this.charts) if (chart.width !== width) chart.setSize({ width, height: kHeight });
    this.cursor(this.now);
  }
}

/** Charts are built anew where other lines are in them. */
const kindOf = (data: Series): string => `${data.unit} ${data.off.map((figures) => (figures.length > 0 ? 1 : 0)).join("")}`;

/** At most seven of them. */
function powers(min: number, max: number): number[] {
  const [first, last] = [Math.ceil(Math.log10(min) - 1e-9), Math.floor(Math.log10(max) + 1e-9)];
  const step = Math.max(1, Math.ceil((last - first) / 6));
  return Array.from({ length: Math.max(0, Math.floor((last - first) / step) + 1) }, (_, k) => Number(`1e${first + k * step}`));
}

/** For a chart with a logarithm: nothing is drawn where there is no figure. */
export function drawable(value: number): number | null {
  return Number.isFinite(value) ? Math.max(kLeast, value) : null;
}
