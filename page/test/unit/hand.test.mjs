// Points of the drawing that a hand can move.

import assert from "node:assert/strict";
import { test } from "node:test";
import { bundled } from "../made/bundled.mjs";

const { Hand } = await bundled("live/hand.ts");

const knob = (name, value) => ({ name, value, unit: "m", formula: null, of: null });
const told = { knobs: [knob("C.x", 4), knob("C.y", 0)] };

/** A motion of so many rows in which the pivot is somewhere. */
const drawn = (x, rows = 2) => ({
    table: { rows },
    scene: { points: [{ frame: 0, at: [x, 0] }], extent: [[0, -1], [5, 1]] },
    motion: { from: 0, moment: () => ({}), at: () => ({ frames: [0, 0, 0, 1, 0] }) },
});

test("a point stays in a hand that has moved on when the motion of where it was comes", () => {
    const hand = new Hand({});
    const at = (x) => new Map([["C.x", x]]);
    hand.offer(told, drawn(4), new Map(), new Map());
    assert.deepEqual(hand.points().map(({ name, at }) => [name, at]), [["C", [4, 0]]]);
    hand.offer(told, drawn(4.5), at(4.5), at(6));
    assert.deepEqual(hand.points().map(({ at }) => at), [[6, 0]]);
    // where nothing can be drawn it stays too
    hand.offer(told, drawn(6, 0), at(6), at(7));
    assert.deepEqual(hand.points().map(({ at }) => at), [[7, 0]]);
    // a param that nothing is drawn at is no point of the drawing
    hand.offer(told, drawn(4.5), at(7), at(7));
    assert.deepEqual(hand.points(), []);
});
