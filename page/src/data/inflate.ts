// Tables as they travel, each column exact to the last bit. Numbers are taken for whole numbers in the order of the reals; what is
// stored is how far each is from what the ones before it foretell (the polynomial through the last K rows), zigzag, in byte planes, all of
// it deflated. First comes a byte K for each column, then each column's eight planes, the highest first.
//
// Whole numbers of 64 bits are two of 32 here: BigInt is too slow for millions of them.

/** The greatest order of prediction. */
const GREATEST_ORDER = 8;

/** The bytes behind Base64. */
export function bytesOfBase64(text: string): Uint8Array<ArrayBuffer> {
    const letters = atob(text);
    const bytes = new Uint8Array(letters.length);
    for (let k = 0; k < letters.length; k++) bytes[k] = letters.charCodeAt(k);
    return bytes;
}

/** What was deflated without a header. */
export async function inflated(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** (-1)^(j+1) · (K over j) for j = 1 … K: what the values before are multiplied with, the last first. */
function weights(order: number): Float64Array {
    const weights = new Float64Array(order);
    let binomial = 1;
    for (let j = 1; j <= order; j++) {
        binomial = (binomial * (order - j + 1)) / j;
        weights[j - 1] = j % 2 === 1 ? binomial : -binomial;
    }
    return weights;
}

const WEIGHTS = Array.from({ length: GREATEST_ORDER + 1 }, (_, order) => weights(order));

/** What the rows before foretell: of the first rows as much as there are; 0 where that is no number. */
export function foretold(column: Float64Array, row: number, order: number): number {
    const weights = WEIGHTS[Math.min(order, row)]!;
    let sum = 0;
    for (let j = 0; j < weights.length; j++) sum += weights[j]! * column[row - 1 - j]!;
    return Number.isFinite(sum) ? sum : 0;
}

/** Which half of a number is the high one. */
const HIGH = new Uint8Array(new Uint32Array([1]).buffer)[0] === 1 ? 1 : 0;

/** The columns of a table, from what was inflated. */
export function columnsOf(bytes: Uint8Array, rows: number, columns: number): Float64Array[] {
    if (bytes.length !== columns * (1 + 8 * rows)) throw new Error("the table does not have the size that it should have");
    const one = new Float64Array(1);
    const halves = new Uint32Array(one.buffer);
    const table: Float64Array[] = [];
    for (let c = 0; c < columns; c++) {
        const order = bytes[c]!;
        const column = new Float64Array(rows);
        const bits = new Uint32Array(column.buffer);
        const plane = columns + c * 8 * rows;
        for (let row = 0; row < rows; row++) {
            let at = plane + row;
            let high = 0;
            let low = 0;
            for (let k = 0; k < 4; k++, at += rows) high = (high << 8) | bytes[at]!;
            for (let k = 0; k < 4; k++, at += rows) low = (low << 8) | bytes[at]!;
            // zigzag back: (z >> 1) ^ -(z & 1)
            const sign = -(low & 1);
            low = ((low >>> 1) | (high << 31)) ^ sign;
            high = (high >>> 1) ^ sign;
            // plus what was foretold, in the order of the reals
            one[0] = foretold(column, row, order);
            let high2 = halves[HIGH]!;
            let low2 = halves[1 - HIGH]!;
            if (high2 >>> 31) {
                high2 = ~high2;
                low2 = ~low2;
            } else {
                high2 = (high2 | 0x80000000) >>> 0;
            }
            const sum = (low >>> 0) + (low2 >>> 0);
            low = sum >>> 0;
            high = (high + high2 + (sum > 0xffffffff ? 1 : 0)) >>> 0;
            // and back to the bits of a number
            if (high >>> 31) {
                high = (high & 0x7fffffff) >>> 0;
            } else {
                high = ~high;
                low = ~low;
            }
            bits[2 * row + HIGH] = high;
            bits[2 * row + 1 - HIGH] = low;
        }
        table.push(column);
    }
    return table;
}
