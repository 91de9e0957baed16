// Values that are told by what makes them of another one.

import assert from "node:assert/strict";
import { test } from "node:test";
import { bundled } from "../made/bundled.mjs";

const { changed } = await bundled("data/changes.ts");

test("what changes is another one, and nothing else", () => {
    const from = { a: [1, [2, 3]], b: { c: "d" }, e: [] };
    const made = changed(from, { a: { 1: { 1: [4] } }, b: { c: ["f"] }, e: [[0]] });
    assert.deepEqual(made, { a: [1, [2, 4]], b: { c: "f" }, e: [0] });
    assert.deepEqual(from, { a: [1, [2, 3]], b: { c: "d" }, e: [] });
    assert.ok(Array.isArray(made.a[1]));
    assert.equal(changed(from, {}).b, from.b);
});
