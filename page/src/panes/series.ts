// What can be plotted: the table's columns, and what the constructions give.

import type { Document } from "../data/document.ts";
import { printed } from "../data/table.ts";
import { HEAD } from "../elements.ts";
import { pressure, transmission } from "../motion/angles.ts";
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
    const { table, motion } = document;
    const { corner, contact } = wishes;
    if (name === TRANSMISSION && corner) {
        return computed(document, name, (moment) => transmission(moment, corner.one, corner.pin, corner.other));
    }
    if (name === PRESSURE && contact) return computed(document, name, (moment) => pressure(moment, contact) ?? NaN);
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

/** Columns of the table that are no body's, nor a derivative: what the text measures. */
export function measured({ scene, table }: Document): string[] {
    const bodies = bodyColumns(scene);
    return table.columns.map(({ name }) => name).filter((name) => name !== "t" && !bodies.has(name) && !/\.d{1,2}$/.test(name) && !name.endsWith(".u"));
}

function bodyColumns({ frames, declarations }: Document["scene"]): Set<string> {
    const names = frames.slice(1).map((declaration) => declarations[declaration]?.[0] ?? "");
    return new Set(names.flatMap((name) => ["x", "y", "phi"].map((part) => `${name}.${part}`)));
}

/** All that can be chosen, in groups. */
export function entries(document: Document, wishes: Wishes): [string, string][] {
    const names = document.table.columns.map(({ name }) => name);
    const measures = measured(document);
    const own = new Set(measures.flatMap((name) => [name, `${name}.d`, `${name}.dd`]));
    const group = (head: string, names: string[]): [string, string][] => {
        return names.length > 0 ? [[HEAD, head], ...names.map((name): [string, string] => [name, name])] : [];
    };
    const constructions = [...(wishes.corner ? [TRANSMISSION] : []), ...(wishes.contact ? [PRESSURE] : [])];
    return [
        ["t", "t"],
        ...group("measures", names.filter((name) => own.has(name))),
        ...group("constructions", constructions),
        ...group("coordinates", names.filter((name) => name !== "t" && !own.has(name))),
    ];
}

/** A range with some air around it. */
export function around(least: number, greatest: number): Pair {
    if (!Number.isFinite(least) || !Number.isFinite(greatest)) return [0, 1];
    const size = Math.max(Math.abs(least), Math.abs(greatest));
    // what varies by rounding alone is a straight line
    const air = greatest - least > 1e-9 * size ? 0.06 * (greatest - least) : 0.1 * size || 1;
    return [least - air, greatest + air];
}
