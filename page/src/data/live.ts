// What a page is told by a program that runs: JSON, and behind it the table's columns as they are in memory (`src/live/answer.rs`).

import type { Page, Scene } from "./format.ts";
import type { Document } from "./document.ts";
import { Motion } from "../motion/motion.ts";
import { Table } from "./table.ts";

/** A param, or a coordinate of one that is a point. */
export interface Knob {
    name: string;
    /** In which it is set; empty for a pure number. */
    unit: string;
    /** One of that unit in SI, and the SI unit of its dimension. */
    si: number;
    dimension: string;
    /** By the text and the options of the command, in that unit. */
    value: number;
    /** What the command sets it to, if it does. */
    held: string | null;
    /** What the text says, where that is more than a number. */
    formula: string | null;
    /** What that formula, or what one of several copies, is with what is set. */
    now: number | null;
    /** The one of all copies of a part, where it is of a single copy. */
    of: string | null;
    /** Whether it says how often something is there, which only whole numbers do. */
    whole: boolean;
    /** What stands in its place in the file; null where another file says it. */
    text: string | null;
    /** Where that is, in words. */
    where: string | null;
}

/** An input. */
export interface Jog {
    name: string;
    /** In which its formula writes it; empty for a pure number. */
    unit: string;
    /** One of that unit in SI, and the SI unit of its dimension. */
    si: number;
    dimension: string;
    formula: string;
}

/** A body that turns as a driver says: by an input, or by time alone. */
export interface Crank {
    frame: number;
    /** Around which place of it (m). */
    pivot: [number, number];
    input: string | null;
    /** How its angle changes with the input at the first time [rad per SI unit of the input]; nothing without one. */
    rate: number | null;
}

export interface Told {
    version: number;
    /** What is wrong with the text, as it is printed; nothing is to be shown of it. Where the text is right, with its params. */
    wrong?: string;
    /** The question was given up. */
    superseded?: boolean;
    /** Whether there is a picture of the moment that was asked for. */
    glimpse?: boolean;
    /** How far inputs got by hand, and what is to be said of that. */
    jog?: { reached: [name: string, value: number][]; said: string | null };
    knobs?: Knob[];
    jogs?: Jog[];
    cranks?: Crank[];
}

export interface Answer {
    live: Told;
    /** The page, of an answer that has one. */
    page: Page | undefined;
    /** What there is to draw, of an answer that has a moment. */
    scene: Scene | undefined;
    columns: Float64Array[];
}

/** The answer in some bytes. */
export function answerOf(bytes: ArrayBuffer): Answer {
    const length = new DataView(bytes).getUint32(0, true);
    const page = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length))) as Partial<Page> & { live: Told };
    const numbers = new Float64Array(bytes, 4 + length);
    const { live } = page;
    const rows = live.jog || live.glimpse ? Math.min(1, numbers.length) : (page.variants?.[0]?.rows ?? 0);
    const count = rows === 0 ? 0 : numbers.length / rows;
    const columns = Array.from({ length: count }, (_, k) => numbers.subarray(k * rows, (k + 1) * rows));
    return { live, page: page.variants ? (page as Page) : undefined, scene: page.scene, columns };
}

/** What is shown of an answer that has a page. */
export function documentOf({ columns }: Answer, page: Page): Document {
    const { scene } = page;
    const { results, messages, edges, drawn, named = [] } = page.variants[0]!;
    // behind those of the table are the values of inputs
    const own = columns.slice(0, page.columns.length);
    const table = new Table(page.columns, own.length > 0 ? own : page.columns.map(() => new Float64Array(0)));
    return { page, variant: 0, scene, table, motion: new Motion(scene, table, edges, drawn), results, messages, named };
}

/** What is shown of a moment: the same, of one row; where params are others, with a scene of its own. */
export function momentOf({ columns, scene = undefined }: Answer, of: Document): Document | undefined {
    const drawn = scene ?? of.scene;
    // a mechanism of other bodies has other columns, which are told with its motion
    if (columns.length !== of.table.columns.length || drawn.frames.length !== of.scene.frames.length) return undefined;
    const table = new Table(of.table.columns, columns);
    return { ...of, scene: drawn, table, motion: new Motion(drawn, table, []) };
}
