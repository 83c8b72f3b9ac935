// The third view: a log, reviewed or monitored by the tool in a worker.
import { byId, download, make } from "./dom";
import { ToolRun, type Answer } from "./logs";

interface Kind {
  name: "review" | "monitor";
  args: string[];
  files: File[];
  page: string;
}

/** What the tool's exit code says where it is no error. */
const kVerdicts: Record<number, [string, string]> = {
  0: ["good", "Done: what was found is below."],
  5: ["bad", "The monitor ended in failed: its output must not be used."],
  8: ["notice", "ORANGE: see to it before the next flight."],
  9: ["bad", "RED: an autopilot would refuse to arm, or a sensor has failed."],
};

/** How the tool begins to say that there are no charts: their program is none that runs in a page. */
const kNoGnuplot = "plumb: gnuplot: ";

const size = (bytes: number): string => (bytes < 1e6 ? `${Math.max(1, Math.round(bytes / 1e3))} kB` : `${(bytes / 1e6).toFixed(1)} MB`);

export class Drop {
  private files: File[] = [];
  private run: ToolRun | null = null;
  /** Of the last run, for the tests. */
  answer: Answer | null = null;

  constructor() {
    const zone = byId("drop-zone");
    const input = byId<HTMLInputElement>("drop-files");
    input.addEventListener("change", () => {
      this.take([...input.files!]);
      input.value = "";
    });
    for (const name of ["dragenter", "dragover"]) {
      zone.addEventListener(name, (event) => {
        event.preventDefault();
        zone.classList.add("over");
      });
    }
    zone.addEventListener("dragleave", () => zone.classList.remove("over"));
    zone.addEventListener("drop", (event) => {
      event.preventDefault();
      zone.classList.remove("over");
      this.take([...event.dataTransfer!.files]);
    });
    byId("drop-run").addEventListener("click", () => void this.begin());
    byId("drop-cancel").addEventListener("click", () => this.run?.cancel());
    byId("drop-forget").addEventListener("click", () => {
      this.files = [];
      this.list();
    });
    this.list();
  }

  /** Files of one kind take the place of the one before; what is complete is run at once. */
  take(files: File[]): void {
    for (const file of files) {
      this.files = this.files.filter((one) => kindOf(one) !== kindOf(file));
      this.files.push(file);
    }
    this.list();
    if (this.asked()) void this.begin();
  }

  private of(kind: string): File | undefined {
    return this.files.find((file) => kindOf(file) === kind);
  }

  /** What the files that are there can be used for. */
  private asked(): Kind | null {
    const [log, array, calibration] = ["log", "array file", "calibration"].map((kind) => this.of(kind));
    if (!log || (calibration && !array)) return null;
    if (!array) return { name: "review", args: ["review", log.name, "--json", "--html", "/out/review.html"], files: [log], page: "review.html" };
    const known = calibration ? ["--calibration", calibration.name] : ["--calibrate-first"];
    return {
      name: "monitor",
      args: ["monitor", "--array", array.name, ...known, "--log", log.name, "--json", "--verdicts", "/out/verdicts.jsonl", "--report", "/out/health.html"],
      files: [log, array, ...(calibration ? [calibration] : [])],
      page: "health.html",
    };
  }

  private list(): void {
    const items = this.files.map((file) => make("li", {}, `${file.name}, ${size(file.size)}: ${kindOf(file)}`));
    byId("drop-list").replaceChildren(...items);
    const asked = this.asked();
    const words = !asked
      ? this.files.length === 0
        ? "No file yet."
        : "Drop the log too, and the array file that belongs to a calibration."
      : asked.name === "review"
        ? "Will be reviewed: without an array file, as plumb review does."
        : this.of("calibration")
          ? "Will be monitored with this array file and calibration."
          : "Will be monitored with this array file; without a calibration the monitor makes its own from the first stations.";
    byId("drop-what").textContent = words;
    byId<HTMLButtonElement>("drop-run").disabled = !asked;
    byId<HTMLButtonElement>("drop-forget").disabled = this.files.length === 0;
  }

  private async begin(): Promise<void> {
    const asked = this.asked();
    if (!asked) return;
    this.run?.cancel();
    this.answer = null;
    document.body.dataset.log = "running";
    byId("drop-result").replaceChildren();
    const bar = byId<HTMLProgressElement>("drop-progress");
    bar.value = 0;
    byId("drop-running").hidden = false;
    const run = (this.run = new ToolRun(asked.args, asked.files, (part) => (bar.value = part)));
    try {
      const answer = await run.answer;
      if (this.run !== run) return;
      this.answer = answer;
      byId("drop-result").replaceChildren(...(answer ? shown(answer, asked) : [make("p", { class: "note" }, "Cancelled.")]));
    } catch (problem) {
      if (this.run !== run) return;
      byId("drop-result").replaceChildren(refusal(`The tool cannot run here: ${(problem as Error).message}`));
    }
    byId("drop-running").hidden = true;
    document.body.dataset.log = this.answer ? "done" : "ended";
  }
}

function kindOf(file: File): string {
  if (/\.toml$/i.test(file.name)) return "array file";
  if (/\.json$/i.test(file.name)) return "calibration";
  return "log";
}

const refusal = (text: string): HTMLElement => make("p", { class: "card notice bad lines", role: "alert" }, text);

function shown(answer: Answer, asked: Kind): HTMLElement[] {
  const out: HTMLElement[] = [];
  const [tone, words] = kVerdicts[answer.code] ?? ["bad", ""];
  if (words) out.push(make("p", { class: `card ${tone}`, role: "status" }, words));
  const said = answer.error.split("\n").filter((line) => line && !line.startsWith(kNoGnuplot)).join("\n");
  if (said) out.push(words ? make("p", { class: "card notice lines" }, said) : refusal(said));
  const keep = (name: string, content: BlobPart, type: string) =>
    make("button", { type: "button", onclick: () => download(name, content, type) }, `Keep ${name}`);
  const files = Object.entries(answer.files).map(([name, bytes]) => keep(name, bytes as Uint8Array<ArrayBuffer>, name.endsWith(".html") ? "text/html" : "application/json"));
  if (answer.out) files.push(keep(asked.name === "review" ? "review.json" : "events.jsonl", answer.out, "application/json"));
  if (files.length > 0) out.push(make("div", { class: "controls" }, ...files));
  if (answer.error.includes(kNoGnuplot)) out.push(make("p", { class: "note" }, "The report has no charts here: plumb monitor --report draws them with gnuplot."));
  const page = answer.files[asked.page];
  if (page) {
    const frame = make("iframe", { title: asked.name === "review" ? "The review of the log" : "The health report", class: "report", sandbox: "allow-scripts" });
    frame.srcdoc = new TextDecoder().decode(page);
    out.push(frame);
  }
  return out;
}
