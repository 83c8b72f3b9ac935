// The first view: a geometry, what it is worth, and the array file of it.
import { Core, Refusal, type Vec3 } from "./core";
import { byId, deg, download, figure, kG0, make, mg0, table } from "./dom";
import { Comparison } from "./compare";
import { chipsIn, kBuiltIn, shapeOf, turnChip, unitsOf, unitWords, type Geometry } from "./geometry";
import { sensorSizes } from "./sizes";
import { kAxisColours, Sphere } from "./sphere";

export class Design {
  geometry: Geometry;
  private readonly sphere: Sphere;
  private readonly comparison = new Comparison();
  private waiting = 0;

  constructor(
    private readonly core: Core,
    private readonly changed: () => void,
  ) {
    this.geometry = { name: "paper-tetrahedron", ...shapeOf(core, "paper-tetrahedron"), noise_mps2: 2e-4 * kG0 };
    this.sphere = new Sphere("The axes of the sensors on a sphere. The table beside it holds the same numbers.", (k, axis, done) =>
      this.move(k, axis, done),
    );
    byId("design-sphere").append(this.sphere.element);
    const choice = byId<HTMLSelectElement>("geometry");
    for (const [name, words] of kBuiltIn) choice.append(make("option", { value: name }, words));
    choice.append(make("option", { value: "own" }, "Own axes"));
    choice.addEventListener("change", () => this.choose(choice.value));
    const noise = byId<HTMLInputElement>("noise");
    noise.addEventListener("input", () => {
      const value = Number(noise.value);
      if (!(value > 0)) return;
      this.geometry.noise_mps2 = value * 1e-6 * kG0;
      this.later();
    });
    byId("add-axis").addEventListener("click", () => this.resize(this.geometry.axes.length + 1));
    byId("add-triad").addEventListener("click", () => this.addTriad());
    byId("remove-axis").addEventListener("click", () => this.resize(this.geometry.axes.length - 1));
    byId("download-array").addEventListener("click", () => download(`${this.fileName()}.toml`, this.arrayFile()));
    this.show();
  }

  choose(name: string): void {
    if (name !== "own") this.geometry = { ...this.geometry, name, ...shapeOf(this.core, name) };
    this.show();
  }

  /** What another page of this explorer had. */
  restore(geometry: Geometry): void {
    const axes = geometry.axes;
    const sound = axes.length >= 3 && axes.length <= this.core.words.capacity && axes.every((axis) => axis.length === 3 && axis.every(Number.isFinite)) && geometry.chips.length === axes.length;
    if (!sound || !(geometry.noise_mps2 > 0)) throw new Error("this is no geometry");
    this.geometry = geometry;
    const known = [...byId<HTMLSelectElement>("geometry").options].some((option) => option.value === geometry.name);
    byId<HTMLSelectElement>("geometry").value = known ? geometry.name : "own";
    byId<HTMLInputElement>("noise").value = String(Number(((geometry.noise_mps2 * 1e6) / kG0).toPrecision(12)));
    this.show();
  }

  /** The array file of these axes, as the tool reads it: sensors of the paper's kind. */
  arrayFile(): string {
    const head = `name = "${this.fileName()}"

[gravity]
model = "value"
value = "${kG0} m/s^2"
sigma = "0.15 mg"

[input]
reads = "gravity"
unit = "V"
time = "t_s"
station = "station"

[monitor]
alert_frame = "calibrated-axes"
`;
    const noise = Number(((this.geometry.noise_mps2 * 1e6) / kG0).toPrecision(12));
    const component = (x: number) => (Number.isInteger(x) ? `${x === 0 ? 0 : x}.0` : String(x));
    const sensors = this.units().map(
      (axis, i) => `
[[sensor]]
id = "a${i + 1}"
axis = [${axis.map(component).join(", ")}]
scale = "3 V/g0"
noise = "${noise} ug0"${this.geometry.chips[i] ? `\npackage = "chip${this.geometry.chips[i]}"` : ""}
full_scale = "5 V"
resolution = "152.587890625 uV"
prior = {bias = "20 mg0", scale = "2 %", axis = "0.035 rad"}
`,
    );
    return head + sensors.join("");
  }

  private fileName(): string {
    return this.geometry.name.replace(":", "-");
  }

  private units(): Vec3[] {
    return this.geometry.axes.map((axis) => {
      const length = Math.hypot(...axis);
      return Math.abs(length - 1) > 1e-9 ? (axis.map((x) => x / length) as Vec3) : axis;
    });
  }

  private own(): void {
    this.geometry.name = "own";
    byId<HTMLSelectElement>("geometry").value = "own";
  }

  private resize(n: number): void {
    if (n < 3 || n > this.core.words.capacity) return;
    const spread = n - this.geometry.axes.length;
    if (spread < 0) this.geometry.axes = this.geometry.axes.slice(0, n);
    else this.geometry.axes = [...this.geometry.axes, this.farthest()];
    this.geometry.chips = Array.from({ length: n }, (_, i) => this.geometry.chips[i] ?? 0);
    this.own();
    this.show();
  }

