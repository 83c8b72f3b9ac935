// stories.mjs NATIVE CORE.wasm: the core in WebAssembly against the same code as a native program: digests over every field of every
// verdict of every story of the page, and what is said of every built-in geometry. Says what a step costs in processor time.
import { build } from "esbuild";
import { execFileSync } from "node:child_process";
import fs from "node:fs";

const [native, corePath] = process.argv.slice(2);

async function modules(source) {
  const made = await build({ stdin: { contents: source, resolveDir: new URL("src", import.meta.url).pathname }, bundle: true, write: false, format: "esm" });
  return import(`data:text/javascript;base64,${Buffer.from(made.outputFiles[0].text).toString("base64")}`);
}
const { Core, Refusal, kPresets, sceneOf } = await modules('export * from "./core"; export * from "./scenes";');
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
  return { digest: core.digest(), steps, us: cpu_us() - begin };
}

const noise_mps2 = 2e-4 * 9.80665;
check("vocabulary", JSON.stringify(core.words), JSON.stringify(JSON.parse(says("vocabulary", ""))));
let steps = 0;
let us = 0;
for (const preset of kPresets) {
  const scene = sceneOf(core.builtin(preset.geometry), noise_mps2, preset.scene);
  const played = play(scene);
  steps += played.steps;
  us += played.us;
  check(preset.id, `digest ${played.digest}`, says("begin", JSON.stringify(scene)).split("\n").at(-1));
  // The digest can tell: another seed of the noise is another one.
  check(`${preset.id}, other noise`, String(play({ ...scene, seed: scene.seed + 1 }).digest !== played.digest), "true");
}
for (const name of ["paper-tetrahedron", "platonic:4", "cone-axis:5", "cone:5", "platonic:6", "cone-axis:8", "cone:8", "triad"]) {
  const design = { name, axes: core.builtin(name), noise_mps2, samples: 32 };
  check(name, JSON.stringify(core.study(design)), JSON.stringify(JSON.parse(says("study", JSON.stringify(design)))));
}
// What is refused is refused with a remedy, and the core goes on.
const plane = [[1, 0, 0], [0, 1, 0], [1, 1, 0]];
for (const wrong of [() => core.builtin("cone:2"), () => core.study({ axes: plane }), () => core.begin({ axes: [] }), () => core.begin(sceneOf(core.builtin("triad"), noise_mps2, { faults: ["a9:stuck=0V@1s"] }))]) {
  let told = "nothing";
  try {
    wrong();
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    told = error.message;
  }
  check("a refusal", String(/[Rr]emedy: /.test(told)), "true");
}
console.log(`${kPresets.length} stories, ${steps} steps: ${failures ? `${failures} differences` : "equal bit for bit"}; ${(us / steps).toFixed(1)} us of processor a step, simulation and record included`);
process.exitCode = failures ? 1 : 0;
