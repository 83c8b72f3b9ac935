// run.mjs PROGRAM.wasm ARGUMENT...: a program for WASI under node.
import fs from "node:fs";
import { runWasi } from "./wasi.mjs";

const [path, ...args] = process.argv.slice(2);
const done = await runWasi(await WebAssembly.compile(fs.readFileSync(path)), [path, ...args]);
process.stdout.write(done.out);
process.stderr.write(done.error);
process.exitCode = done.code;
