// Taking hold of what is drawn: a crank, by the angle around its pivot; a point that a param of the file is.

import type { Document } from "../data/document.ts";
import type { Told } from "../data/live.ts";
import { unitOfLength } from "../data/lengths.ts";
import { OF_A_FRAME, placeOf, type Moment, type Pair } from "../motion/motion.ts";
import { Leash } from "./leash.ts";

/** Something in the hand. */
export interface Hold {
    /** The hand is at another place (m), in a picture whose pixels are so large (m). */
    move(to: Pair, pixel: number): void;
    /** It opens. */
    end?(): void;
}

/** What the picture asks of a hand. */
export interface Grasp {
    /** A body, if it can be turned. */
    body(frame: number, at: Pair, moment: Moment): Hold | undefined;
    point(name: string): Hold | undefined;
    /** What can be moved, and where it is (m). */
    points(): readonly { name: string; at: Pair }[];
}

interface Deeds {
    crank(input: string, value: number): void;
    point(name: string, at: Pair): void;
    value(input: string): number;
    seek(time: number): void;
}

/** A coordinate of a point that is no part's. */
const OWN = /^[^.]+\.x$/;

/** A point of the drawing is where it is drawn to this part of the picture. */
const NEAR = 1e-3;

export class Hand implements Grasp {
    private told: Told | undefined;
    private document: Document | undefined;
    private drawn: { name: string; at: Pair; units: [string, string] }[] = [];
    /** A crank that is held, by its input. */
    private held: { frame: number; input: string; leash: Leash; isLetGo: boolean } | undefined;

    constructor(private readonly deeds: Deeds) {}

    /** There is another motion, with some params set as they were when it was asked for; by now a hand may have moved on. */
    offer(told: Told, document: Document, asked: ReadonlyMap<string, number>, now: ReadonlyMap<string, number>): void {
        this.told = told;
        this.document = document;
        this.drawn = drawnPoints(told, document, { asked, now }, this.drawn);
    }

    points(): readonly { name: string; at: Pair }[] {
        return this.drawn;
    }

    point(name: string): Hold | undefined {
        const drawn = this.drawn.find((point) => point.name === name);
        if (!drawn) return undefined;
        return {
            move: (to, pixel) => {
                drawn.at = to;
                const inUnits = to.map((value, k) => rounded(value, drawn.units[k]!, pixel)) as Pair;
                this.deeds.point(name, inUnits);
            },
        };
    }

    body(frame: number, at: Pair, moment: Moment): Hold | undefined {
        const crank = frame > 0 ? this.told?.cranks?.find((crank) => crank.frame === frame) : undefined;
        if (!crank) return undefined;
        const pivot = placeOf(moment, [frame, ...crank.pivot]);
        const angle = ([x, y]: Pair) => Math.atan2(y - pivot[1], x - pivot[0]);
        let before = angle(at);
        let turned = 0;
        const { input, rate } = crank;
        const begin = moment.frames[OF_A_FRAME * frame + 2]!;
        const from = moment.time;
        const leash = input !== null && rate !== null ? new Leash({ angle: begin, input: this.deeds.value(input) }, rate) : undefined;
        const held = leash && { frame, input: input!, leash, isLetGo: false };
        this.held = held;
        return {
            move: (to) => {
                const now = angle(to);
                turned += Math.atan2(Math.sin(now - before), Math.cos(now - before));
                before = now;
                if (leash) this.deeds.crank(input!, leash.pull(begin + turned));
                else this.seek(frame, begin + turned, from);
            },
            end: () => {
                // it still gets to where the hand was
                if (held) held.isLetGo = true;
                if (!leash?.isWaiting && this.held === held) this.held = undefined;
            },
        };
    }

    /** Where the program has brought everything for what inputs were asked to be, last or before; a crank that is not yet at the hand is led on. */
    stood(moment: Moment, reached: ReadonlyMap<string, number>, isLast: boolean): void {
        if (!this.held) return;
        const { frame, input, leash, isLetGo } = this.held;
        const next = leash.answer({ angle: moment.frames[OF_A_FRAME * frame + 2]!, input: reached.get(input) ?? NaN }, isLast);
        if (next !== undefined) this.deeds.crank(input, next);
        else if (isLetGo && isLast) this.held = undefined;
    }

    /** To the time near to another one at which a body has an angle. */
    private seek(frame: number, wanted: number, from: number): void {
        const { document } = this;
        const name = document?.scene.declarations[document.scene.frames[frame]!]?.[0];
        const angles = name === undefined ? undefined : document!.table.named(`${name}.phi`);
        if (!document || !angles) return;
        const { times } = document.table;
        const away = (row: number) => Math.abs(angles[row]! - wanted);
        let row = document.table.nearest(from);
        for (const step of [1, -1]) {
            while (row + step >= 0 && row + step < angles.length && away(row + step) < away(row)) row += step;
        }
        const next = row + 1 < angles.length && (angles[row + 1]! - wanted) * (angles[row]! - wanted) <= 0 ? row + 1 : row - 1;
        const span = (angles[next] ?? NaN) - angles[row]!;
        const part = Number.isFinite(span) && span !== 0 ? (wanted - angles[row]!) / span : 0;
        this.deeds.seek(times[row]! + Math.min(Math.max(part, 0), 1) * ((times[next] ?? times[row]!) - times[row]!));
    }
}

/** The params of the mechanism itself that are points (those of its parts are in frames that stand elsewhere), where something is drawn there at first; where nothing moves, those of before, so that none leaves a hand. */
function drawnPoints(
    { knobs = [] }: Told,
    { motion, scene, table }: Document,
    set: { asked: ReadonlyMap<string, number>; now: ReadonlyMap<string, number> },
    before: readonly { name: string }[],
): { name: string; at: Pair; units: [string, string] }[] {
    const first = table.rows > 0 ? motion.at(motion.from, motion.moment()) : undefined;
    const places = first && scene.points.map(({ frame, at }) => placeOf(first, [frame, ...at]));
    const size = Math.hypot(scene.extent[1][0] - scene.extent[0][0], scene.extent[1][1] - scene.extent[0][1]);
    const known = new Map(knobs.map((knob) => [knob.name, knob]));
    // of several copies each has its own place
    const ofAll = new Set(knobs.map(({ of }) => of));
    return knobs.flatMap((knob) => {
        const other = known.get(`${knob.name.slice(0, -1)}y`);
        if (!OWN.test(knob.name) || !other || knob.formula !== null || other.formula !== null || ofAll.has(knob.name)) return [];
        const units: [string, string] = [knob.unit || other.unit || "m", other.unit || knob.unit || "m"];
        const placeIn = (set: ReadonlyMap<string, number>) =>
            [knob, other].map(({ name, value }, k) => (set.get(name) ?? value) * unitOfLength(units[k]!)) as Pair;
        const name = knob.name.slice(0, -2);
        const drawn = placeIn(set.asked);
        const isNear = ([x, y]: Pair) => Math.hypot(x - drawn[0], y - drawn[1]) < NEAR * size;
        const isThere = places?.some(isNear) ?? before.some((point) => point.name === name);
        return isThere ? [{ name, at: placeIn(set.now), units }] : [];
    });
}

/** A length (m) in a unit, to the decade that is a tenth of a pixel at the most: a hand can tell no more. */
export function rounded(value: number, unit: string, pixel: number): number {
    const size = unitOfLength(unit);
    const decade = Math.floor(Math.log10(pixel / 10 / size));
    const inUnit = value / size;
    return decade < 0 ? Number(inUnit.toFixed(Math.min(-decade, 15))) : Math.round(inUnit / 10 ** decade) * 10 ** decade;
}
