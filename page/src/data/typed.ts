// Numbers as a reader types them, with a unit behind or without.

/** In what something is set: the unit, what one of it is in SI, and the SI unit of its dimension, where angles are pure numbers. */
export interface Measured {
    unit: string;
    si: number;
    dimension: string;
}

const DEGREE = Math.PI / 180;

/** Other units that may be typed: what one is in SI, and of which dimension. */
const UNITS: Record<string, [si: number, dimension: string]> = {
    m: [1, "m"], mm: [1e-3, "m"], cm: [1e-2, "m"], um: [1e-6, "m"], km: [1e3, "m"], in: [0.0254, "m"], ft: [0.3048, "m"],
    s: [1, "s"], ms: [1e-3, "s"], us: [1e-6, "s"], min: [60, "s"], h: [3600, "s"],
    rad: [1, ""], deg: [DEGREE, ""], rev: [2 * Math.PI, ""],
    "rad/s": [1, "/s"], "deg/s": [DEGREE, "/s"], "rev/s": [2 * Math.PI, "/s"], rpm: [Math.PI / 30, "/s"],
    "m/s": [1, "m/s"], "mm/s": [1e-3, "m/s"], "cm/s": [1e-2, "m/s"],
    kg: [1, "kg"], N: [1, "N"], kN: [1e3, "N"],
};

/** A number that came of two others has no more digits than these are sure of. */
const DIGITS = 15;

const NUMBER = /^([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)\s*(.*)$/i;

/** What was typed, in the unit that is wanted; or why it cannot be, in words. */
export function typedIn(typed: string, { unit, si, dimension }: Measured): number | string {
    const text = typed.trim().replace(/\u2212/g, "-").replace(/^([+-]?\d+),(\d+)/, "$1.$2");
    const wanted = unit === "" ? "a number is wanted" : `a number of “${unit}” is wanted, or one with another unit behind it`;
    const [, number, behind] = NUMBER.exec(text) ?? [];
    const value = Number(number);
    if (number === undefined || !Number.isFinite(value)) return `“${typed.trim()}” is no number; ${wanted}`;
    if (behind === "" || behind === unit) return value;
    const other = UNITS[behind!];
    if (!other) return `“${typed.trim()}” is no number with a unit that is known here; ${wanted}`;
    if (other[1] !== dimension) return `${behind} is no unit of it; ${wanted}`;
    return Number(((value * other[0]) / si).toPrecision(DIGITS));
}
