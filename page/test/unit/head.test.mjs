// The words above all else.

import assert from "node:assert/strict";
import { test } from "node:test";
import { bundled } from "../made/bundled.mjs";

const { sentences } = await bundled("live/head.ts");

test("a sentence ends at a full stop, as in a page that is written", () => {
    for (const [text, wanted] of [
        ["A crank. It turns.", ["A crank.", "It turns."]],
        [" One of D. Stewart's, at 0.5 m/s.\nMore. ", ["One of D. Stewart's, at 0.5 m/s.", "More."]],
        ["no end", ["no end", ""]],
        ["Does it turn? Yes", ["Does it turn?", "Yes"]],
        ["", ["", ""]],
    ]) {
        assert.deepEqual(sentences(text), wanted, text);
    }
});
