// Charts over time: the state as a band, statistic against limit, and how far the output is off.
import uPlot from "uplot";
import { kStateColours } from "./machine";
import { byId } from "./dom";

/** Null where there is no figure. */
type Figures = (number | null)[];

export interface Series {
  time: number[];
  state: number[];
  statistic: Figures;
  limit: Figures;
  error_deg: Figures;
  plain_deg: Figures;
  protection_deg: Figures;
}

const ink = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const kHeight = 190;
const kBand = 26;

/** Least angle that is drawn: a logarithm has no zero. */
const kLeast_deg = 1e-4;

export class Timeline {
  private charts: uPlot[] = [];
  private band = byId<HTMLCanvasElement>("band");
  private data: Series | null = null;
  private now = 0;
  private duration = 1;

  constructor(private readonly seek: (time_s: number) => void) {
    new ResizeObserver(() => this.resize()).observe(byId("timeline"));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.build());
    this.band.addEventListener("pointerdown", (event) => {
      const frame = this.band.getBoundingClientRect();
      this.seek((this.duration * (event.clientX - frame.left)) / frame.width);
    });
  }

  private width(): number {
    return Math.max(200, byId("timeline").clientWidth);
  }

  show(data: Series, duration: number): void {
    const fresh = this.charts.length === 0;
    this.data = data;
    this.duration = duration;
    if (fresh) this.build();
    const [first, second] = this.charts;
    const x = { min: 0, max: duration };
    const lists = [
      [data.time, data.statistic, data.limit],
      [data.time, data.plain_deg, data.error_deg, data.protection_deg],
    ] as unknown as uPlot.AlignedData[];
    [first, second].forEach((chart, k) => {
      chart.batch(() => {
        chart.setData(lists[k], false);
        chart.setScale("x", x);
      });
    });
    this.drawBand();
  }

  cursor(time_s: number): void {
    this.now = time_s;
    for (const chart of this.charts) chart.redraw(false, false);
    this.drawBand();
  }

  private options(title: string, series: uPlot.Series[], logarithmic: boolean, units: string): uPlot.Options {
    const axis = { stroke: ink("--soft"), grid: { stroke: ink("--line"), width: 1 }, ticks: { stroke: ink("--line"), width: 1 } };
    return {
      title,
      width: this.width(),
      height: kHeight,
      cursor: { drag: { x: false, y: false }, points: { show: false } },
      legend: { show: true, live: false },
      scales: { x: { time: false }, y: { distr: logarithmic ? 3 : 1 } },
      axes: [
        { ...axis, size: 34 },
        {
          ...axis,
          size: 52,
          label: units || undefined,
          labelSize: 16,
          // Of a logarithm the powers of ten alone: their parts would fill a small chart with lines.
          ...(logarithmic ? { filter: (_: uPlot, at: number[]) => at.map((v) => (isPower(v) ? v : (null as unknown as number))) } : {}),
          values: logarithmic ? (_: uPlot, at: (number | null)[]) => at.map((v) => (v === null ? "" : String(v))) : undefined,
        },
      ],
      series: [{ label: "time", value: (_, v) => (v === null ? "" : `${v.toFixed(2)} s`) }, ...series],
      hooks: {
        draw: [
          (chart) => {
            const x = chart.valToPos(this.now, "x", true);
            chart.ctx.save();
            chart.ctx.strokeStyle = ink("--ink");
            chart.ctx.lineWidth = devicePixelRatio;
            chart.ctx.beginPath();
            chart.ctx.moveTo(x, chart.bbox.top);
            chart.ctx.lineTo(x, chart.bbox.top + chart.bbox.height);
            chart.ctx.stroke();
            chart.ctx.restore();
          },
        ],
        ready: [
          (chart) => chart.over.addEventListener("pointerdown", (event) => this.seek(chart.posToVal(event.offsetX, "x"))),
        ],
      },
    };
  }

  private build(): void {
    for (const chart of this.charts) chart.destroy();
    byId("charts").replaceChildren();
    const line = (label: string, colour: string, more: Partial<uPlot.Series> = {}): uPlot.Series => ({
      label, stroke: colour, width: 1.5, points: { show: false }, ...more,
    });
    const charts: [string, uPlot.Series[], boolean, string][] = [
      ["Statistic of the test that decided, against its limit",
        [line("statistic", kStateColours[2]), line("limit", kStateColours[5], { dash: [5, 4] })], true, ""],
      ["How far the direction is off",
        [line("all sensors, no monitor", ink("--soft")), line("what plumb says", kStateColours[0], { width: 2 }),
          line("protection level", kStateColours[5], { dash: [5, 4] })], true, "deg"],
    ];
    this.charts = charts.map(([title, series, logarithmic, units]) =>
      new uPlot(this.options(title, series, logarithmic, units), [[], ...series.map(() => [])] as unknown as uPlot.AlignedData, byId("charts")));
    if (this.data) this.show(this.data, this.duration);
  }

  private resize(): void {
    const width = this.width();
    for (const chart of this.charts) if (chart.width !== width) chart.setSize({ width, height: kHeight });
    this.drawBand();
  }

  private drawBand(): void {
    const data = this.data;
    if (!data) return;
    const ratio = devicePixelRatio;
    this.band.width = this.width() * ratio;
    this.band.height = kBand * ratio;
    const context = this.band.getContext("2d")!;
    const scale = this.band.width / this.duration;
    let from = 0;
    for (let k = 1; k <= data.time.length; ++k) {
      if (k < data.time.length && data.state[k] === data.state[from]) continue;
      context.fillStyle = kStateColours[data.state[from]];
      const end = k < data.time.length ? data.time[k] : data.time[k - 1];
      context.fillRect(data.time[from] * scale, 0, Math.max(1, (end - data.time[from]) * scale), this.band.height);
      from = k;
    }
    context.fillStyle = ink("--ink");
    context.fillRect(this.now * scale - ratio, 0, 2 * ratio, this.band.height);
  }
}

const isPower = (v: number): boolean => Math.abs(Math.log10(v) - Math.round(Math.log10(v))) < 1e-6;

/** For a chart with a logarithm: nothing is drawn where there is no figure. */
export function degreesFor(rad: number): number | null {
  return Number.isFinite(rad) ? Math.max(kLeast_deg, (rad * 180) / Math.PI) : null;
}
