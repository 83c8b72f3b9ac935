import { Core } from "./core";
import { Break } from "./play";
import { Design } from "./design";
import { byId, make } from "./dom";
import { Drop } from "./drop";
import { unpacked } from "./packed";
import { Share } from "./share";

declare global {
  /** The core, packed: put into the page beside this script. */
  const PLUMB_CORE: string;
}

/** Tabs as the reader of a screen expects them: arrows move, one tab stop. Returns what shows a view by its name. */
function connectTabs(changed: () => void): (view: string) => void {
  const tabs = [...document.querySelectorAll<HTMLButtonElement>("[role=tab]")];
  const choose = (tab: HTMLButtonElement, focus: boolean) => {
    for (const one of tabs) {
      const chosen = one === tab;
      one.setAttribute("aria-selected", String(chosen));
      one.tabIndex = chosen ? 0 : -1;
      byId(one.getAttribute("aria-controls")!).hidden = !chosen;
    }
    if (focus) tab.focus();
    changed();
  };
  tabs.forEach((tab, k) => {
    tab.addEventListener("click", () => choose(tab, false));
    tab.addEventListener("keydown", (event) => {
      const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
      if (step) choose(tabs[(k + step + tabs.length) % tabs.length], true);
    });
  });
  return (view) => {
    const asked = tabs.find((tab) => tab.dataset.view === view);
    if (asked) choose(asked, false);
  };
}

async function start(): Promise<void> {
  let share: Share | null = null;
  const changed = () => share?.changed();
  const show = connectTabs(changed);
  const core = await Core.load(await unpacked(PLUMB_CORE));
  let second: Break | null = null;
  const design = new Design(core, () => {
    second?.redesigned();
    changed();
  });
  second = new Break(core, () => design.geometry, changed);
  const drop = new Drop();
  share = new Share(design, second, show);
  document.body.dataset.ready = "yes";
  // What the tests ask of the page.
  Object.assign(window, { plumb: { core, design, second, share, drop } });
}

start().catch((error: Error) => {
  byId("main").prepend(make("p", { class: "card notice bad", role: "alert" }, `The page cannot run here: ${error.message}`));
  throw error;
});
