// A hand that leads a body by an input of which it knows only where that has brought the body.

import assert from "node:assert/strict";
import { test } from "node:test";
import { bundled } from "../made/bundled.mjs";

const { Leash } = await bundled("live/leash.ts");

/** Pulls a body, whose angle is a function of its input, from place to place; says where it is for each, and how often it was asked. */
function pulled(angleOf, rate, input, angles, most = Infinity) {
    const leash = new Leash({ angle: angleOf(input), input }, rate);
    let asked = 0;
    const places = angles.map((angle) => {
        for (let next = leash.pull(angle); next !== undefined; ) {
            asked++;
            input = Math.min(next, most);
            next = leash.answer({ angle: angleOf(input), input }, true);
        }
        return angleOf(input);
    });
    return { places, asked };
}

const way = (from, to, steps) => Array.from({ length: steps }, (_, k) => from + ((to - from) * (k + 1)) / steps);

test("a body comes to the hand, however its angle depends on the input", () => {
    for (const [what, angleOf, rate, input, to] of [
        ["turn", (u) => u, 1, 0.5, 3],
        ["2 turn", (u) => 2 * u, 2, 0.5, 5],
        ["-turn", (u) => -u, -1, 0.5, 2],
        ["the other way round", (u) => 0.2 - u, -1, 0.5, -3],
        ["a rack", (u) => u / 0.02, 50, 0.001, 2],
        ["sin(turn)", Math.sin, 1, 0, 0.98],
        ["sin(turn), where it falls", Math.sin, 1, 2, -0.9],
        ["turn squared", (u) => u * u, 0.2, 0.1, 4],
    ]) {
        const angles = way(angleOf(input), to, 20);
        const { places, asked } = pulled(angleOf, rate, input, angles);
        places.forEach((place, k) => assert.ok(Math.abs(place - angles[k]) < 1e-3, `${what}: ${place} and not ${angles[k]}`));
        assert.ok(asked <= 20 * 5, `${what}: asked ${asked} times`);
    }
});

test("what is led evenly is asked once for each place", () => {
    const { asked } = pulled((u) => -2 * u, -2, 1, way(-2, 4, 30));
    assert.equal(asked, 30);
});

test("a dead point ends it, and so does a hand that is where no input leads", () => {
    const stopped = pulled((u) => u, 1, 0, [0.5, 2, 3, 1], 1.2);
    assert.deepEqual([stopped.places, stopped.asked], [[0.5, 1.2, 1.2, 1], 4]);
    const beyond = pulled(Math.sin, 1, 0, [0.5, 1.5]);
    assert.ok(beyond.asked < 30 && Math.abs(beyond.places[1]) <= 1);
});

test("what was asked before is learned from, and answered by nothing", () => {
    const leash = new Leash({ angle: 0, input: 0 }, 1);
    leash.pull(0.5);
    assert.equal(leash.pull(1), 1);
    assert.equal(leash.answer({ angle: 1, input: 0.5 }, false), undefined);
    assert.ok(leash.isWaiting);
    assert.equal(leash.answer({ angle: 2, input: 1 }, true), 0.5);
    assert.equal(leash.answer({ angle: 1, input: 0.5 }, true), undefined);
    assert.ok(!leash.isWaiting);
});
