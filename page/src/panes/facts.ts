// What there is to know of a declaration at a moment, as text.

import type { Document } from "../data/document.ts";
import { anchor } from "../motion/meetings.ts";
import { OF_A_FRAME, accelerationOf, placeOf, velocityOf, type Moment } from "../motion/motion.ts";
import { set, six, told, withUnit } from "../numbers.ts";

export interface Fact {
    name: string;
    text: string;
    /** In SI, where that is another text. */
    si?: string;
}

export interface Facts {
    title: string;
    kind: string;
    facts: Fact[];
}

export function factsOf(document: Document, declaration: number, moment: Moment): Facts {
    const [title, kind] = document.scene.declarations[declaration] ?? ["", ""];
    if (moment.row < 0) return { title, kind, facts: [] };
    const frame = document.scene.frames.indexOf(declaration);
    const point = document.scene.points.find((point) => point.declaration === declaration);
    const facts = frame > 0 ? factsOfFrame(moment, frame) : point ? factsOfPlace(moment, anchor(point)) : [];
    return { title, kind, facts: [...facts, ...(frame > 0 ? [] : factsOfColumns(document, title, moment))] };
}

function fact(name: string, value: number, unit: string): Fact {
    return { name, text: withUnit(six(value), unit) };
}

function factsOfFrame({ frames }: Moment, frame: number): Fact[] {
    const at = OF_A_FRAME * frame;
    const [phi, turning] = [frames[at + 2]!, frames[at + 5]!];
    return [
        fact("x", frames[at]!, "m"),
        fact("y", frames[at + 1]!, "m"),
        { ...fact("φ", (phi * 180) / Math.PI, "deg"), si: withUnit(six(phi), "rad") },
        fact("ω", turning, "rad/s"),
        fact("α", frames[at + 8]!, "rad/s^2"),
    ];
}

function factsOfPlace(moment: Moment, at: [number, number, number]): Fact[] {
    const [x, y] = placeOf(moment, at);
    const [vx, vy] = velocityOf(moment, at);
    const [ax, ay] = accelerationOf(moment, at);
    return [
        fact("x", x, "m"),
        fact("y", y, "m"),
        fact("|v|", Math.hypot(vx, vy), "m/s"),
        fact("|a|", Math.hypot(ax, ay), "m/s^2"),
        fact("vx", vx, "m/s"),
        fact("vy", vy, "m/s"),
        fact("ax", ax, "m/s^2"),
        fact("ay", ay, "m/s^2"),
    ];
}

/** Columns that are named after it: a measure and its derivatives, a trace's two, a contact's place. */
function factsOfColumns({ table, motion }: Document, name: string, moment: Moment): Fact[] {
    const own = table.columns.map((column, place) => ({ column, place })).filter(({ column }) => belongs(column.name, name));
    return own.slice(0, 9).map(({ column, place }) => {
        return { name: column.name, ...told(column, motion.value(place, moment.time)) };
    });
}

function belongs(column: string, name: string): boolean {
    if (!column.startsWith(name)) return false;
    return /^(\.(d|dd|x|y|u)|_x|_y|\.[xyu]\.(d|dd))?$/.test(column.slice(name.length));
}

/** A unit in words, for those who hear it. */
export function spokenUnit(unit: string): string {
    return set(unit) || "no unit";
}
