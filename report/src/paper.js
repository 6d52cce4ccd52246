// The page on paper: the order of its sections, their contents, and what only a printed report needs.

import { element } from "./dom.js";

const mark = new URLSearchParams(location.hash.slice(1)).get("paper");

/** Whether the page was opened to be printed, as #paper: then it draws more pictures. */
export const isForPaper = mark !== null;

/** The SHA-256 of the file that the page shows, as `tribound report` found it; empty where it is not known. */
export const hashOfRecord = /^[0-9a-f]{64}$/.test(mark ?? "") ? mark : "";

/** What the report is about, and its sections. */
export function contents(purpose, sections) {
  return element("div", { class: "contents print-only" }, element("p", {}, purpose), element("h2", {}, "Contents"),
    element("ol", {}, sections.map((part) => element("li", {}, element("a", { href: `#${part.id}` }, part.querySelector("h2").textContent)))));
}

/** A text inside of quotes in CSS. */
const quoted = (text) => `"${text.replace(/["\\<\n]/g, (c) => `\\${c.charCodeAt(0).toString(16)} `)}"`;

/** The line at the foot of each sheet. */
function footLine(text) {
  return element("style", {}, `@page { @bottom-left { content: ${quoted(text)}; } @bottom-right { content: counter(page) " / " counter(pages); } }`);
}

/**
 * Prints `onPaper`, sections in their order on paper, opens what is closed and takes away the links to files, which would be of this
 * machine; afterwards `page` is as before. `foot`: on each sheet.
 */
export function prepareForPaper(page, { sections, onPaper, foot }) {
  const last = page.querySelector("footer");
  const each = (selector, change) => page.querySelectorAll(selector).forEach(change);
  document.head.append(footLine(foot));
  addEventListener("beforeprint", () => {
    sections.forEach((part) => part.remove());
    last.before(...onPaper);
    each("details", (part) => { part.dataset.open = part.open; part.open = true; });
    each("a:not([href^='#'])", (link) => { link.dataset.href = link.getAttribute("href"); link.removeAttribute("href"); });
  });
  addEventListener("afterprint", () => {
    last.before(...sections);
    each("details", (part) => { part.open = part.dataset.open === "true"; });
    each("a[data-href]", (link) => { link.setAttribute("href", link.dataset.href); });
  });
}
