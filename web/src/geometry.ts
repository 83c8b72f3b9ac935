// Geometries by name: those of the core, and the page's own of chips with three axes each.
import type { Core, Vec3 } from "./core";

export interface Geometry {
  name: string;
  axes: Vec3[];
  /** The chip of every sensor, counted from 1; 0: a unit of its own. */
  chips: number[];
  noise_mps2: number;
}

export const kBuiltIn: [string, string][] = [
  ["paper-tetrahedron", "Tetrahedron of the paper, 4"],
  ["platonic:4", "Octahedron's faces, 4"],
  ["cone-axis:5", "Cone and its axis, 5"],
  ["cone:5", "Cone, 5"],
  ["platonic:6", "Dodecahedron's faces, 6"],
  ["cone-axis:8", "Cone and its axis, 8"],
  ["cone:8", "Cone, 8"],
  ["triads", "Two triads, turned against each other, 6"],
  ["chips:2", "Two chips, turned against each other, 6"],
  ["chips:3", "Three chips, parallel, 9"],
  ["triad", "One triad, 3"],
];

const kTriad: Vec3[] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];

/** A triad turned by 45 deg about x and then about z. */
function turnedTriad(): Vec3[] {
  const r = Math.SQRT1_2;
  return [[r, r, 0], [-0.5, 0.5, r], [0.5, -0.5, r]];
}

const copies = (axes: Vec3[]): Vec3[] => axes.map((axis) => [...axis]);

export function shapeOf(core: Core, name: string): Pick<Geometry, "axes" | "chips"> {
  const single = (axes: Vec3[]) => ({ axes, chips: axes.map(() => 0) });
  if (name === "triads") return single([...copies(kTriad), ...turnedTriad()]);
  if (name === "chips:2") return { axes: [...copies(kTriad), ...turnedTriad()], chips: [1, 1, 1, 2, 2, 2] };
  if (name === "chips:3") return { axes: [...copies(kTriad), ...copies(kTriad), ...copies(kTriad)], chips: [1, 1, 1, 2, 2, 2, 3, 3, 3] };
  return single(core.builtin(name));
}

export const noChips = (n: number): number[] => Array.from({ length: n }, () => 0);

/** Numbers of the chips that the array has. */
export const chipsIn = (chips: number[]): number[] => [...new Set(chips.filter((chip) => chip > 0))].sort((a, b) => a - b);

/** Bits of the sensors that fail together with sensor i: its chip, or itself. */
export function unitOf(chips: number[], i: number): number {
  if (!chips[i]) return 1 << i;
  return chips.reduce((bits, chip, k) => (chip === chips[i] ? bits | (1 << k) : bits), 0);
}

/** Bits of the sensors of each unit, in the order of their first sensor. */
export function unitsOf(chips: number[]): number[] {
  return [...new Set(chips.map((_, i) => unitOf(chips, i)))];
}

/** All sensors of the units that have one of these. */
export const wholeUnits = (chips: number[], bits: number): number =>
  chips.reduce((all, _, i) => ((bits >> i) & 1 ? all | unitOf(chips, i) : all), 0);

/** "chip 2 (a4 a5 a6)", or "a3". */
export function unitWords(chips: number[], unit: number): string {
  const members = chips.map((_, i) => i).filter((i) => (unit >> i) & 1);
  const names = members.map((i) => `a${i + 1}`).join(" ");
  return members.length && chips[members[0]] ? `chip ${chips[members[0]]} (${names})` : names;
}

/** Turns the other axes of a chip along when one of them is turned. */
export function turnChip(geometry: Geometry, index: number, to: Vec3): void {
  const chip = geometry.chips[index];
  const from = unit(geometry.axes[index]);
  const onto = unit(to);
  const about = cross(from, onto);
  const cosine = dot(from, onto);
  if (!chip || cosine < -0.999999) return;
  geometry.chips.forEach((other, k) => {
    if (other !== chip || k === index) return;
    const v = geometry.axes[k];
    const c = cross(about, v);
    const along = dot(about, v) / (1 + cosine);
    geometry.axes[k] = v.map((x, i) => Number((x * cosine + c[i] + about[i] * along).toFixed(6))) as Vec3;
  });
}

const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: Vec3, b: Vec3): Vec3 => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (v: Vec3): Vec3 => v.map((x) => x / Math.hypot(...v)) as Vec3;
