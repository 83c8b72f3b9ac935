// build.mjs CORE.wasm PAGE_TEMPLATE.hpp VERSION OUT: bundles the page: OUT/explorer.html in one file, and OUT/explorer/ as a
// folder with the same page, style sheet and script apart. Neither loads anything from elsewhere.
import { build } from "esbuild";
import fs from "node:fs";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const [corePath, templatePath, version, out] = process.argv.slice(2);
const here = path.dirname(fileURLToPath(import.meta.url));

/** The style sheet of the reports is written down once, in their template. */
function reportStyle() {
  const found = /<style>\n([\s\S]*?)<\/style>/.exec(fs.readFileSync(templatePath, "utf8"));
  if (!found) throw new Error(`${templatePath} has no <style>: where has the style sheet of the reports gone?`);
  return found[1];
}

const core = gzipSync(fs.readFileSync(corePath), { level: 9 }).toString("base64");
const bundled = await build({
  entryPoints: [path.join(here, "src/main.ts")],
  bundle: true,
  write: false,
  minify: true,
  format: "iife",
  target: "es2022",
  legalComments: "none",
  define: { PLUMB_CORE: "__PLUMB_CORE__" },
});
const script = bundled.outputFiles[0].text;
const chart = fs.readFileSync(path.join(here, "node_modules/uplot/dist/uPlot.min.css"), "utf8");
const style = `${reportStyle()}${chart}\n${fs.readFileSync(path.join(here, "src/explorer.css"), "utf8")}`;
const coreScript = `const __PLUMB_CORE__="${core}";`;
const page = fs.readFileSync(path.join(here, "src/index.html"), "utf8").replace("<!-- version -->", () => version);

/** Functions, for a replacement text would take `$` for its own. */
const filled = (styles, scripts) => page.replace("<!-- style -->", () => styles).replace("<!-- script -->", () => scripts);
const inline = (text) => `<script>${text.replaceAll("</script", "<\\/script")}</script>`;

const folder = path.join(out, "explorer");
fs.mkdirSync(folder, { recursive: true });
fs.writeFileSync(path.join(out, "explorer.html"), filled(`<style>\n${style}</style>`, inline(coreScript) + inline(script)));
fs.writeFileSync(
  path.join(folder, "index.html"),
  filled('<link rel="stylesheet" href="explorer.css">', '<script src="core.js"></script>\n<script src="explorer.js"></script>'),
);
fs.writeFileSync(path.join(folder, "explorer.css"), style);
fs.writeFileSync(path.join(folder, "core.js"), coreScript);
fs.writeFileSync(path.join(folder, "explorer.js"), script);
const kB = (text) => Math.round(gzipSync(text).length / 1000);
console.log(`core ${Math.round((core.length * 3) / 4000)} kB, script ${kB(script)} kB, style ${kB(style)} kB, page ${kB(fs.readFileSync(path.join(out, "explorer.html")))} kB, all compressed`);
