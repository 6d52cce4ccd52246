// Bundles the page into one file, and writes the licences of what is in it beside it: node build.mjs <report.html>
import { createHash } from "node:crypto";
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const folder = dirname(fileURLToPath(import.meta.url));
const target = process.argv[2] ?? `${folder}/dist/report.html`;

const { outputFiles, metafile } = await build({
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
  metafile: true,
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

// The notices that have to accompany copies of the packages; where there is no file of them, the README has them.
const packages = new Set(Object.keys(metafile.inputs).map((file) => file.match(/^.*node_modules\/(@[^/]+\/)?[^/]+/)?.[0]));
packages.delete(undefined);
const licences = [...packages].sort().map((path) => {
  const { name, version, license } = JSON.parse(readFileSync(`${folder}/${path}/package.json`, "utf8"));
  const all = readdirSync(`${folder}/${path}`);
  const notices = all.filter((file) => /^(licen[cs]e|copying|notice)/i.test(file));
  const files = notices.length > 0 ? notices : all.filter((file) => /^readme/i.test(file));
  const texts = files.map((file) => readFileSync(`${folder}/${path}/${file}`, "utf8").trim());
  return [`${name} ${version}, licence ${license}`, ...texts].join("\n\n");
});

mkdirSync(dirname(target), { recursive: true });
writeFileSync(target, page);
writeFileSync(`${dirname(target)}/report-licences.txt`, `${["What report.html is made of, besides Tribound's own code.", ...licences].join("\n\n\n")}\n`);
console.log(`${target}: ${(page.length / 1e6).toFixed(2)} MB`);
