// The unit in which a text writes lengths: what is told beside the table is told in it.

import type { Page } from "./format.ts";

/** A unit of length: a number of metres times `times`, by `by`, is one of it. */
export interface LengthUnit {
    name: string;
    times: number;
    by: number;
}

export const METRE: LengthUnit = { name: "m", times: 1, by: 1 };
const UNITS: readonly LengthUnit[] = [
    METRE,
    { name: "mm", times: 1000, by: 1 },
    { name: "cm", times: 100, by: 1 },
    { name: "um", times: 1e6, by: 1 },
    { name: "km", times: 1, by: 1000 },
    { name: "in", times: 10000, by: 254 },
    { name: "ft", times: 10000, by: 3048 },
];

const units = new WeakMap<Page["texts"], LengthUnit>();

/** The unit that stands behind most numbers of the texts; metres where there is none. */
export function lengthUnit({ texts }: Page): LengthUnit {
    let unit = units.get(texts);
    if (!unit) {
        unit = mostUsed(texts.map(({ text }) => text));
        units.set(texts, unit);
    }
    return unit;
}

/** A number, then a unit that is a word of its own. */
const WRITTEN = /\d[ \t]*(mm|cm|um|km|in|ft|m)\b/g;

function mostUsed(texts: readonly string[]): LengthUnit {
    const counts = new Map<string, number>();
    for (const text of texts) {
        const code = text.replace(/\/\/.*/g, "");
        for (const [, name] of code.matchAll(WRITTEN)) counts.set(name!, (counts.get(name!) ?? 0) + 1);
    }
    const count = ({ name }: LengthUnit) => counts.get(name) ?? 0;
    return UNITS.reduce((best, unit) => (count(unit) > count(best) ? unit : best), METRE);
}

/** A length (m), or what is one by a time, in a unit. */
export function inUnit(value: number, { times, by }: LengthUnit): number {
    return (value * times) / by;
}

/** A unit of length in metres; 1 of what is none. */
export function unitOfLength(name: string): number {
    const unit = UNITS.find((unit) => unit.name === name);
    return unit ? unit.by / unit.times : 1;
}
