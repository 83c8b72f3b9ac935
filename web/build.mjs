// build.mjs CORE.wasm LOGS.js PAGE_TEMPLATE.hpp VERSION OUT: bundles the page: OUT/explorer.html in one file, and OUT/explorer/ as a
// folder with the same page, style sheet and script apart. Neither loads anything from elsewhere.
import { build } from "esbuild";
import fs from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const [corePath, logsPath, templatePath, version, out] = process.argv.slice(2);
const here = path.dirname(fileURLToPath(import.meta.url));

/** The style sheet of the reports is written down once, in their template. */
function reportStyle() {
  const found = /<style>\n([\s\S]*?)<\/style>/.exec(fs.readFileSync(templatePath, "utf8"));
  if (!found) throw new Error(`${templatePath} has no <style>: where has the style sheet of the reports gone?`);
  return found[1];
}

const packed = (file) => gzipSync(fs.readFileSync(file), { level: 9 }).toString("base64");
const core = packed(corePath);
const logs = packed(logsPath.replace(/\.js$/, ".wasm"));

async function bundled(entry, more) {
  const made = await build({
    entryPoints: [path.join(here, "src", entry)],
    bundle: true,
    write: false,
    minify: true,
    format: "iife",
    target: "es2022",
    legalComments: "none",
    ...more,
  });
  return made.outputFiles[0].text;
}
const script = await bundled("main.ts", {
  define: { PLUMB_CORE: "__PLUMB_CORE__", PLUMB_LOGS: "__PLUMB_LOGS__", PLUMB_LOG_WORKER: "__PLUMB_LOG_WORKER__" },
});
// The worker is text in the page: a page opened from disk may start a worker from a Blob, and from no file.
const worker = await bundled("logworker.ts", { alias: { "plumb-logs": path.resolve(logsPath) } });
const chart = fs.readFileSync(path.join(here, "node_modules/uplot/dist/uPlot.min.css"), "utf8");
const style = `${reportStyle()}${chart}\n${fs.readFileSync(path.join(here, "src/explorer.css"), "utf8")}`;
const coreScript = `const __PLUMB_CORE__="${core}";`;
const logsScript = `const __PLUMB_LOGS__="${logs}",__PLUMB_LOG_WORKER__=${JSON.stringify(worker)};`;
const page = fs.readFileSync(path.join(here, "src/index.html"), "utf8").replace("<!-- version -->", () => version);

/** Functions, for a replacement text would take `$` for its own. */
const filled = (styles, scripts) => page.replace("<!-- style -->", () => styles).replace("<!-- script -->", () => scripts);
const inline = (text) => `<script>${text.replaceAll("</script", "<\\/script")}</script>`;

const folder = path.join(out, "explorer");
fs.mkdirSync(folder, { recursive: true });
fs.writeFileSync(path.join(out, "explorer.html"), filled(`<style>\n${style}</style>`, inline(coreScript) + inline(logsScript) + inline(script)));
fs.writeFileSync(
  path.join(folder, "index.html"),
  filled('<link rel="stylesheet" href="explorer.css">', '<script src="core.js"></script>\n<script src="logs.js"></script>\n<script src="explorer.js"></script>'),
);
fs.writeFileSync(path.join(folder, "explorer.css"), style);
fs.writeFileSync(path.join(folder, "core.js"), coreScript);
fs.writeFileSync(path.join(folder, "logs.js"), logsScript);
fs.writeFileSync(path.join(folder, "explorer.js"), script);
const kB = (text) => Math.round(gzipSync(text).length / 1000);
const bytes = (base64) => Math.round((base64.length * 3) / 4000);
console.log(`core ${bytes(core)} kB, tool for logs ${bytes(logs)} kB and its worker ${kB(worker)} kB, script ${kB(script)} kB, style ${kB(style)} kB, page ${kB(fs.readFileSync(path.join(out, "explorer.html")))} kB, all compressed`);
