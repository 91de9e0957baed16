import assert from "node:assert/strict";
import { test } from "node:test";
import { bundled } from "../made/bundled.mjs";

const { typedIn } = await bundled("data/typed.ts");
const { Settings } = await bundled("live/settings.ts");
const { rounded } = await bundled("live/hand.ts");

const MM = { name: "rod", unit: "mm", si: 1e-3, dimension: "m" };

test("what is typed is taken in any unit of the dimension, and nothing else", () => {
    for (const [typed, number] of [["95", 95], [" -95.5mm ", -95.5], ["\u22121e2 mm", -100], ["9.5 cm", 95], ["1 in", 25.4], ["0.0951 m", 95.1], ["95,5", 95.5], [".5", 0.5]]) {
        assert.equal(typedIn(typed, MM), number, typed);
    }
    for (const typed of ["", "mm", "0x60", "1 000", "Infinity", "1e400", "95 deg", "95 s", "95 ells", "\uff11\uff10"]) assert.equal(typeof typedIn(typed, MM), "string", typed);
    assert.match(typedIn("many", { unit: "in", si: 0.0254, dimension: "m" }), /a number of “in” is wanted/);
    assert.equal(typedIn("180 deg", { unit: "rad", si: 1, dimension: "" }), 3.14159265358979);
    assert.equal(typedIn("120 rpm", { unit: "deg/s", si: Math.PI / 180, dimension: "/s" }), 720);
    assert.equal(typedIn("12 kN/m", { unit: "kN/m", si: 1000, dimension: "N/m" }), 12);
});

test("what is set stays what it is, and waits for its param", () => {
    const settings = new Settings();
    assert.equal(settings.follow([MM]), false);
    settings.values.set("rod", 95);
    assert.deepEqual(settings.asked(), [["rod", "95 mm"]]);
    assert.equal(settings.follow([{ ...MM, unit: "cm", si: 1e-2 }]), true);
    assert.deepEqual(settings.asked(), [["rod", "9.5 cm"]]);
    assert.equal(settings.follow([]), true);
    assert.deepEqual([settings.asked(), settings.said], [[], "Kept for when the text has it again: rod = 9.5 cm"]);
    assert.equal(settings.follow([{ ...MM, unit: "deg/s", si: 1, dimension: "/s" }]), false);
    assert.equal(settings.follow([MM]), true);
    assert.deepEqual([settings.asked(), settings.said], [[["rod", "95 mm"]], ""]);
    assert.equal(settings.follow([MM]), false);
    settings.clear();
    assert.equal(settings.follow([MM]), false);
});

test("what is set of all copies takes the place of what is set of each", () => {
    const settings = new Settings();
    const all = { ...MM, name: "leg.rod", value: 40, formula: null, of: null };
    settings.follow([all, { ...all, name: "leg[0].rod", of: "leg.rod" }, { ...all, name: "leg[1].rod", of: "leg.rod" }]);
    settings.set("leg[1].rod", 41);
    settings.set("leg.rod", 50);
    assert.deepEqual(settings.asked(), [["leg.rod", "50 mm"]]);
    // as the text says, and not as all are by now
    settings.set("leg[0].rod", 40);
    assert.deepEqual(settings.asked(), [["leg.rod", "50 mm"], ["leg[0].rod", "40 mm"]]);
    settings.set("leg.rod", 40);
    assert.deepEqual(settings.asked(), []);
});

test("a hand's places are told to a tenth of a pixel", () => {
    assert.equal(rounded(0.1234567, "mm", 0.0005), 123.46);
    assert.equal(rounded(0.1234567, "mm", 0.005), 123.5);
    assert.equal(rounded(0.1234567, "m", 0.0005), 0.12346);
    assert.equal(rounded(5.2919e-8, "mm", 1e-4), 0);
    assert.equal(rounded(500.1234567, "m", 0.0005), 500.12346);
    assert.equal(rounded(123456.7, "mm", 5), 123456700);
});
