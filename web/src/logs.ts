// The tool itself in a worker: what it is given, and what it says. It answers as `plumb` on a command line.
import { unpacked } from "./packed";

declare global {
  /** The tool for logs, packed, and the script of its worker: put into the page beside this script. */
  const PLUMB_LOGS: string;
  const PLUMB_LOG_WORKER: string;
}

export interface LogRun {
  module: WebAssembly.Module;
  args: string[];
  files: File[];
}

export interface Answer {
  code: number;
  out: string;
  error: string;
  files: Record<string, Uint8Array>;
}

export type LogTold = { kind: "progress"; part: number } | ({ kind: "done" } & Answer) | { kind: "broken"; why: string };

let compiled: Promise<WebAssembly.Module> | null = null;

/** Unpacked when the first log is dropped. */
const tool = (): Promise<WebAssembly.Module> => (compiled ??= unpacked(PLUMB_LOGS).then((bytes) => WebAssembly.compile(bytes)));

/** A run that can be cancelled: the worker ends with it. */
export class ToolRun {
  private worker: Worker | null = null;
  private cancelled = false;
  readonly answer: Promise<Answer | null>;

  /** `args` are those of the command line; the files are in its directory, and it writes to /out. */
  constructor(args: string[], files: File[], progress: (part: number) => void) {
    this.answer = this.run(args, files, progress);
  }

  private giveUp: () => void = () => undefined;

  cancel(): void {
    this.cancelled = true;
    this.worker?.terminate();
    this.giveUp();
  }

  private async run(args: string[], files: File[], progress: (part: number) => void): Promise<Answer | null> {
    const module = await tool();
    if (this.cancelled) return null;
    const address = URL.createObjectURL(new Blob([PLUMB_LOG_WORKER], { type: "text/javascript" }));
    const worker = (this.worker = new Worker(address));
    try {
      return await new Promise<Answer | null>((resolve, reject) => {
        this.giveUp = () => resolve(null);
        worker.onerror = (event) => reject(new Error(event.message));
        worker.onmessage = ({ data }: MessageEvent<LogTold>) => {
          if (data.kind === "progress") progress(data.part);
          else if (data.kind === "broken") reject(new Error(data.why));
          else resolve(data);
        };
        worker.postMessage({ module, args, files } satisfies LogRun);
      });
    } finally {
      worker.terminate();
      URL.revokeObjectURL(address);
    }
  }
}
