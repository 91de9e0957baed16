// Tables come back to the last bit, from an encoder that shares nothing with the decoder.

import assert from "node:assert/strict";
import { test } from "node:test";
import { bundled } from "../made/bundled.mjs";
import { encoded, planes } from "../made/encode.mjs";

const { bytesOfBase64, columnsOf, foretold, inflated } = await bundled("data/inflate.ts");

const bits = (column) => [...new BigUint64Array(Float64Array.from(column).buffer)];

async function check(columns) {
    const rows = columns[0].length;
    const bytes = await inflated(bytesOfBase64(encoded(columns)));
    const read = columnsOf(bytes, rows, columns.length);
    assert.equal(read.length, columns.length);
    columns.forEach((column, k) => assert.deepEqual(bits(read[k]), bits(column), `column ${k}`));
}

test("smooth columns", () => check([0, 1, 2].map((k) => Float64Array.from({ length: 300 }, (_, row) => k + Math.sin(0.01 * (k + 1) * row)))));

test("numbers at the ends of their range", () => {
    const odd = [0, -0, 5e-324, -5e-324, Number.MIN_VALUE, Number.MAX_VALUE, -Number.MAX_VALUE, Infinity, -Infinity, NaN, 1, NaN, NaN, 2];
    return check([odd, [...odd].reverse()]);
});

test("one row, and none", async () => {
    await check([[1.5], [-0.1]]);
    assert.deepEqual(columnsOf(planes([[], []]), 0, 2).map((column) => column.length), [0, 0]);
});

test("random bits", () => {
    // a linear congruence: the same numbers each time
    let state = 12345n;
    const next = () => (state = (state * 6364136223846793005n + 1442695040888963407n) & ((1n << 64n) - 1n));
    const numbers = Array.from({ length: 500 }, () => new Float64Array(new BigUint64Array([next()]).buffer)[0]).map((x) => (Number.isNaN(x) ? 0.5 : x));
    return check([numbers, numbers.map((x) => -x)]);
});

test("a polynomial is foretold", () => {
    const cubic = Float64Array.from({ length: 10 }, (_, k) => k ** 3 - 4 * k);
    assert.equal(foretold(cubic, 9, 4), 729 - 36);
    assert.equal(foretold(Float64Array.from([1, NaN, 2]), 2, 2), 0);
});

test("a table of another size is refused", () => {
    assert.throws(() => columnsOf(new Uint8Array(10), 2, 1), /size/);
});
