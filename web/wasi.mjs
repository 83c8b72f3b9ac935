// What a program for WASI needs to run in node and in a browser alike: arguments in, text out, a clock. There are no files.

const kBadFile = 8;
const kNotSupported = 52;

class Exit extends Error {
  constructor(code) {
    super(`exit ${code}`);
    this.code = code;
  }
}

/** Runs the program of that module; resolves to { code, out, error } once it has ended. */
export async function runWasi(module, args) {
  const said = { 1: [], 2: [] };
  let memory;
  const view = () => new DataView(memory.buffer);
  const texts = args.map((text) => new TextEncoder().encode(`${text}\0`));
  const known = {
    args_sizes_get(count, bytes) {
      view().setUint32(count, texts.length, true);
      view().setUint32(bytes, texts.reduce((sum, text) => sum + text.length, 0), true);
      return 0;
    },
    args_get(pointers, at) {
      for (const text of texts) {
        view().setUint32(pointers, at, true);
        new Uint8Array(memory.buffer).set(text, at);
        pointers += 4;
        at += text.length;
      }
      return 0;
    },
    environ_sizes_get(count, bytes) {
      view().setUint32(count, 0, true);
      view().setUint32(bytes, 0, true);
      return 0;
    },
    environ_get: () => 0,
    fd_write(file, vectors, count, written) {
      if (!said[file]) return kBadFile;
      let sum = 0;
      for (let k = 0; k < count; ++k) {
        const at = view().getUint32(vectors + 8 * k, true);
        const size = view().getUint32(vectors + 8 * k + 4, true);
        said[file].push(new Uint8Array(memory.buffer).slice(at, at + size));
        sum += size;
      }
      view().setUint32(written, sum, true);
      return 0;
    },
    fd_fdstat_get(file, at) {
      if (file > 2) return kBadFile;
      new Uint8Array(memory.buffer).fill(0, at, at + 24);
      view().setUint8(at, 2); // a character device
      view().setBigUint64(at + 8, 0xffffffffffffffffn, true);
      return 0;
    },
    fd_prestat_get: () => kBadFile,
    clock_time_get(_clock, _precision, at) {
      view().setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    },
    proc_exit(code) {
      throw new Exit(code);
    },
  };
  const imports = {};
  for (const { module: from, name } of WebAssembly.Module.imports(module)) {
    (imports[from] ??= {})[name] = known[name] ?? (() => kNotSupported);
  }
  const instance = await WebAssembly.instantiate(module, imports);
  memory = instance.exports.memory;
  let code = 0;
  try {
    instance.exports._start();
  } catch (error) {
    if (!(error instanceof Exit)) throw error;
    code = error.code;
  }
  const text = (file) => {
    const decoder = new TextDecoder();
    return said[file].map((bytes) => decoder.decode(bytes, { stream: true })).join("") + decoder.decode();
  };
  return { code, out: text(1), error: text(2) };
}
