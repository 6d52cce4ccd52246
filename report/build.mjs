// Bundles the page into one file: node build.mjs <report.html>
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const folder = dirname(fileURLToPath(import.meta.url));
const target = process.argv[2] ?? `${folder}/dist/report.html`;

const { outputFiles } = await build({
  entryPoints: [`${folder}/src/main.js`],
  absWorkingDir: folder,
  bundle: true,
  minify: true,
  format: "iife",
  target: ["chrome100", "firefox113", "safari16.4"],
  charset: "ascii",
  legalComments: "none",
  outdir: "out",
  write: false,
  logLevel: "warning",
});
const text = (ending) => outputFiles.find((file) => file.path.endsWith(ending)).text;

// A script element ends at the first "</script" in it, whatever that is part of.
const script = text(".js").replaceAll("</script", "<\\/script");
const style = text(".css").replaceAll("</style", "<\\/style");
const hash = (code) => `'sha256-${createHash("sha256").update(code).digest("base64")}'`;

const parts = {
  "<!-- script -->": `<script>${script}</script>`,
  "<!-- style -->": `<style>${style}</style>`,
  "<!-- script hash -->": hash(script),
};
let page = readFileSync(`${folder}/src/index.html`, "utf8");
for (const [place, part] of Object.entries(parts)) {
  if (page.split(place).length !== 2) throw new Error(`index.html: ${place} must stand there once`);
  page = page.replace(place, () => part);
}
mkdirSync(dirname(target), { recursive: true });
writeFileSync(target, page);
console.log(`${target}: ${(page.length / 1e6).toFixed(2)} MB`);
