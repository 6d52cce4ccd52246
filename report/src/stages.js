// The stages shown in the pictures of a page: the load steps of a run, if there are any, else its levels.

import { number } from "./dom.js";

export function stagesOf(run) {
  if (!run.steps) return { name: "level", all: run.levels, text: (level) => String(level) };
  const all = run.steps.map((step) => ({ ...step, level: step.step }));
  const at = (level) => all.find((step) => step.level === level);
  return { name: "step", all, text: (level) => `${level} (t = ${number(at(level)?.t, 6)})` };
}
