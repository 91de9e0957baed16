// Tables as the page reads them, written independently of it and of `src/view/page`: with BigInt, slowly and plainly.

import { deflateRawSync } from "node:zlib";

const bitsOf = (value) => {
    const view = new DataView(new ArrayBuffer(8));
    view.setFloat64(0, value);
    return view.getBigUint64(0);
};
const MASK = (1n << 64n) - 1n;
/** Whole numbers in the order of the reals. */
const ordered = (bits) => (bits >> 63n ? ~bits & MASK : bits | (1n << 63n));

function binomial(n, k) {
    let value = 1;
    for (let j = 1; j <= k; j++) value = (value * (n - j + 1)) / j;
    return value;
}

function foretold(column, row, wanted) {
    const order = Math.min(wanted, row);
    let sum = 0;
    for (let j = 1; j <= order; j++) sum += (j % 2 === 1 ? 1 : -1) * binomial(order, j) * column[row - j];
    return Number.isFinite(sum) ? sum : 0;
}

function zigzags(column, order) {
    return Array.from(column, (value, row) => {
        const d = (ordered(bitsOf(value)) - ordered(bitsOf(foretold(column, row, order)))) & MASK;
        const signed = d >> 63n ? d - (1n << 64n) : d;
        return signed >= 0n ? signed << 1n : (-signed << 1n) - 1n;
    });
}

const cost = (zigzag) => zigzag.reduce((sum, z) => sum + z.toString(2).length, 0);

/** The bytes before they are deflated. */
export function planes(columns) {
    const orders = [];
    const rest = [];
    for (const column of columns) {
        const tries = Array.from({ length: 9 }, (_, order) => zigzags(column, order));
        const costs = tries.map(cost);
        const order = costs.indexOf(Math.min(...costs));
        orders.push(order);
        for (let plane = 7n; plane >= 0n; plane--) {
            for (const z of tries[order]) rest.push(Number((z >> (8n * plane)) & 255n));
        }
    }
    return Uint8Array.from([...orders, ...rest]);
}

export function encoded(columns) {
    return deflateRawSync(planes(columns)).toString("base64");
}
