// node schema.mjs <folder with ajv>: reads { schema, documents } from stdin and prints what is wrong with each document, or
// null. Exit code 77: ajv is missing.
import { existsSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";

const folder = process.argv[2];
if (!existsSync(`${folder}/node_modules/ajv`)) {
  console.log("skipped: ajv is not installed");
  process.exit(77);
}
const Ajv = createRequire(`${folder}/package.json`)("ajv");
const { schema, documents } = JSON.parse(readFileSync(0, "utf8"));
const ajv = new Ajv({ allErrors: true, allowUnionTypes: true, strictTypes: false, strictRequired: false });
const validate = ajv.compile(schema); // throws if the schema is invalid
console.log(JSON.stringify(documents.map((document) => (validate(document) ? null : ajv.errorsText(validate.errors)))));
