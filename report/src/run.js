// The page of a run, with the data of app/page/report_page.cpp.

import { nameAxes } from "./axes.js";
import { boundSection } from "./bound.js";
import { coloured } from "./components.js";
import { contactSection } from "./contact.js";
import { convergenceSection } from "./convergence.js";
import { balanceSection, caseSection, caseTextSection, filesSection, guaranteeSection, levelsSection } from "./facts.js";
import { fieldsSection } from "./fields.js";
import { historySection } from "./history.js";
import { newtonSection } from "./newton.js";
import { observationsSection } from "./observations.js";
import { quantitiesSection } from "./quantities.js";
import { safetySection } from "./safety.js";
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
  const results = [historySection(run), quantitiesSection(run), observationsSection(run)];
  const bounds = [boundSection(run, components), convergenceSection(run, components)];
  const forces = [contact.element, safetySection(run), balanceSection(run)];
  const newton = newtonSection(run, data.newton, components);
  const guarantee = guaranteeSection(run);
  const [about, text] = [caseSection(data), caseTextSection(data)];
  const levels = levelsSection(data);
  const files = filesSection(trueErrors ? [...data.files, "../report.html"] : data.files, data);
  const sections = [fields.element, ...results, ...bounds, ...forces, newton, guarantee, about, text, levels, files].filter(Boolean);
  const onPaper = [about, fields.element, ...results, ...forces, guarantee, ...bounds, newton, levels, text].filter(Boolean);
  const start = async () => {
    const summary = await contact.summary();
    if (summary) showContact(summary);
    await fields.start();
    await contact.start();
  };
  const title = run.title || run.file;
  const purpose = `This report documents the computation \u201c${title}\u201d: the model with its data, the results, and how far they are guaranteed.`;
  return { title, purpose, header: top, sections, onPaper, start, machine, program: run.program };
}
