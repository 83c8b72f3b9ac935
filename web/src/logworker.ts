// In a worker: one run of the tool over files that were dropped on the page. They are read where they lie, a window at a time.
import createPlumb from "plumb-logs";
import type { LogRun, LogTold } from "./logs";

const kOut = "/out";
/** Between two messages on how far the reading is [ms]. */
const kTell_ms = 100;

/** What of Emscripten's program is used here. */
interface Plumb {
  FS: {
    filesystems: Record<string, { stream_ops: { read(...all: unknown[]): number } }>;
    mkdir(path: string): void;
    mount(kind: unknown, what: { files: File[] }, path: string): void;
    chdir(path: string): void;
    readdir(path: string): string[];
    readFile(path: string): Uint8Array;
  };
  callMain(args: string[]): number;
}

const tell = (told: LogTold): void => postMessage(told);

/** Tells what part of the longest file has been read, by where it is read. */
function watchReading(plumb: Plumb, files: File[]): void {
  const log = files.reduce((one, other) => (other.size > one.size ? other : one));
  const operations = plumb.FS.filesystems.WORKERFS.stream_ops;
  const read = operations.read;
  let told = 0;
  operations.read = (...all) => {
    const [stream, , , length, position] = all as [{ node: { contents: File } }, unknown, unknown, number, number];
    const now = performance.now();
    if (now - told > kTell_ms && stream.node.contents === log) {
      told = now;
      tell({ kind: "progress", part: Math.min(1, (position + length) / log.size) });
    }
    return read(...all);
  };
}

async function run({ module, args, files }: LogRun): Promise<void> {
  const out: string[] = [];
  const error: string[] = [];
  const plumb: Plumb = await createPlumb({
    print: (line: string) => out.push(line),
    printErr: (line: string) => error.push(line),
    instantiateWasm(imports: WebAssembly.Imports, done: (instance: WebAssembly.Instance) => void) {
      void WebAssembly.instantiate(module, imports).then(done);
      return {};
    },
  });
  const { FS } = plumb;
  FS.mkdir(kOut);
  FS.mkdir("/in");
  FS.mount(FS.filesystems.WORKERFS, { files }, "/in");
  FS.chdir("/in"); // so that a message names a file as the user does
  watchReading(plumb, files);
  const code = plumb.callMain(args);
  const written = FS.readdir(kOut).filter((name) => !name.startsWith("."));
  const results = Object.fromEntries(written.map((name) => [name, FS.readFile(`${kOut}/${name}`)]));
  const text = (lines: string[]) => lines.map((line) => `${line}\n`).join("");
  tell({ kind: "done", code, out: text(out), error: text(error), files: results });
}

onmessage = (event: MessageEvent<LogRun>) => {
  run(event.data).catch((problem: Error) => tell({ kind: "broken", why: problem.message ?? String(problem) }));
};
