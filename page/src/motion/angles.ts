// Angles by which a linkage and a cam are judged.

import type { Anchor } from "../data/format.ts";
import { placeOf, velocityOf, within, type Moment, type Motion, type Pair } from "./motion.ts";

/** The angle at a pin between the directions to two places (0 … π). */
export function angleAt(moment: Moment, one: Anchor, pin: Anchor, other: Anchor): number {
    const [x, y] = placeOf(moment, pin);
    const [ax, ay] = placeOf(moment, one);
    const [bx, by] = placeOf(moment, other);
    const cross = (ax - x) * (by - y) - (ay - y) * (bx - x);
    const dot = (ax - x) * (bx - x) + (ay - y) * (by - y);
    return Math.abs(Math.atan2(cross, dot));
}

/** The transmission angle (0 … π/2): the angle between two links at their pin, or what it lacks to half a turn. */
export function transmission(moment: Moment, one: Anchor, pin: Anchor, other: Anchor): number {
    const angle = angleAt(moment, one, pin, other);
    return Math.min(angle, Math.PI - angle);
}

/** A follower's contact with a cam: the centre of its roller, or its tip. */
export interface Contact {
    cam: number;
    centre: Anchor;
}

/** How the centre moves against the cam: along the pitch curve. */
export function alongPitch(moment: Moment, { cam, centre }: Contact): Pair {
    const place = placeOf(moment, centre);
    const [vx, vy] = velocityOf(moment, centre);
    const [ux, uy] = velocityOf(moment, [cam, ...within(moment, cam, place)]);
    return [vx - ux, vy - uy];
}

/** Below such a share of the speed along the pitch curve a follower dwells, and goes nowhere. */
const DWELLS = 1e-9;

/**
 * The pressure angle (0 … π/2): between the way of the follower's centre and the normal of the pitch curve. None in a dwell, where there
 * is no way, and where the centre rests on the cam.
 */
export function pressure(moment: Moment, contact: Contact): number | undefined {
    const [tx, ty] = alongPitch(moment, contact);
    const [vx, vy] = velocityOf(moment, contact.centre);
    const along = Math.hypot(tx, ty);
    if (!(Math.hypot(vx, vy) > DWELLS * along) || along === 0) return undefined;
    // the normal is the tangent, turned by a quarter
    return Math.atan2(Math.abs(vx * tx + vy * ty), Math.abs(vy * tx - vx * ty));
}

/** The pitch curve: the way of the follower's centre in the cam's frame, row by row. */
export function pitchCurve(motion: Motion, { cam, centre }: Contact): Pair[] {
    const moment = motion.moment();
    return Array.from({ length: motion.table.rows }, (_, row) => {
        motion.atRow(row, moment);
        return within(moment, cam, placeOf(moment, centre));
    });
}
