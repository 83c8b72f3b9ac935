// stories.mjs NATIVE CORE.wasm: the core in WebAssembly against the same code as a native program: digests over every field of every
// verdict and over every decision, the other rules' included, of every story of the page, every experiment of Table 2, every kind of
// flight and three tools of every geometry; and what is said of every built-in geometry. Says what a step costs in processor time.
import { build } from "esbuild";
import { execFileSync } from "node:child_process";
import fs from "node:fs";

const [native, corePath] = process.argv.slice(2);

async function modules(source) {
  const made = await build({ stdin: { contents: source, resolveDir: new URL("src", import.meta.url).pathname }, bundle: true, write: false, format: "esm" });
  return import(`data:text/javascript;base64,${Buffer.from(made.outputFiles[0].text).toString("base64")}`);
}
const { Core, Refusal, kPresets, sceneOf, kBuiltIn, shapeOf, experimentScene } = await modules(
  'export * from "./core"; export * from "./scenes"; export * from "./geometry"; export { experimentScene } from "./table2";',
);
const core = await Core.load(fs.readFileSync(corePath));
const says = (what, text) => execFileSync(native, [what], { input: text, encoding: "utf8" }).trimEnd();
const cpu_us = () => process.cpuUsage().user;
let failures = 0;
function check(what, here, there) {
  if (here === there) return;
  ++failures;
  console.error(`${what}: WebAssembly says ${here.slice(0, 200)}, the native core ${there.slice(0, 200)}`);
}

function play(scene) {
  core.begin(scene);
  const begin = cpu_us();
  let steps = 0;
  for (let done; (done = core.run(500)) > 0; ) steps += done;
  return { digest: core.digest(), decisions: core.decisions(), steps, us: cpu_us() - begin };
}

const noise_mps2 = 2e-4 * 9.80665;
const toolOf = (name) => ({ ...shapeOf(core, name), noise_mps2 });
check("vocabulary", JSON.stringify(core.words), JSON.stringify(JSON.parse(says("vocabulary", ""))));
let steps = 0;
let us = 0;
let scenes = 0;
function checkScene(what, scene) {
  const played = play(scene);
  steps += played.steps;
  us += played.us;
  ++scenes;
  const [decisions, digest] = says("begin", JSON.stringify(scene)).split("\n").slice(-2);
  check(what, `decisions ${played.decisions}`, decisions);
  check(what, `digest ${played.digest}`, digest);
  return played;
}
for (const preset of kPresets) {
  const scene = sceneOf(toolOf(preset.geometry), preset.scene);
  const played = checkScene(preset.id, scene);
  // The digest can tell: another seed of the noise is another one.
  check(`${preset.id}, other noise`, String(play({ ...scene, seed: scene.seed + 1 }).digest !== played.digest), "true");
}
for (const row of core.words.table2) checkScene(`Table 2, no. ${row.number}`, experimentScene(toolOf("paper-tetrahedron"), row));
for (const motion of ["drone", "drilling", "car", "launch"]) {
  for (const name of ["chips:3", "cone:5"]) checkScene(`${motion}, ${name}`, sceneOf(toolOf(name), { motion, duration_s: 3, faults: ["a2:stuck=0V@1s"] }));
}
// Other tools: their fits are what differed most, before eigenvalues were plumb's own.
for (const [name] of kBuiltIn) {
  for (const truth_seed of [1, 2, 3]) checkScene(`${name}, tool ${truth_seed}`, sceneOf(toolOf(name), { stations: 4, truth_seed }));
}
for (const [name] of kBuiltIn) {
  const design = { name, ...toolOf(name), samples: 32 };
  check(name, JSON.stringify(core.study(design)), JSON.stringify(JSON.parse(says("study", JSON.stringify(design)))));
}
// What is refused is refused with a remedy, and the core goes on.
const plane = [[1, 0, 0], [0, 1, 0], [1, 1, 0]];
for (const wrong of [
  () => core.builtin("cone:2"),
  () => core.study({ axes: plane }),
  () => core.begin({ axes: [] }),
  () => core.begin(sceneOf(toolOf("triad"), { faults: ["a9:stuck=0V@1s"] })),
  () => core.begin({ ...sceneOf(toolOf("cone:5"), {}), motion: "sailing" }),
  () => core.begin({ ...sceneOf({ axes: Array.from({ length: 13 }, (_, k) => [Math.cos(k), Math.sin(k), 1]), chips: [], noise_mps2 }, {}), motion: "car" }),
]) {
  let told = "nothing";
  try {
    wrong();
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    told = error.message;
  }
  check("a refusal", String(/[Rr]emedy: /.test(told)), "true");
}
console.log(`${scenes} scenes, ${steps} steps: ${failures ? `${failures} differences` : "equal bit for bit"}; ${(us / steps).toFixed(1)} us of processor a step, simulation and record included`);
process.exitCode = failures ? 1 : 0;
