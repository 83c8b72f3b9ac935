// scenarios.mjs PLUMB CORE.wasm WORK: every story of the page, exported as the files of its scene and played by the tool (the
// commands of play.sh), says what the page says: state, output, cause, excluded sensors, statistic and limit of every sample, and
// every event. The address of the page is tested in the page (tests/web/browser.py).
import { build } from "esbuild";
import { execFileSync, spawnSync } from "node:child_process";
import fs from "node:fs";
import path from "node:path";

const [plumb, corePath, work] = process.argv.slice(2);
const made = await build({
  stdin: { contents: 'export * from "./core"; export * from "./scenes"; export * from "./geometry";', resolveDir: new URL("src", import.meta.url).pathname },
  bundle: true,
  write: false,
  format: "esm",
});
const { Core, Refusal, kPresets, sceneOf, shapeOf } = await import(`data:text/javascript;base64,${Buffer.from(made.outputFiles[0].text).toString("base64")}`);
const core = await Core.load(fs.readFileSync(corePath));

const toolOf = (name) => ({ ...shapeOf(core, name), noise_mps2: 2e-4 * 9.80665 });
const kMonitorFailed = 5;
const ids = (bits) => Array.from({ length: core.words.capacity }, (_, i) => i).filter((i) => (bits >> i) & 1).map((i) => `a${i + 1}`);
const lines = (file) => fs.readFileSync(file, "utf8").trimEnd().split("\n").map((line) => JSON.parse(line));

/** What the page says of each sample, in the words of the tool's records. */
function pageSays(scene) {
  core.begin(scene);
  while (core.run(500) > 0) continue;
  const records = core.records().slice();
  const width = core.words.records.length;
  const { words, at } = core;
  return Array.from({ length: records.length / width }, (_, k) => {
    const of = (name) => records[k * width + at[name]];
    const verdict = {
      t_s: of("time_s"),
      state: words.states[of("state")],
      validity: words.validities[of("validity")],
      cause: words.causes[of("cause")],
      statistic: of("statistic"),
      limit: of("limit"),
      in_service: ids(of("in_service")),
      provisionally_excluded: ids(of("provisionally_excluded")),
      excluded: ids(of("excluded")),
      suspects: ids(of("suspects")),
    };
    const event = of("event") < 0 ? null : {
      t_s: of("time_s"),
      from: words.states[of("from")],
      to: words.states[of("to")],
      event: words.events[of("event")],
      cause: words.causes[of("event_cause")],
      sensors: ids(of("event_sensors")),
    };
    return { verdict, event };
  });
}

function toolSays(files, folder) {
  fs.mkdirSync(folder, { recursive: true });
  for (const [name, text] of Object.entries(files)) fs.writeFileSync(path.join(folder, name), text);
  const env = { ...process.env, PATH: `${path.dirname(plumb)}:${process.env.PATH}` };
  const done = spawnSync("sh", ["play.sh"], { cwd: folder, env, encoding: "utf8" });
  if (done.status !== 0 && done.status !== kMonitorFailed) throw new Error(`play.sh ended with ${done.status}: ${done.stderr}`);
  return { verdicts: lines(path.join(folder, "verdicts.jsonl")), events: lines(path.join(folder, "events.jsonl")) };
}

let failures = 0;
function check(what, page, tool) {
  const wanted = JSON.stringify(page);
  const told = JSON.stringify(Object.fromEntries(Object.keys(page).map((key) => [key, tool?.[key]])));
  if (wanted === told) return true;
  ++failures;
  console.error(`${what}: the page says ${wanted}, the tool ${told}`);
  return false;
}

if (!execFileSync(plumb, ["--version"], { encoding: "utf8" }).startsWith("plumb ")) throw new Error(`${plumb} is not the tool`);
/** A flight is no scenario of stations: it is refused, with a remedy. */
function refusesFiles(what) {
  try {
    core.files();
  } catch (error) {
    if (error instanceof Refusal && error.message.includes("Remedy: ")) return 1;
    throw error;
  }
  throw new Error(`${what}: a flight came out as a scenario`);
}

let samples = 0;
let events = 0;
let flights = 0;
for (const preset of kPresets) {
  const scene = sceneOf(toolOf(preset.geometry), preset.scene);
  const page = pageSays(scene);
  if (!["stations", "roll"].includes(scene.motion)) {
    flights += refusesFiles(preset.id);
    continue;
  }
  const tool = toolSays(core.files(), path.join(work, preset.id));
  check(`${preset.id}, samples`, { count: page.length }, { count: tool.verdicts.length });
  for (const [k, { verdict }] of page.entries()) if (!check(`${preset.id}, sample ${k + 1}`, verdict, tool.verdicts[k])) break;
  const happened = page.filter((one) => one.event).map((one) => one.event);
  check(`${preset.id}, events`, { count: happened.length }, { count: tool.events.length });
  for (const [k, event] of happened.entries()) if (!check(`${preset.id}, event ${k + 1}`, event, tool.events[k])) break;
  samples += page.length;
  events += happened.length;
}
// The comparison can tell: another fault is another run.
const other = sceneOf(toolOf("paper-tetrahedron"), { ...kPresets[0].scene, faults: ["a3:stuck=0V@station7"] });
const { verdicts } = toolSays((core.begin(other), core.files()), path.join(work, "other"));
const first = pageSays(sceneOf(toolOf("paper-tetrahedron"), kPresets[0].scene));
if (first.every(({ verdict }, k) => JSON.stringify(verdict.state) === JSON.stringify(verdicts[k].state) && JSON.stringify(verdict.excluded) === JSON.stringify(verdicts[k].excluded))) {
  ++failures;
  console.error("another fault made no difference");
}
console.log(`${kPresets.length - flights} stories (${flights} more are flights), ${samples} samples, ${events} events: ${failures ? `${failures} differences` : "the tool says what the page says"}`);
process.exitCode = failures ? 1 : 0;
