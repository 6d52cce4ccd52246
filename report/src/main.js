// Reads the data embedded in the page by the program, and shows them section by section.

import "./style.css";
import { element } from "./dom.js";
import { judgementPage } from "./judgement.js";
import { runPage } from "./run.js";
import { studyPage } from "./study.js";
import { sweepPage } from "./sweep.js";

/** The content of the script element with this id, or undefined. */
function embedded(id) {
  const text = document.getElementById(id)?.textContent;
  return text && JSON.parse(text);
}

function navigation(sections) {
  return element("nav", { "aria-label": "Sections", class: "screen-only" }, sections.map((part) =>
    element("a", { href: `#${part.id}` }, part.dataset.short)));
}

/** Opens everything for printing. */
function openOnPaper(page) {
  addEventListener("beforeprint", () => page.querySelectorAll("details").forEach((part) => { part.dataset.open = part.open; part.open = true; }));
  addEventListener("afterprint", () => page.querySelectorAll("details").forEach((part) => { part.open = part.dataset.open === "true"; }));
}

async function show() {
  const place = document.getElementById("page");
  const kinds = { run: (data) => runPage(data, embedded("true-errors")), study: studyPage, sweep: sweepPage, judgement: judgementPage };
  const kind = Object.keys(kinds).find((name) => document.getElementById(`${name}-data`));
  if (!kind) {
    place.replaceChildren(element("p", {}, "This is the page without data; tribound run, study, sweep and judge fill it."));
    return;
  }
  const page = kinds[kind](embedded(`${kind}-data`));
  const { machine, program } = page;
  document.title = `${page.title} \u2013 Tribound`;
  place.replaceChildren(page.header, navigation(page.sections), ...page.sections,
    element("footer", {}, `Written by Tribound ${program.version} on ${machine.written}. This file needs no network; its data are also in the files beside it.`));
  openOnPaper(place);
  await page.start();
  document.documentElement.dataset.ready = "true"; // for tests
}

show().catch((error) => {
  document.getElementById("page").prepend(element("p", { class: "verdict verdict-failed" }, `This page cannot be shown: ${error.message}. `
    + "It takes a browser of 2023 or newer; the results are also in the JSON files and the tables beside it."));
  console.error(error);
});
