// Two designs side by side: one that was kept, and the one that is edited.
import { byId, degrees, figure, make, mg0 } from "./dom";
import { unitsOf, type Geometry } from "./geometry";

/** `better` says which way a figure is better; 0: neither. */
interface Line {
  words: string;
  better: 1 | -1 | 0;
  value: number | null;
  text: string;
}

// eslint-disable-next-line @typescript-eslint/no-explicit-any
type Said = any;

function linesOf(geometry: Geometry, said: Said): Line[] {
  const merit = said.figures_of_merit;
  const sizes = said.detection_sizes.stability_0;
  const size = (words: string, value: number | null): Line => ({ words, better: -1, value, text: mg0(value) });
  const count = (words: string, value: number | null, better: Line["better"] = 1): Line => ({ words, better, value, text: value === null ? "none" : String(value) });
  const plain = (words: string, value: number | null, better: Line["better"], unit = ""): Line => ({ words, better, value, text: figure(value, unit) });
  const level: number | null = sizes.protection_level_at_rest_deg ?? (sizes.protection_level_at_rest_rad === undefined ? null : degrees(sizes.protection_level_at_rest_rad));
  return [
    count("sensors", geometry.axes.length, 0),
    count("units that fail at once", unitsOf(geometry.chips).length, 0),
    count("faulty units isolated at rest", merit.confirmed_grade),
    count("faulty units isolated without gravity", merit.provisional_grade),
    count("faulty units isolated in motion", said.motion_grade),
    size("minimum detectable bias", sizes.minimum_detectable_bias_mps2),
    size("guaranteed detection threshold, any attitude", sizes.guaranteed_detection_any_mps2),
    size("guaranteed isolation threshold", sizes.guaranteed_isolation_mps2),
    plain("protection level at rest", level, -1, "deg"),
    plain("GDOP", merit.gdop, -1),
    plain("condition", merit.condition, -1),
    plain("smallest angle between two axes", merit.nearest_angle_deg, 1, "deg"),
    plain("visibility of a bias that all share", merit.common_bias_visibility, 1),
    count("critical sensors", said.critical_sensors.length, -1),
    count("wiring mistakes that no test sees", said.unobservable_permutations.length, -1),
    plain("one attitude alone: every larger fault isolated, at the worst", oneAttitude(said), -1, "mg0"),
  ];
}

function oneAttitude(said: Said): number | null {
  const worst = said.one_attitude?.guaranteed_above_worst_mps2 ?? null;
  return worst === null ? null : (1000 * worst) / 9.80665;
}

export class Comparison {
  private kept: { name: string; lines: Line[] } | null = null;
  private latest: { name: string; lines: Line[] } | null = null;

  constructor() {
    byId("keep-design").addEventListener("click", () => {
      this.kept = this.latest;
      this.show();
    });
    byId("drop-design").addEventListener("click", () => {
      this.kept = null;
      this.show();
    });
    this.show();
  }

  now(geometry: Geometry, said: Said): void {
    this.latest = { name: nameOf(geometry), lines: linesOf(geometry, said) };
    this.show();
  }

  private show(): void {
    const { kept, latest } = this;
    byId("drop-design").hidden = kept === null;
    if (!kept || !latest) {
      byId("compare").replaceChildren(make("p", { class: "note" }, "Keep a design, then choose or change another: the two stand here side by side."));
      return;
    }
    const rows = kept.lines.map((old, k) => {
      const now = latest.lines[k];
      const gain = gainOf(old, now);
      const mark = gain > 0 ? "better" : gain < 0 ? "worse" : old.text === now.text ? "" : "differs";
      const words = { better: "\u25b2\u00a0better", worse: "\u25bc\u00a0worse", differs: "differs", "": "" }[mark];
      return make("tr", { class: mark || undefined },
        make("th", { scope: "row" }, old.words), make("td", {}, old.text),
        make("td", {}, now.text, words ? make("span", { class: "mark" }, words) : null));
    });
    byId("compare").replaceChildren(
      make("div", { class: "card wide", tabindex: 0, role: "region", "aria-label": "Two designs side by side" },
        make("table", { class: "compare" },
          make("thead", {}, make("tr", {}, ...["figure", `kept: ${kept.name}`, `now: ${latest.name}`].map((text) => make("th", { scope: "col" }, text)))),
          make("tbody", {}, ...rows))),
    );
  }
}

/** Above 0: better now; a size that there is none of is worse than any. */
function gainOf(old: Line, now: Line): number {
  if (old.better === 0 || old.text === now.text) return 0;
  const none = old.better > 0 ? -Infinity : Infinity;
  return Math.sign(((now.value ?? none) - (old.value ?? none)) * old.better);
}

function nameOf(geometry: Geometry): string {
  const words = [...document.querySelectorAll<HTMLOptionElement>("#geometry option")].find((option) => option.value === geometry.name)?.textContent;
  return geometry.name === "own" || !words ? `own axes, ${geometry.axes.length}` : words;
}
