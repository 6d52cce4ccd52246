// node units_test.mjs: the labels of the page, without a browser.
import assert from "node:assert/strict";
import { powerOfTen } from "../src/dom.js";
import { headed, measured, nameUnits, quantityUnit, unit } from "../src/units.js";

for (const units of [null, undefined]) {
  nameUnits(units);
  assert.equal(unit("stress"), "");
  assert.equal(quantityUnit("thrust"), "");
  assert.equal(measured("1.5", unit("stress")), "1.5");
  assert.equal(headed("gap", unit("length")), "gap");
  assert.equal(headed("gap", unit("length"), powerOfTen([0.5])), "gap");
  assert.equal(headed("gap", unit("length"), powerOfTen([2e-4])), "gap [10\u207b\u2074]");
}

nameUnits({ length: "mm", body: "mm^2", stress: "MPa", stress_norm: "MPa mm^(3/2)", energy_norm: "(N mm)^(1/2)",
  quantities: { thrust: "N/mm", safety: null } });
assert.equal(unit("body"), "mm\u00b2");
assert.equal(unit("stress_norm"), "MPa mm\u00b9\u00b7\u2075");
assert.equal(unit("energy_norm"), "(N mm)\u2070\u00b7\u2075");
assert.equal(unit("unknown"), "");
assert.equal(quantityUnit("thrust"), "N/mm");
assert.equal(quantityUnit("safety"), "");
assert.equal(measured("1.5", unit("stress")), "1.5 MPa");
assert.equal(headed("gap", unit("length"), powerOfTen([2e-4])), "gap [10\u207b\u2074 mm]");
assert.equal(headed("contact pressure", unit("stress"), powerOfTen([3])), "contact pressure [MPa]");
