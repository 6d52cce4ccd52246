// The page of a run: reads the data that src/io/report_page.cpp put into it, and shows them section by section.

import "./style.css";
import { boundSection, convergenceSection } from "./charts.js";
import { contactSection } from "./contact.js";
import { caseSection, filesSection, guaranteeSection, machineSection } from "./facts.js";
import { fieldsSection } from "./fields.js";
import { element } from "./dom.js";
import { header } from "./verdict.js";
import { newtonSection } from "./newton.js";

function navigation(sections) {
  return element("nav", { "aria-label": "Sections", class: "screen-only" }, sections.map((part) =>
    element("a", { href: `#${part.id}` }, part.dataset.short)));
}

async function show() {
  const page = document.getElementById("page");
  const text = document.getElementById("run-data")?.textContent;
  if (!text) {
    page.replaceChildren(element("p", {}, "This is the page without data of a run; tribound run fills it."));
    return;
  }
  const data = JSON.parse(text);
  const run = data.certificate;
  for (const { level, ...errors } of JSON.parse(document.getElementById("true-errors")?.textContent ?? "[]"))
    Object.assign(run.levels.find((other) => other.level === level) ?? {}, errors);
  document.title = `${run.title || run.file} \u2013 Tribound`;
  const fields = fieldsSection(data);
  const contact = contactSection(data);
  const sections = [fields.element, boundSection(run), convergenceSection(run), contact.element, newtonSection(run, data.newton),
    guaranteeSection(run), caseSection(data), machineSection(data), filesSection(data.files)].filter(Boolean);
  page.replaceChildren(header(data), navigation(sections), ...sections,
    element("footer", {}, `Written by Tribound ${run.program.version} on ${data.machine.written}. This file needs no network; its data are also in the files beside it.`));
  // Everything is open on paper.
  addEventListener("beforeprint", () => page.querySelectorAll("details").forEach((part) => { part.dataset.open = part.open; part.open = true; }));
  addEventListener("afterprint", () => page.querySelectorAll("details").forEach((part) => { part.open = part.dataset.open === "true"; }));
  await fields.start();
  await contact.start();
  document.documentElement.dataset.ready = "true"; // for tests
}

show().catch((error) => {
  document.getElementById("page").prepend(element("p", { class: "verdict verdict-failed" }, `This page cannot be shown: ${error.message}. `
    + "It takes a browser of 2023 or newer; the results are also in certificate.json and the tables beside it."));
  console.error(error);
});
