// The page of a run, with the data of app/page/report_page.cpp.

import { nameAxes } from "./axes.js";
import { boundSection } from "./bound.js";
import { coloured } from "./components.js";
import { contactSection } from "./contact.js";
import { convergenceSection } from "./convergence.js";
import { caseSection, filesSection, guaranteeSection, levelsSection } from "./facts.js";
import { fieldsSection } from "./fields.js";
import { historySection } from "./history.js";
import { newtonSection } from "./newton.js";
import { observationsSection } from "./observations.js";
import { quantitiesSection } from "./quantities.js";
import { nameUnits } from "./units.js";
import { header } from "./verdict.js";

/** `trueErrors`: errors of the levels of a variant known from a study, else undefined. */
export function runPage(data, trueErrors) {
  const { certificate: run, machine } = data;
  nameUnits(run.units);
  nameAxes(run.model);
  for (const { level, ...errors } of trueErrors ?? [])
    Object.assign(run.levels.find((other) => other.level === level) ?? {}, errors);
  const components = coloured(data.components.filter(({ part }) => part !== "combined"));
  const fields = fieldsSection(data, components);
  const contact = contactSection(data);
  const { element: top, showContact } = header(data);
  const sections = [fields.element, historySection(run), quantitiesSection(run), observationsSection(run), boundSection(run, components), convergenceSection(run, components), contact.element,
    newtonSection(run, data.newton, components),
    guaranteeSection(run), caseSection(data), levelsSection(data),
    filesSection(trueErrors ? [...data.files, "../report.html"] : data.files, data)].filter(Boolean);
  const start = async () => {
    const summary = await contact.summary();
    if (summary) showContact(summary);
    await fields.start();
    await contact.start();
  };
  return { title: run.title || run.file, header: top, sections, start, machine, program: run.program };
}
