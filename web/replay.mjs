// replay.mjs NATIVE PROGRAM.wasm [SCENARIOS]: the corpus of bench/replay, but for what is read from files, in WebAssembly under node
// against the native program. Digests are compared first. Where one differs, every figure of the case is: only a real number
// may, by two units in the last place, and never in what the monitor is given or answers. The margin, 1 - statistic / limit,
// may by two units of 1, for what two equal digits cancel.
import { execFile } from "node:child_process";
import fs from "node:fs";
import { promisify } from "node:util";
import { runWasi } from "./wasi.mjs";

const kMostUnits = 2n;
const kMostMargin = 2 * Number.EPSILON;
const kMargin = "verdicts margin";
const kPerturbed = "s0018";
const kParts = ["inputs", "answers", "verdicts", "events", "snapshots"];
const [nativePath, programPath, scenarios = "600"] = process.argv.slice(2);
const program = await WebAssembly.compile(fs.readFileSync(programPath));

async function inWasm(...args) {
  const done = await runWasi(program, [programPath, ...args]);
  if (done.code !== 0) throw new Error(`plumb_web_replay ${args.join(" ")}: exit code ${done.code}\n${done.error}`);
  return done.out;
}
const inNative = async (...args) => (await promisify(execFile)(nativePath, args, { maxBuffer: 1 << 30 })).stdout;

/** Name -> digests, of the cases that both programs hold. */
function casesOf(text) {
  const rows = text.split("\n").filter((line) => /^(s\d|paper)/.test(line)).map((line) => line.split(" "));
  return new Map(rows.map(([name, ...digests]) => [name, digests]));
}

const bits = new DataView(new ArrayBuffer(8));
function unitsBetween(a, b) {
  const [x, y] = [a, b].map((value) => {
    bits.setFloat64(0, value);
    const whole = bits.getBigInt64(0);
    return whole < 0n ? -(whole & 0x7fffffffffffffffn) : whole;
  });
  return x > y ? x - y : y - x;
}

const isReal = (text) => /^-?\d.*[.e]/.test(text);  // a count, a set of sensors or a word is none
/** How far apart two figures are: units in the last place, or null where they are not the same and may not differ. */
function apart(part, a, b) {
  if (a === b) return 0n;
  if (part === "inputs" || part === "answers" || !(isReal(a) || isReal(b))) return null;
  const units = unitsBetween(Number(a), Number(b));
  return Number.isFinite(Number(a)) && Number.isFinite(Number(b)) && units <= kMostUnits ? units : null;
}

/** The text of a case, sample by sample: [row, [[part, label, value], ...]]. A figure is told where it changes. */
function* samplesOf(text) {
  let sample = null;
  for (const line of text.split("\n")) {
    const found = /^row (\d+) t \S+ (\S+) (snapshot|\S+) (.+)$/.exec(line);
    if (!found) continue;
    if (sample && sample[0] !== found[1]) {
      yield sample;
      sample = null;
    }
    sample ??= [found[1], []];
    sample[1].push(found.slice(2));
  }
  if (sample) yield sample;
}

/** What differs between two texts of a case: { most: units by label, wrong: the first figure that may not differ }. */
function compareTexts(one, other) {
  const known = [new Map(), new Map()];
  const told = [one, other].map((text) => new Map(samplesOf(text)));
  const most = new Map();
  const rows = new Set([...told[0].keys(), ...told[1].keys()]);
  for (const row of [...rows].sort((a, b) => Number(a) - Number(b))) {
    const names = new Map();
    for (const side of [0, 1]) {
      for (const [part, label, value] of told[side].get(row) ?? []) {
        known[side].set(`${part} ${label}`, value);
        names.set(`${part} ${label}`, [part, label]);
      }
    }
    for (const [name, [part, label]] of names) {
      const [a, b] = known.map((of) => of.get(name) ?? "nothing");
      // The bytes of a snapshot are those of its figures, which are told beside.
      let units = label === "snapshot" ? 0n : apart(part, a, b);
      const margins = known.map((of) => of.get(kMargin));
      const isMargin = name === kMargin || (part === "snapshots" && a === margins[0] && b === margins[1]);
      if (units === null && isMargin && Math.abs(Number(a) - Number(b)) <= kMostMargin) units = unitsBetween(Number(a), Number(b));
      if (units === null) return { most, wrong: `sample ${row}, ${name}: WebAssembly says ${b}, the native core ${a}` };
      const kind = name.replace(/\[\d+\]/, "");
      if (units > (most.get(kind) ?? 0n)) most.set(kind, units);
    }
  }
  return { most, wrong: null };
}

const failures = [];
const most = new Map();
const [native, wasm] = (await Promise.all([inNative("--scenarios", scenarios), inWasm("--scenarios", scenarios)])).map(casesOf);
if (wasm.size !== native.size || wasm.size <= Number(scenarios)) failures.push(`${wasm.size} cases in WebAssembly, ${native.size} native`);
let equal = 0;
for (const [name, digests] of native) {
  const here = wasm.get(name) ?? [];
  const parts = kParts.filter((_, k) => digests[k] !== here[k]);
  if (parts.length === 0) {
    ++equal;
    continue;
  }
  const compared = compareTexts(await inNative("--trace", name), await inWasm("--trace", name));
  for (const [kind, units] of compared.most) if (units > (most.get(kind) ?? 0n)) most.set(kind, units);
  if (compared.wrong) failures.push(`${name}: ${compared.wrong}`);
  else if (compared.most.size === 0) failures.push(`${name}: ${parts.join(", ")} differ, and no figure shows it`);
  else if (parts.includes("inputs") || parts.includes("answers")) failures.push(`${name}: ${parts.join(", ")} differ`);
}
// Both comparisons can tell: one sample that is one unit in the last place more, in WebAssembly alone.
const perturbed = casesOf(await inWasm("--scenarios", "60", "--only", kPerturbed, "--perturb", kPerturbed));
for (const [name, digests] of perturbed) {
  if (digests.join() === native.get(name)?.join()) failures.push(`${name}: a perturbed sample is not seen`);
}
const seen = compareTexts(await inNative("--trace", kPerturbed), await inWasm("--trace", kPerturbed, "--perturb", kPerturbed));
if (perturbed.size !== 1 || !seen.wrong) failures.push(`${kPerturbed}: a perturbed sample shows in no figure`);

for (const failure of failures.slice(0, 10)) console.error(failure);
const far = [...most].map(([kind, units]) => `${kind} ${units}`).join(", ");
const told = far ? `, most units in the last place apart: ${far}` : "";
console.log(`${native.size} cases, ${equal} equal bit for bit${told}; failures: ${failures.length}`);
process.exitCode = failures.length ? 1 : 0;
