// Reads the data embedded in the page by the program, and shows them section by section.

import "./style.css";
import { element } from "./dom.js";
import { judgementPage } from "./judgement.js";
import { contents, prepareForPaper } from "./paper.js";
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

async function show() {
  const place = document.getElementById("page");
  const kinds = { run: (data) => runPage(data, embedded("true-errors")), study: studyPage, sweep: sweepPage, judgement: judgementPage };
  const kind = Object.keys(kinds).find((name) => document.getElementById(`${name}-data`));
  if (!kind) {
    place.replaceChildren(element("p", {}, "This is the page without data; tribound run, study, sweep and judge fill it."));
    return;
  }
  const page = kinds[kind](embedded(`${kind}-data`));
  const { title, sections, onPaper = sections.filter(({ id }) => id !== "files"), machine, program } = page;
  const written = `Tribound ${program.version} on ${machine.written}`;
  place.replaceChildren(page.header, contents(page.purpose, onPaper), navigation(sections), ...sections,
    element("footer", { class: "screen-only" }, `Written by ${written}. This file needs no network; its data are also in the files beside it.`));
  prepareForPaper(place, { sections, onPaper, foot: `${title} \u2013 ${written}` });
  await page.start();
  document.title = `${title} \u2013 Tribound`; // not before: the program knows by it that a printed page is complete
  document.documentElement.dataset.ready = "true"; // for tests
}

show().catch((error) => {
  document.getElementById("page").prepend(element("p", { class: "verdict verdict-failed" }, `This page cannot be shown: ${error.message}. `
    + "It takes a browser of 2023 or newer; the results are also in the JSON files and the tables beside it."));
  console.error(error);
});
