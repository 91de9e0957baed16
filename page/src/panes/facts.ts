// What there is to know of a declaration at a moment, as text.

import type { Document } from "../data/document.ts";
import type { Anchor, Column, ColumnKind, Declaration } from "../data/format.ts";
import { inUnit, lengthUnit, type LengthUnit } from "../data/lengths.ts";
import { anchor } from "../motion/meetings.ts";
import { OF_A_FRAME, accelerationOf, placeOf, velocityOf, type Moment } from "../motion/motion.ts";
import { six, told, withUnit } from "../numbers.ts";

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
    const declared = document.scene.declarations[declaration];
    const [title, kind] = declared ?? ["", ""];
    const unit = lengthUnit(document.page);
    if (!declared || moment.row < 0) return { title, kind, facts: [] };
    const frame = document.scene.frames.indexOf(declaration);
    const point = document.scene.points.find((point) => point.declaration === declaration);
    const facts = frame > 0 ? factsOfFrame(moment, frame, unit) : point ? factsOfPlace(moment, anchor(point), unit) : [];
    return { title, kind, facts: [...facts, ...(frame > 0 ? [] : factsOfColumns(document, declared, moment))] };
}

/** A length, or what is one by a time, in the text's unit. */
function factInLengths(name: string, value: number, unit: LengthUnit, by: string): Fact {
    const si = `${withUnit(six(value), `m${by}`)} (SI)`;
    return { name, text: withUnit(six(inUnit(value, unit)), unit.name + by), si };
}

function fact(name: string, value: number, unit: string): Fact {
    return { name, text: withUnit(six(value), unit) };
}

function factsOfFrame({ frames }: Moment, frame: number, unit: LengthUnit): Fact[] {
    const at = OF_A_FRAME * frame;
    const [phi, turning] = [frames[at + 2]!, frames[at + 5]!];
    return [
        factInLengths("x", frames[at]!, unit, ""),
        factInLengths("y", frames[at + 1]!, unit, ""),
        { ...fact("φ", (phi * 180) / Math.PI, "deg"), si: `${withUnit(six(phi), "rad")} (SI)` },
        fact("ω", turning, "rad/s"),
        fact("α", frames[at + 8]!, "rad/s^2"),
    ];
}

function factsOfPlace(moment: Moment, at: Anchor, unit: LengthUnit): Fact[] {
    const [x, y] = placeOf(moment, at);
    const [vx, vy] = velocityOf(moment, at);
    const [ax, ay] = accelerationOf(moment, at);
    return [
        factInLengths("x", x, unit, ""),
        factInLengths("y", y, unit, ""),
        factInLengths("|v|", Math.hypot(vx, vy), unit, "/s"),
        factInLengths("|a|", Math.hypot(ax, ay), unit, "/s^2"),
        factInLengths("vx", vx, unit, "/s"),
        factInLengths("vy", vy, unit, "/s"),
        factInLengths("ax", ax, unit, "/s^2"),
        factInLengths("ay", ay, unit, "/s^2"),
    ];
}

/** Columns of what it is: a measure and its derivatives, a trace's two, the coordinates that a joint brings along. */
function factsOfColumns({ table, motion }: Document, [name, kind]: Declaration, moment: Moment): Fact[] {
    const own = table.columns.map((column, place) => ({ column, place })).filter(({ column }) => belongs(column, name, kind));
    return own.slice(0, 9).map(({ column, place }) => {
        return { name: column.name, ...told(column, motion.value(place, moment.time)) };
    });
}

/** What stands behind the name of a declaration in those of its columns. */
const BEHIND: Record<string, { kinds: readonly (ColumnKind | undefined)[]; name: RegExp }> = {
    measure: { kinds: ["measure", "rate"], name: /^(\.d|\.dd)?$/ },
    trace: { kinds: ["measure", "rate"], name: /^\.[xy](\.d|\.dd)?$/ },
    joint: { kinds: ["joint", "reaction"], name: /^\.[a-z]+(\.d|\.dd)?$/ },
    driver: { kinds: ["reaction"], name: /^\.effort$/ },
    constraint: { kinds: ["reaction"], name: /^\.effort$/ },
    load: { kinds: ["reaction"], name: /^\.load$/ },
};

function belongs(column: Column, name: string, kind: string): boolean {
    const behind = BEHIND[kind];
    if (!behind || !column.name.startsWith(name) || !behind.kinds.includes(column.kind)) return false;
    return behind.name.test(column.name.slice(name.length));
}
