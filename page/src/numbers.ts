// Numbers as a reader sees them: six digits, a decimal point, the unit written in the file.

import type { Column } from "./data/format.ts";
import { printed } from "./data/table.ts";

/** Six digits, always as many, so that nothing dances while it moves. */
export function six(value: number): string {
    if (!Number.isFinite(value)) return "–";
    if (value === 0) return "0";
    const size = Math.abs(value);
    const text = size >= 1e-3 && size < 999999.5 ? value.toPrecision(6) : value.toExponential(5);
    return text.replace(/^-/, "\u2212");
}

/** As few digits as say it, six at most: for what stands still. */
export function short(value: number): string {
    return Number.isFinite(value) ? String(Number(value.toPrecision(6))).replace(/^-/, "\u2212") : "–";
}

/** A unit as it is set: no unit for a pure number. */
export function set(unit: string): string {
    return unit === "1" ? "" : unit.replace(/\^2/g, "²").replace(/\^3/g, "³").replace(/\*/g, "·");
}

/** A number with its unit. */
export function withUnit(number: string, unit: string): string {
    const word = set(unit);
    return word ? `${number} ${word}` : number;
}

const IN_SI: Record<string, string> = {
    ...Object.fromEntries(["mm", "cm", "um", "µm", "km", "in", "ft"].map((unit) => [unit, "m"])),
    ...Object.fromEntries(["ms", "us", "µs", "min", "h"].map((unit) => [unit, "s"])),
    ...Object.fromEntries(["deg", "rev", "mrad"].map((unit) => [unit, "rad"])),
    rpm: "rad/s",
    Hz: "1/s",
};

/** The SI unit of a unit. */
export function siUnit(unit: string): string {
    return unit.replace(/[\p{L}µ]+/gu, (word) => IN_SI[word] ?? word);
}

/** A value of a column (SI), as it is told; and in SI. */
export function told(column: Column, value: number): { text: string; si: string } {
    const unit = column.scale ? siUnit(column.unit) : column.unit;
    return { text: withUnit(six(printed(column, value)), column.unit), si: `${withUnit(six(value), unit)} (SI)` };
}
