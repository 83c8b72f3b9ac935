// The scene in the address of the page: behind the `#` stands what differs from the page as it opens, and it goes nowhere, for a
// browser sends no fragment. `#break` is that view; `#break=…` is a scene, JSON in base64url.
import { Refusal } from "./core";
import type { Break, SharedRun } from "./play";
import type { Design } from "./design";
import { byId, download, make } from "./dom";
import type { Geometry } from "./geometry";
import { zipSync, strToU8 } from "fflate";

interface Shared {
  design?: Geometry;
  run?: Partial<SharedRun>;
}

/** An address is written at most so often: a browser refuses to write it at every frame. */
const kRest_ms = 300;

const packed = (shared: Shared): string =>
  btoa(String.fromCharCode(...new TextEncoder().encode(JSON.stringify(shared)))).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
const unpacked = (text: string): Shared =>
  JSON.parse(new TextDecoder().decode(Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0))));

/** "break" of "#break=…". */
export const viewIn = (fragment: string): string => fragment.slice(1).split("=")[0];

export class Share {
  private waiting = 0;
  private written = "";
  private readonly asOpened: { design: string; run: Record<string, string> };

  constructor(
    private readonly design: Design,
    private readonly run: Break,
    private readonly show: (view: string) => void,
  ) {
    this.asOpened = { design: JSON.stringify(design.geometry), run: texts(run.shared()) };
    byId("copy-address").addEventListener("click", () => void this.copy());
    byId("download-scene").addEventListener("click", () => this.downloadScene());
    addEventListener("hashchange", () => {
      if (location.hash !== this.written) this.restore(location.hash);
    });
    this.restore(location.hash);
  }

  /** What the address says of the page as it is. */
  fragment(): string {
    const view = document.querySelector<HTMLElement>("[role=tab][aria-selected=true]")!.dataset.view;
    const shared: Shared = {};
    if (JSON.stringify(this.design.geometry) !== this.asOpened.design) shared.design = this.design.geometry;
    const run = this.run.shared();
    const now = texts(run);
    const other = Object.entries(run).filter(([key]) => now[key] !== this.asOpened.run[key]);
    if (other.length > 0) shared.run = Object.fromEntries(other);
    return Object.keys(shared).length ? `#${view}=${packed(shared)}` : `#${view}`;
  }

  /** Something was set: the address follows once the hand rests. */
  changed(): void {
    clearTimeout(this.waiting);
    this.waiting = window.setTimeout(() => this.write(), kRest_ms);
  }

  private write(): void {
    clearTimeout(this.waiting);
    this.written = this.fragment();
    history.replaceState(null, "", this.written);
  }

  private restore(fragment: string): void {
    byId("share-error").hidden = true;
    this.show(viewIn(fragment));
    const scene = fragment.split("=")[1];
    if (!scene) return;
    try {
      const shared = unpacked(scene);
      if (shared.design) this.design.restore(shared.design);
      if (shared.run) this.run.restore(shared.run);
    } catch {
      byId("share-error").hidden = false;
      byId("share-error").textContent = "The address holds no scene of this page. Remedy: copy it anew, as a whole.";
    }
  }

  private async copy(): Promise<void> {
    this.write();
    const told = byId("share-told");
    try {
      await navigator.clipboard.writeText(location.href);
      told.textContent = "Copied: the address holds the whole scene.";
    } catch {
      told.replaceChildren("Copy it from here: ", make("input", { readonly: true, value: location.href, "aria-label": "Address of this scene" }));
    }
  }

  private downloadScene(): void {
    try {
      this.keep();
    } catch (error) {
      if (!(error instanceof Refusal)) throw error;
      byId("share-told").textContent = error.message;
    }
  }

  private keep(): void {
    const files = Object.entries(this.run.files()).map(([name, text]) => [name, strToU8(text)]);
    download("plumb-scene.zip", zipSync(Object.fromEntries(files)), "application/zip");
    byId("share-told").textContent = "In the folder of the files, sh play.sh plays the scene with the tool and says the same verdicts.";
  }
}

const texts = (of: object): Record<string, string> => Object.fromEntries(Object.entries(of).map(([key, value]) => [key, JSON.stringify(value)]));
