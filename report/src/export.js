// Pictures and tables as files.

import { csvFormat } from "d3";
import { element } from "./dom.js";

const looks = ["fill", "fill-opacity", "stroke", "stroke-width", "stroke-opacity", "stroke-dasharray", "stroke-linecap", "opacity", "filter",
  "font-family", "font-size", "font-weight", "text-anchor", "font-variant-numeric"];

export function download(name, type, content) {
  const url = URL.createObjectURL(new Blob([content], { type }));
  element("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 60000);
}

/** A copy of an SVG element that looks the same without the style sheet of the page. */
function standalone(svg) {
  const copy = svg.cloneNode(true);
  const [from, to] = [svg, copy].map((root) => [root, ...root.querySelectorAll("*")]);
  from.forEach((original, i) => {
    const style = getComputedStyle(original);
    for (const name of looks) to[i].style.setProperty(name, style.getPropertyValue(name));
    to[i].removeAttribute("class");
  });
  copy.querySelectorAll("style, [aria-label=tip]").forEach((part) => part.remove());
  return copy;
}

function sizeOf(svg) {
  const { width, height } = svg.viewBox.baseVal;
  return [width || svg.clientWidth, height || svg.clientHeight];
}

/** Combines SVG elements, one below another, into a picture with a background. */
function picture(svgs) {
  const sizes = svgs.map(sizeOf);
  const width = Math.max(...sizes.map(([w]) => w));
  const height = sizes.reduce((sum, [, h]) => sum + h, 0);
  const background = getComputedStyle(document.documentElement).getPropertyValue("--panel").trim();
  const result = element("svg:svg", { viewBox: `0 0 ${width} ${height}`, width, height },
    element("svg:rect", { width, height, fill: background }));
  let top = 0;
  svgs.forEach((svg, i) => {
    const copy = standalone(svg);
    for (const [key, value] of Object.entries({ x: 0, y: top, width: sizes[i][0], height: sizes[i][1] })) copy.setAttribute(key, value);
    copy.style.display = "inline";
    result.append(copy);
    top += sizes[i][1];
  });
  return { width, height, text: new XMLSerializer().serializeToString(result) };
}

export function downloadSvg(name, svgs) {
  download(`${name}.svg`, "image/svg+xml", picture(svgs).text);
}

export async function downloadPng(name, svgs, scale = 2) {
  const { width, height, text } = picture(svgs);
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(text)}`;
  await image.decode();
  const canvas = element("canvas", { width: Math.round(scale * width), height: Math.round(scale * height) });
  canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
  canvas.toBlob((blob) => download(`${name}.png`, "image/png", blob));
}

export function downloadCsv(name, rows) {
  download(`${name}.csv`, "text/csv", csvFormat(rows));
}

/** Buttons for the files `name`.svg, .png, .csv; `svgs()` and `rows()` give their contents. */
export function exportButtons(name, svgs, rows) {
  const button = (kind, action) => element("button", { type: "button", title: `save as ${name}.${kind.toLowerCase()}`, onclick: action }, kind);
  return element("div", { class: "export screen-only" }, button("SVG", () => downloadSvg(name, svgs())),
    button("PNG", () => downloadPng(name, svgs())), rows ? button("CSV", () => downloadCsv(name, rows())) : null);
}
