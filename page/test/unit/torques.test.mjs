// The arcs of torques.

import assert from "node:assert/strict";
import { test } from "node:test";
import { bundled } from "../made/bundled.mjs";

const { arc } = await bundled("layers/torques.ts");

test("an arc has the radius of its torque, and goes its way round", () => {
    // from the lower left by the right to the upper left, and its head beyond
    assert.match(arc([100, 50], 20), /^M85\.9 64\.1A20\.0 20\.0 0 1 0 88\.2 33\.8A20\.0 20\.0 0 1 1 85\.9 64\.1M/);
    // the same seen in a mirror
    assert.match(arc([100, 50], -20), /^M114\.1 64\.1A20\.0 20\.0 0 1 1 111\.8 33\.8A20\.0 20\.0 0 1 0 114\.1 64\.1M/);
    assert.equal(arc([0, 0], 1), "");
    assert.equal(arc([0, 0], NaN), "");
});
