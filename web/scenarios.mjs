// scenarios.mjs PLUMB CORE.wasm WORK: every story of the page, exported as the files of its scene and played by the tool (the
// commands of play.sh), says what the page says: state, output, cause, excluded sensors, statistic and limit of every sample, and
// every event. So do flights, stories or not: specific force, bound, validity, alarm, cause and sets of sensors of every sample, and
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
const lines = (file) => fs.readFileSync(file, "utf8").split("\n").filter((line) => line !== "").map((line) => JSON.parse(line));

/** What `tell` makes of every sample of a scene; it is given the figures of a sample by name. */
function eachSample(scene, tell) {
  core.begin(scene);
  while (core.run(500) > 0) continue;
  const records = core.records().slice();
  const width = core.words.records.length;
  return Array.from({ length: records.length / width }, (_, k) => tell((name) => records[k * width + core.at[name]]));
}

/** What the page says of each sample, in the words of the tool's records. */
function pageSays(scene) {
  const { words } = core;
  return eachSample(scene, (of) => {
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

/** The same of a flight. Where no force is known there is none; its bound is shown from the fourth sample on. */
function pageSaysInFlight(scene) {
  const { flight_validities, flight_causes } = core.words;
  let shown = 0;
  return eachSample(scene, (of) => {
    const validity = flight_validities[of("validity")];
    const known = validity !== "none";
    return {
      t_s: of("time_s"),
      validity,
      force_mps2: known ? [of("told_x"), of("told_y"), of("told_z")] : null,
      ...(shown++ < 3 ? {} : { bound_mps2: known ? of("force_bound_mps2") : null }),
      alarm: of("alert") === 1,
      cause: flight_causes[of("cause")],
      isolated: ids(of("isolated")),
      excluded: ids(of("provisionally_excluded")),
      blamed: ids(of("suspects")),
    };
  });
}

/** The events that follow from what was said of each sample, in the words of the tool. */
function flightEvents(samples) {
  const out = [];
  let before = { alarm: false, isolated: [], excluded: [] };
  for (const now of samples) {
    const { t_s } = now;
    const news = (set) => now[set].filter((id) => !before[set].includes(id));
    if (now.alarm && !before.alarm) out.push({ t_s, motion: "alarm" });
    for (const set of ["isolated", "excluded"]) if (news(set).length) out.push({ t_s, motion: set, sensors: news(set) });
    if (before.alarm && !now.alarm) out.push({ t_s, motion: "alarm_over" });
    before = now;
  }
  return out;
}

function playFiles(files, folder) {
  fs.mkdirSync(folder, { recursive: true });
  for (const [name, text] of Object.entries(files)) fs.writeFileSync(path.join(folder, name), text);
  const env = { ...process.env, PATH: `${path.dirname(plumb)}:${process.env.PATH}` };
  const done = spawnSync("sh", ["play.sh"], { cwd: folder, env, encoding: "utf8" });
  if (done.status !== 0 && done.status !== kMonitorFailed) throw new Error(`${folder}/play.sh ended with ${done.status}: ${done.stderr}`);
}

function toolSays(files, folder) {
  playFiles(files, folder);
  return { verdicts: lines(path.join(folder, "verdicts.jsonl")), events: lines(path.join(folder, "events.jsonl")) };
}

function toolSaysInFlight(files, folder) {
  playFiles(files, folder);
  const [header, ...rows] = fs.readFileSync(path.join(folder, "motion.csv"), "utf8").trimEnd().split("\n");
  const names = header.split(",");
  const samples = rows.map((row) => {
    const cells = row.split(",");
    const cell = (name) => cells[names.indexOf(name)];
    const number = (name) => (cell(name) === "" ? null : Number(cell(name)));
    const set = (name) => cell(name).split(" ").filter((id) => id !== "");
    const blamed = [...set("suspects"), ...set("isolated")];
    return {
      t_s: number("t_s"),
      validity: cell("validity"),
      force_mps2: cell("fx_mps2") === "" ? null : ["fx_mps2", "fy_mps2", "fz_mps2"].map(number),
      bound_mps2: number("bound_mps2"),
      alarm: cell("alarm") === "1",
      cause: cell("cause"),
      isolated: set("isolated"),
      excluded: set("excluded"),
      blamed: Array.from({ length: core.words.capacity }, (_, i) => `a${i + 1}`).filter((id) => blamed.includes(id)),
    };
  });
  // Beside them stand events of the monitor at rest: channels that are lost and come back.
  return { samples, events: lines(path.join(folder, "events.jsonl")).filter((event) => event.motion) };
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

const told = { stories: 0, flights: 0, samples: 0, events: 0 };
function compare(what, page, tool, pageEvents, toolEvents) {
  check(`${what}, samples`, { count: page.length }, { count: tool.length });
  for (const [k, sample] of page.entries()) if (!check(`${what}, sample ${k + 1}`, sample, tool[k])) break;
  check(`${what}, events`, { count: pageEvents.length }, { count: toolEvents.length });
  for (const [k, event] of pageEvents.entries()) if (!check(`${what}, event ${k + 1}`, event, toolEvents[k])) break;
  told.samples += page.length;
  told.events += pageEvents.length;
}

function compareFlight(what, scene) {
  const page = pageSaysInFlight(scene);
  const tool = toolSaysInFlight(core.files(), path.join(work, what));
  compare(what, page, tool.samples, flightEvents(page), tool.events);
  ++told.flights;
  return tool.events;
}

for (const preset of kPresets) {
  const scene = sceneOf(toolOf(preset.geometry), preset.scene);
  if (!["stations", "roll"].includes(scene.motion)) {
    // A story of a flight is one because something happens in it.
    if (compareFlight(preset.id, scene).length === 0) check(`${preset.id}, events`, { some: true }, {});
    continue;
  }
  const page = pageSays(scene);
  const tool = toolSays(core.files(), path.join(work, preset.id));
  const events = page.filter((one) => one.event).map((one) => one.event);
  compare(preset.id, page.map(({ verdict }) => verdict), tool.verdicts, events, tool.events);
  ++told.stories;
}
// Every kind of flight with every way in which readings may be wrong or missing, of sensors on chips and of such on their own.
const kFaults = [
  "a2:stuck=0V@1s", "a2:stuck=5V@1s+0.5s", "a2:last@1s", "a2:random=-1V..1V@1s", "a2:held=-1V..1V@1s", "a2:bias=300mg0@1s",
  "a2:drift=200mg0/s@0.5s", "a2:scale=1.3@0.7s", "a2:scale=-1@1s", "a2:noise=300mg0@1s", "a2:spikes=2g0*1%@1s",
  "a2:chatter=300mg0*0.2s@0.5s", "a2:warmup=500mg0*0.5s@1s", "a2:clip=-1V..1V@0.1s", "a2:coarse=0.5V@1s", "a2:bit=14@1s",
  "a2:pattern=nan@1s", "a2:pattern=inf@1s", "a2:pattern=-inf@1s", "a2:pattern=huge@1s", "a2:pattern=denormal@1s", "a2:pattern=-0@1s",
  "a2:missing@1s+1s", "a2:missing=30%@1s", "a2:late=5@1s", "a2:slow=10@1s", "a2:exchange=a4@1s", "a2:cross=a4*20%@1s",
  "a2:turned=5deg@1s", "a2:ghost=20deg@1s", "a2:mirror=a1*a3@1s", "log:shake=100mg0@1s", "log:gravity=300mg0@1s", "log:temperature=20degC@1s", "log:drop=10%@1s",
];
const kMotions = ["drone", "drilling", "car", "launch"];
const kTools = ["chips:3", "cone:5", "chips:2"];
const flight = (geometry, part) => sceneOf(toolOf(geometry), { duration_s: 2.5, ...part });
for (const [k, fault] of kFaults.entries())
  compareFlight(`flight-${k}`, flight(kTools[k % 3], { motion: kMotions[k % 4], seed: k + 1, faults: [fault] }));
// Two faults one after the other, long enough that what contradicted is forgotten between them.
const two = flight("chips:3", { motion: "car", duration_s: 20, faults: ["a2:bias=2g0@1s+1s", "a7:stuck=0V@12s"] });
compareFlight("flight-long", two);
// What the tool would refuse is refused here, with a remedy.
core.begin(flight("triad", { motion: "drone", faults: [] }));
try {
  check("a flight of three axes", { refused: true }, core.files());
} catch (error) {
  if (!(error instanceof Refusal)) throw error;
  check("a flight of three axes", { remedy: true }, { remedy: error.message.includes("Remedy: ") });
}
// The comparison can tell: another fault is another run.
const other = sceneOf(toolOf("paper-tetrahedron"), { ...kPresets[0].scene, faults: ["a3:stuck=0V@station7"] });
const { verdicts } = toolSays((core.begin(other), core.files()), path.join(work, "other"));
const first = pageSays(sceneOf(toolOf("paper-tetrahedron"), kPresets[0].scene));
if (first.every(({ verdict }, k) => JSON.stringify(verdict.state) === JSON.stringify(verdicts[k].state) && JSON.stringify(verdict.excluded) === JSON.stringify(verdicts[k].excluded))) {
  ++failures;
  console.error("another fault made no difference");
}
// And so is another flight: not one force is the same.
const here = pageSaysInFlight(two);
core.begin({ ...two, seed: two.seed + 1 });
const there = toolSaysInFlight(core.files(), path.join(work, "other-flight")).samples;
if (here.some(({ force_mps2 }, k) => force_mps2 && JSON.stringify(force_mps2) === JSON.stringify(there[k].force_mps2))) {
  ++failures;
  console.error("another flight made no difference");
}
console.log(`${told.stories} stories from station to station, ${told.flights} flights, ${told.samples} samples, ${told.events} events: ${failures ? `${failures} differences` : "the tool says what the page says"}`);
process.exitCode = failures ? 1 : 0;