  /** A chip with three axes, turned away from those that are there; of a design without chips a chip all the same. */
  private addTriad(): void {
    const { axes, chips } = this.geometry;
    if (axes.length + 3 > this.core.words.capacity) return;
    const x = this.farthest();
    const side = Math.abs(x[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0];
    const y = rounded(normal(x, side));
    const chip = Math.max(0, ...chips) + 1;
    this.geometry.axes = [...axes, x, y, rounded(normal(x, y))];
    this.geometry.chips = [...chips, chip, chip, chip];
    this.own();
    this.show();
  }

  /** The direction whose line is farthest from those of all axes, of many on a spiral. */
  private farthest(): Vec3 {
    let best: Vec3 = [0, 0, 1];
    let least = 2;
    for (let k = 0; k < 400; ++k) {
      const z = 1 - (2 * k + 1) / 400;
      const r = Math.sqrt(1 - z * z);
      const a = k * Math.PI * (3 - Math.sqrt(5));
      const axis: Vec3 = [r * Math.cos(a), r * Math.sin(a), z];
      const near = Math.max(...this.units().map((u) => Math.abs(u[0] * axis[0] + u[1] * axis[1] + u[2] * axis[2])));
      if (near < least) [least, best] = [near, axis];
    }
    return rounded(best);
  }

  private move(index: number, axis: Vec3, done: boolean): void {
    turnChip(this.geometry, index, axis);
    this.geometry.axes[index] = rounded(axis);
    this.own();
    this.drawSphere();
    this.fillInputs();
    if (done) this.study();
    else this.later();
  }

  /** Studies once the hand rests. */
  private later(): void {
    clearTimeout(this.waiting);
    this.waiting = window.setTimeout(() => this.study(), 150);
  }

  private show(): void {
    this.tabulate();
    this.drawSphere();
    this.study();
  }

  private drawSphere(): void {
    this.sphere.show(
      this.geometry.axes.map((axis, i) => ({ label: `a${i + 1}`, colour: kAxisColours[i % kAxisColours.length], axis })),
    );
  }

  private tabulate(): void {
    const rows = this.geometry.axes.map((_, i) => [
      make("span", { class: "dot", style: `--dot:${kAxisColours[i % kAxisColours.length]}` }, `a${i + 1}`),
      ...["x", "y", "z"].map((name, k) => {
        const input = make("input", { type: "number", step: "0.01", min: -1, max: 1, "aria-label": `a${i + 1} ${name}` });
        input.addEventListener("input", () => {
          if (input.value === "" || !Number.isFinite(input.valueAsNumber)) return;
          this.geometry.axes[i][k] = input.valueAsNumber;
          this.own();
          this.drawSphere();
          this.later();
        });
        return input;
      }),
      this.chipChoice(i),
    ]);
    byId("axes").replaceChildren(table("Axes of the sensors", ["sensor", "x", "y", "z", "chip"], rows));
    this.fillInputs();
  }

  private chipChoice(i: number): HTMLElement {
    const choice = make("select", { "aria-label": `a${i + 1} chip` });
    const most = Math.min(this.core.words.capacity, Math.max(0, ...this.geometry.chips) + 1);
    for (let chip = 0; chip <= most; ++chip) {
      choice.append(make("option", { value: chip, selected: this.geometry.chips[i] === chip }, chip ? String(chip) : "own"));
    }
    choice.addEventListener("change", () => {
      this.geometry.chips[i] = Number(choice.value);
      this.own();
      this.show();
    });
    return choice;
  }

  private fillInputs(): void {
    const inputs = byId("axes").querySelectorAll("input");
    this.geometry.axes.flat().forEach((x, k) => {
      if (document.activeElement !== inputs[k]) inputs[k].value = String(Number(x.toFixed(4)));
    });
  }

  private study(): void {
    clearTimeout(this.waiting);
    try {
      const said = this.core.study({ ...this.geometry, samples: 32, map: 1 });
      byId("design-error").hidden = true;
      this.tell(said);
      this.comparison.now(this.geometry, said);
      this.changed();
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      byId("design-error").hidden = false;
      byId("design-error").textContent = error.message;
    }
  }

  // eslint-disable-next-line @typescript-eslint/no-explicit-any
  private tell(said: any): void {
    const merit = said.figures_of_merit;
    const sizes = said.detection_sizes.stability_0 ?? Object.values(said.detection_sizes).find((v) => v && typeof v === "object");
    const card = (value: string, label: string, tone = "") =>
      make("div", { class: `card ${tone}` }, make("b", {}, value), make("span", {}, label));
    const what = chipsIn(this.geometry.chips).length ? "unit" : "sensor";
    const isolable = (n: number | null, words: string) =>
      card(n === null ? "none" : String(n), `faulty ${plural(n ?? 0, what)} isolated ${words}`, n ? "good" : "");
    byId("design-figures").replaceChildren(
      isolable(merit.confirmed_grade, "at rest"),
      isolable(said.motion_grade, said.motion_grade === null ? "in motion: 12 sensors at most are judged there" : "in motion"),
      card(mg0(sizes.minimum_detectable_bias_mps2), "minimum detectable bias"),
      card(mg0(sizes.guaranteed_detection_any_mps2), "guaranteed detection threshold, any attitude"),
      card(mg0(sizes.guaranteed_isolation_mps2), "guaranteed isolation threshold"),
      card(protection(sizes), "protection level at rest"),
    );
    byId("design-merit").replaceChildren(
      table(
        "Figures of merit",
        ["figure", "value"],
        [
          ["GDOP: noise of the vector in noises of a sensor", figure(merit.gdop, "")],
          ["Condition", figure(merit.condition, "")],
          ["Smallest angle between two axes", figure(merit.nearest_angle_deg, "deg")],
          ["Smallest |det| of three axes", figure(merit.min_triple_det, "")],
          ["Most axes in one plane", String(merit.coplanarity)],
          ["Faults isolated without knowing gravity (provisional)", String(merit.provisional_grade)],
          ["Faults that may agree with one another", String(merit.correlated_grade)],
          ["Visibility of a bias that all share", figure(merit.common_bias_visibility, "")],
          ["Units that fail at once", unitsOf(this.geometry.chips).map((unit) => unitWords(this.geometry.chips, unit)).join(", ")],
          ["Critical sensors", said.critical_sensors.length ? said.critical_sensors.join(" ") : "none"],
        ],
      ),
    );
    const list = (id: string, items: string[], none: string) =>
      byId(id).replaceChildren(...(items.length ? items : [none]).map((text) => make("li", {}, text)));
    // eslint-disable-next-line @typescript-eslint/no-explicit-any
    list("design-hidden", said.unobservable_permutations.map((h: any) => `${h.what}: turns the vector by ${figure(h.turn_deg, "deg")}`), "None: every exchange and reversal shows at some attitude.");
    // eslint-disable-next-line @typescript-eslint/no-explicit-any
    list("design-limits", [...said.warnings, ...said.known_limits].map((f: any) => f.text), "None.");
    byId("design-sensors").replaceChildren(sensorSizes(said));
    drawMap(said.map);
  }
}

const rounded = (axis: number[]): Vec3 => axis.map((x) => Number(x.toFixed(4))) as Vec3;

/** The unit vector across both. */
function normal(a: number[], b: number[]): number[] {
  const c = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  return c.map((x) => x / Math.hypot(...c));
}

const plural = (n: number, word: string): string => (n === 1 ? word : `${word}s`);

// eslint-disable-next-line @typescript-eslint/no-explicit-any
function protection(sizes: any): string {
  const key = Object.keys(sizes).find((name) => name.startsWith("protection_level"))!;
  const value = sizes[key];
  return value === null ? "none" : key.endsWith("rad") ? deg(value) : figure(value, "deg");
}

/** What of one attitude alone is guaranteed, over inclination (down) and toolface (across). */
function drawMap(cells: [number, number, number | null, number][]): void {
  const canvas = byId<HTMLCanvasElement>("design-map");
  const caption = byId("design-map-words");
  const figureOf = canvas.closest("figure")!;
  figureOf.hidden = cells.length === 0;
  if (cells.length === 0) return;
  const step = cells[1][1] - cells[0][1];
  const across = 360 / step + 1;
  const down = cells.length / across;
  canvas.width = across;
  canvas.height = down;
  const finite = cells.map((cell) => cell[2]).filter((x): x is number => x !== null && x > 0);
  const least = Math.log(Math.min(...finite));
  const most = Math.log(Math.max(...finite));
  const context = canvas.getContext("2d")!;
  const image = context.createImageData(across, down);
  cells.forEach((cell, k) => {
    const part = cell[2] === null || cell[2] <= 0 ? 1 : (Math.log(cell[2]) - least) / (most - least || 1);
    // From blue, small faults are isolated, over white to red: large ones only.
    const low = [47, 120, 183], mid = [242, 240, 232], high = [197, 58, 58];
    const colour = part < 0.5 ? low.map((c, i) => c + (mid[i] - c) * 2 * part) : mid.map((c, i) => c + (high[i] - c) * (2 * part - 1));
    image.data.set([...colour, 255], 4 * k);
  });
  context.putImageData(image, 0, 0);
  const words = `From one attitude alone every larger fault is isolated: ${figure(1000 * Math.exp(least), "mg0")} at the best attitude (blue), ${figure(1000 * Math.exp(most), "mg0")} at the worst (red). Inclination 0 deg at the top to 180 deg, toolface 0 to 360 deg across.`;
  caption.textContent = words;
  canvas.setAttribute("aria-label", words);
}
