// A sphere with directions on it: the axes of a design, which can be dragged, or where down is and where plumb says it is.
import {
  AmbientLight,
  BufferGeometry,
  Color,
  ConeGeometry,
  DoubleSide,
  Group,
  Line,
  LineBasicMaterial,
  LineLoop,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  Quaternion,
  Raycaster,
  Scene,
  Sphere as Ball,
  SphereGeometry,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import type { Vec3 } from "./core";
import { make } from "./dom";

export interface Direction {
  label: string;
  colour: string;
  axis: Vec3;
  /** Half angle of a cone about it [rad]; none where undefined. */
  cone?: number;
}

/** The colours of the reports' axes. */
export const kAxisColours = ["#2f78b7", "#d0553c", "#2c8f57", "#b97a00", "#8f55c4", "#1f8a99"];

/** The tool's z axis points down the hole, and down on the screen: a right-handed turn of the picture's axes. */
const shown = (v: Vec3): Vector3 => new Vector3(v[0], -v[2], v[1]);
const meant = (v: Vector3): Vec3 => [v.x, v.z, -v.y];

export class Sphere {
  readonly element: HTMLElement;
  private readonly renderer: WebGLRenderer | null;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(35, 1, 0.1, 20);
  private readonly things = new Group();
  private readonly labels: HTMLElement;
  private directions: Direction[] = [];
  private tips: Mesh[] = [];
  private azimuth = 0.6;
  private height = 0.35;
  private held = -1;

  /** `moved`: a direction was dragged; without it the directions stand, and dragging turns the sphere. */
  constructor(
    label: string,
    private readonly moved?: (index: number, axis: Vec3, done: boolean) => void,
  ) {
    this.labels = make("div", { class: "sphere-labels", "aria-hidden": "true" });
    this.element = make("div", { class: "sphere", role: "img", "aria-label": label }, this.labels);
    this.renderer = this.open();
    if (!this.renderer) return;
    const canvas = this.renderer.domElement;
    this.element.prepend(canvas);
    this.scene.add(new AmbientLight(0xffffff, 1), this.things);
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.drag(event));
    canvas.addEventListener("pointerup", (event) => this.release(event));
    canvas.addEventListener("pointercancel", (event) => this.release(event));
    new ResizeObserver(() => this.draw()).observe(this.element);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.show(this.directions));
  }

  private open(): WebGLRenderer | null {
    try {
      // Asked first, for three.js writes a message of its own where there is no WebGL.
      if (!document.createElement("canvas").getContext("webgl2")) throw new Error();
      return new WebGLRenderer({ antialias: true, alpha: true });
    } catch {
      this.element.classList.add("no-webgl");
      this.labels.textContent = "This browser draws no three dimensions; the numbers beside say the same.";
      return null;
    }
  }

  show(directions: Direction[]): void {
    this.directions = directions;
    if (!this.renderer) return;
    this.things.traverse((thing) => (thing as Mesh).geometry?.dispose());
    this.things.clear();
    const style = getComputedStyle(document.documentElement);
    const line = new Color(style.getPropertyValue("--line").trim());
    const soft = new Color(style.getPropertyValue("--soft").trim());
    this.things.add(
      new Mesh(
        new SphereGeometry(1, 48, 32),
        new MeshBasicMaterial({ color: line, transparent: true, opacity: 0.22, depthWrite: false }),
      ),
    );
    for (const turned of [0, 1, 2]) this.things.add(this.circle(turned, line));
    this.things.add(this.stroke(new Vector3(0, 1.25, 0), new Vector3(0, -1.25, 0), soft));
    this.tips = directions.map((one) => this.add(one));
    this.labels.replaceChildren(
      ...directions.map((one) => make("span", { style: `color:${one.colour}` }, one.label)),
      make("span", { class: "note" }, "z, down hole"),
    );
    this.draw();
  }

  private circle(turned: number, colour: Color): LineLoop {
    const points = Array.from({ length: 96 }, (_, k) => {
      const a = (2 * Math.PI * k) / 96;
      return [Math.cos(a), Math.sin(a), 0];
    }).map(([x, y, z]) => new Vector3(...([[x, y, z], [y, z, x], [z, x, y]][turned] as Vec3)));
    return new LineLoop(new BufferGeometry().setFromPoints(points), new LineBasicMaterial({ color: colour }));
  }

  private stroke(from: Vector3, to: Vector3, colour: Color): Line {
    return new Line(new BufferGeometry().setFromPoints([from, to]), new LineBasicMaterial({ color: colour }));
  }

  private add(one: Direction): Mesh {
    const colour = new Color(one.colour);
    const tip = shown(one.axis).normalize();
    this.things.add(this.stroke(new Vector3(), tip, colour));
    if (!this.moved || this.directions.length === 0) {
      if (one.cone !== undefined && one.cone > 0) this.things.add(this.cone(tip, one.cone, colour));
    }
    const ball = new Mesh(new SphereGeometry(0.055, 20, 14), new MeshBasicMaterial({ color: colour }));
    ball.position.copy(tip);
    this.things.add(ball);
    return ball;
  }

  private cone(tip: Vector3, half: number, colour: Color): Mesh {
    const angle = Math.min(half, 1.3);
    const geometry = new ConeGeometry(Math.sin(angle), Math.cos(angle), 48, 1, true);
    geometry.translate(0, -Math.cos(angle) / 2, 0);
    const mesh = new Mesh(
      geometry,
      new MeshBasicMaterial({ color: colour, transparent: true, opacity: 0.3, side: DoubleSide, depthWrite: false }),
    );
    // The cone's tip is at the centre and opens along -y.
    mesh.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, -1, 0), tip));
    return mesh;
  }

  private draw(): void {
    const width = this.element.clientWidth;
    if (!this.renderer || width === 0 || this.labels.childElementCount === 0) return;
    const height = this.element.clientHeight;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    const far = 4.5 * Math.max(1, 1 / this.camera.aspect);
    const flat = Math.cos(this.height);
    this.camera.position.set(
      far * flat * Math.sin(this.azimuth),
      far * Math.sin(this.height),
      far * flat * Math.cos(this.azimuth),
    );
    this.camera.lookAt(0, 0, 0);
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
    // The name of z stands further out than that of an axis that may lie there.
    const places = [...this.directions.map((one) => shown(one.axis).setLength(1.14)), new Vector3(0, -1.33, 0)];
    places.forEach((place, k) => {
      const seen = place.project(this.camera);
      const label = this.labels.children[k] as HTMLElement;
      label.style.left = `${(50 * (seen.x + 1)).toFixed(2)}%`;
      label.style.top = `${(50 * (1 - seen.y)).toFixed(2)}%`;
    });
  }

  private ray(event: PointerEvent): Raycaster {
    const frame = this.renderer!.domElement.getBoundingClientRect();
    const caster = new Raycaster();
    const x = (2 * (event.clientX - frame.left)) / frame.width - 1;
    const y = 1 - (2 * (event.clientY - frame.top)) / frame.height;
    caster.setFromCamera(new Vector2(x, y), this.camera);
    return caster;
  }

  private press(event: PointerEvent): void {
    const caster = this.ray(event);
    const hit = this.moved ? caster.intersectObjects(this.tips)[0] : undefined;
    this.held = hit ? this.tips.indexOf(hit.object as Mesh) : -1;
    this.renderer!.domElement.setPointerCapture(event.pointerId);
  }

  private drag(event: PointerEvent): void {
    if (!this.renderer!.domElement.hasPointerCapture(event.pointerId)) return;
    if (this.held < 0) {
      this.azimuth -= event.movementX * 0.01;
      this.height = Math.max(-1.4, Math.min(1.4, this.height + event.movementY * 0.01));
      this.draw();
      return;
    }
    this.moveTo(event, false);
  }

  private release(event: PointerEvent): void {
    if (this.held >= 0) this.moveTo(event, true);
    this.held = -1;
    this.renderer!.domElement.releasePointerCapture(event.pointerId);
  }

  private moveTo(event: PointerEvent, done: boolean): void {
    const ray = this.ray(event).ray;
    const hit = ray.intersectSphere(new Ball(new Vector3(), 1), new Vector3());
    const at = hit ?? ray.closestPointToPoint(new Vector3(), new Vector3()).normalize();
    this.moved!(this.held, meant(at.normalize()), done);
  }
}
