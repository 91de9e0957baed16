// What can be plotted: the table's columns, and what the constructions give.

import type { Document } from "../data/document.ts";
import { printed } from "../data/table.ts";
import { HEAD } from "../elements.ts";
import { pressure, transmission } from "../motion/angles.ts";
import { anchors } from "../motion/meetings.ts";
import type { Anchor, Column } from "../data/format.ts";
import { evenTimes } from "../layers/traces.ts";
import type { Moment, Pair } from "../motion/motion.ts";
import { six, told } from "../numbers.ts";
import type { Wishes } from "../wishes.ts";

/** A row of numbers in a unit, one for each row of the table; NaN is a gap. */
export interface Series {
    name: string;
    unit: string;
    values: Float64Array;
    /** Its value at a moment. */
    at(moment: Moment): number;
    /** The same in SI, as text. */
    si(moment: Moment): string;
}

export const TRANSMISSION = "transmission angle";
export const PRESSURE = "pressure angle";

const DEGREES = 180 / Math.PI;

/** The series of a name, if there is one. */
export function seriesOf(document: Document, wishes: Wishes, name: string): Series | undefined {
    const { table, motion, scene } = document;
    const { corner } = wishes;
    const places = corner && anchors(scene, [corner.one, corner.pin, corner.other]);
    if (name === TRANSMISSION && places) {
        const [one, pin, other] = places as [Anchor, Anchor, Anchor];
        return computed(document, name, (moment) => transmission(moment, one, pin, other));
    }
    const contact = wishes.contact === undefined ? undefined : scene.contacts[wishes.contact];
    if (name === PRESSURE && contact) return computed(document, name, (moment) => pressure(motion, moment, contact) ?? NaN);
    const place = table.place(name);
    if (place === undefined) return undefined;
    const column = table.columns[place]!;
    const values = table.values[place]!.map((value) => printed(column, value));
    const value = ({ time }: Moment) => motion.value(place, time);
    return { name, unit: column.unit, values, at: (moment) => printed(column, value(moment)), si: (moment) => told(column, value(moment)).si };
}

/** An angle that is no column, in degrees. */
function computed({ motion, table }: Document, name: string, of: (moment: Moment) => number): Series {
    const moment = motion.moment();
    const values = Float64Array.from({ length: table.rows }, (_, row) => of(motion.atRow(row, moment)) * DEGREES);
    const si = (moment: Moment) => `${six(of(moment))} rad (SI)`;
    return { name, unit: "deg", values, at: (moment) => of(moment) * DEGREES, si };
}

/** What the text measures and traces. */
export function measured({ table }: Document): string[] {
    return table.columns.filter(({ kind }) => kind === "measure").map(({ name }) => name);
}

/** All that can be chosen, in groups. */
export function entries(document: Document, wishes: Wishes): [string, string][] {
    const { columns } = document.table;
    const isMeasured = ({ kind }: Column) => kind === "measure" || kind === "rate";
    const names = (which: (column: Column) => boolean) => columns.filter(which).map(({ name }) => name);
    const group = (head: string, names: string[]): [string, string][] => {
        return names.length > 0 ? [[HEAD, head], ...names.map((name): [string, string] => [name, name])] : [];
    };
    const constructions = [...(wishes.corner ? [TRANSMISSION] : []), ...(wishes.contact === undefined ? [] : [PRESSURE])];
    return [
        ["t", "t"],
        ...group("measures", names(isMeasured)),
        ...group("constructions", constructions),
        ...group("forces", names(({ kind }) => kind === "reaction")),
        ...group("coordinates", names((column) => column.kind !== "time" && column.kind !== "reaction" && !isMeasured(column))),
    ];
}

/** An axis has so many ticks at least. */
const FEWEST_TICKS = 3;

/** Ticks of an axis at even steps, about so many. */
export function ticks(least: number, greatest: number, about: number): number[] {
    let all: number[] = [];
    for (let parts = Math.max(FEWEST_TICKS, about); all.length < FEWEST_TICKS && parts < 30; parts *= 1.3) all = evenTimes(least, greatest, parts);
    return all;
}

/** A range with some air around it. */
export function around(least: number, greatest: number): Pair {
    if (!Number.isFinite(least) || !Number.isFinite(greatest)) return [0, 1];
    const size = Math.max(Math.abs(least), Math.abs(greatest));
    // what varies by rounding alone is a straight line
    const air = greatest - least > 1e-9 * size ? 0.06 * (greatest - least) : 0.1 * size || 1;
    return [least - air, greatest + air];
}
