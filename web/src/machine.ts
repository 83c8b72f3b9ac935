// The state machine as a diagram: where it is, and the last way it went.
import type { Vocabulary } from "./core";
import { byId, svg } from "./dom";

/** The colours of the states in the reports. */
export const kStateColours = ["#2c8f57", "#b97a00", "#2f78b7", "#8f55c4", "#1f8a99", "#c53a3a"];

/** nominal, suspect, isolated, degraded, recalibrating, failed */
const kPlaces: [number, number][] = [[90, 45], [300, 45], [90, 150], [90, 255], [510, 45], [510, 255]];
const kHalf = [68, 22];

export class Machine {
  private readonly boxes: SVGElement[] = [];
  private readonly ways = new Map<string, SVGElement>();
  private readonly label: SVGElement;

  constructor(words: Vocabulary) {
    const arrow = svg("marker", { id: "arrow", viewBox: "0 0 8 8", refX: 7, refY: 4, markerWidth: 7, markerHeight: 7, orient: "auto" },
      svg("path", { d: "M0 0 8 4 0 8z", fill: "context-stroke" }));
    const picture = svg("svg", { viewBox: "0 0 600 300", "aria-hidden": "true" }, svg("defs", {}, arrow));
    for (const [from, to] of waysOf(words)) {
      const way = svg("path", { d: wayBetween(from, to), class: "way", "marker-end": "url(#arrow)" });
      this.ways.set(`${from}-${to}`, way);
      picture.append(way);
    }
    words.states.forEach((name, k) => {
      const [x, y] = kPlaces[k];
      const box = svg("g", { class: "state-box", style: `--state:${kStateColours[k]}` },
        svg("rect", { x: x - kHalf[0], y: y - kHalf[1], width: 2 * kHalf[0], height: 2 * kHalf[1], rx: 10 }),
        svg("text", { x, y: y + 5, "text-anchor": "middle" }, stateWords(name)));
      this.boxes.push(box);
      picture.append(box);
    });
    this.label = svg("text", { x: 300, y: 292, "text-anchor": "middle", class: "way-label" });
    picture.append(this.label);
    byId("machine").append(picture);
  }

  show(state: number, from: number, to: number, event: string): void {
    this.boxes.forEach((box, k) => box.classList.toggle("is-here", k === state));
    for (const way of this.ways.values()) way.classList.remove("was-taken");
    this.ways.get(`${from}-${to}`)?.classList.add("was-taken");
    this.label.textContent = event;
  }
}

export const stateWords = (name: string): string => name.replace(/_.*/, "");

/** Which states follow which, by the table: conditional targets are all that they may become. */
function waysOf(words: Vocabulary): [number, number][] {
  const state = (name: string): number => words.states.findIndex((one) => stateWords(one) === name);
  const leadsTo = (target: string): string[] => [
    ...(/by size/.test(target) ? ["nominal", "isolated", "degraded", "failed"] : []),
    ...["suspect", "recalibrating", "failed"].filter((name) => target.includes(name)),
  ];
  const found = new Set<string>();
  for (const cell of words.table) {
    const name = words.modes[cell.mode] === "initial" ? "recalibrating" : words.modes[cell.mode];
    for (const target of leadsTo(cell.target)) {
      if (target !== name) found.add(`${state(name)}-${state(target)}`);
    }
  }
  return [...found].map((way) => way.split("-").map(Number) as [number, number]);
}

/** From edge to edge of two boxes, bent to one side, so that there and back lie apart. */
function wayBetween(from: number, to: number): string {
  const [a, b] = [kPlaces[from], kPlaces[to]];
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  const side = [-(b[1] - a[1]) / length, (b[0] - a[0]) / length];
  // nominal and degraded stand above one another with isolated between them
  const bend = from + to === 3 && from * to === 0 ? 95 : 16;
  const middle = [(a[0] + b[0]) / 2 + bend * side[0], (a[1] + b[1]) / 2 + bend * side[1]];
  const [p, q] = [edge(a, middle), edge(b, middle)];
  return `M${p.join(" ")} Q${middle.map((x) => x.toFixed(1)).join(" ")} ${q.join(" ")}`;
}

/** Where the line from the middle of a box towards a point leaves it. */
function edge(box: number[], towards: number[]): string[] {
  const d = [towards[0] - box[0], towards[1] - box[1]];
  const part = Math.min(...d.map((x, k) => (x === 0 ? Infinity : (kHalf[k] + 3) / Math.abs(x))));
  return [box[0] + part * d[0], box[1] + part * d[1]].map((x) => x.toFixed(1));
}
