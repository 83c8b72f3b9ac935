// Elements, and numbers as text.

type Child = Node | string | null;

/** `make("div", {class: "card"}, "text", child)`; a property that begins with "on" is a listener. */
export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  properties: Record<string, unknown> = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value as EventListener);
    else if (value !== undefined && value !== false) element.setAttribute(name, String(value));
  }
  element.append(...children.filter((child): child is Node | string => child !== null));
  return element;
}

const kSvg = "http://www.w3.org/2000/svg";

export function svg(tag: string, properties: Record<string, string | number> = {}, ...children: Child[]): SVGElement {
  const element = document.createElementNS(kSvg, tag);
  for (const [name, value] of Object.entries(properties)) element.setAttribute(name, String(value));
  element.append(...children.filter((child): child is Node | string => child !== null));
  return element;
}

export function byId<T extends HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}

export const kG0 = 9.80665;
export const degrees = (rad: number): number => (rad * 180) / Math.PI;

/** Three significant digits; a dash where there is no figure. */
export function figure(value: number | null | undefined, unit: string, digits = 3): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "none";
  const text = value === 0 ? "0" : Number(value.toPrecision(digits)).toString();
  return unit ? `${text} ${unit}` : text;
}

export const mg0 = (mps2: number | null): string => figure(mps2 === null ? null : (1000 * mps2) / kG0, "mg0");
export const deg = (rad: number | null): string => figure(rad === null ? null : degrees(rad), "deg");

/** Ids of the sensors whose bits are set: "a2 a3", or "none". */
export function sensorsOf(bits: number): string {
  const out: string[] = [];
  for (let i = 0; bits >> i; ++i) if ((bits >> i) & 1) out.push(`a${i + 1}`);
  return out.length ? out.join(" ") : "none";
}

/** `table(["sensor", "x"], rows)` in a frame that scrolls by itself. */
export function table(label: string, head: string[], rows: Child[][]): HTMLElement {
  return make(
    "div",
    { class: "card wide", tabindex: 0, role: "region", "aria-label": label },
    make(
      "table",
      {},
      make("thead", {}, make("tr", {}, ...head.map((text) => make("th", { scope: "col" }, text)))),
      make("tbody", {}, ...rows.map((row) => make("tr", {}, ...row.map((cell) => make("td", {}, cell))))),
    ),
  );
}

/** A file for the user to keep; nothing leaves the machine. */
export function download(name: string, content: BlobPart, type = "text/plain"): void {
  const link = make("a", { href: URL.createObjectURL(new Blob([content], { type })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
