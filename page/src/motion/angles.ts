// Angles by which a linkage and a cam are judged.

import type { Anchor, Contact } from "../data/format.ts";
import { OF_A_FRAME, placeOf, velocityOf, within, type Moment, type Motion, type Pair } from "./motion.ts";

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

/** The middle of a follower's roller, or its tip; a face has none. */
export function centreOf({ follower, tip, roller }: Contact): Anchor | undefined {
    const at = roller?.centre ?? tip;
    return at && [follower, ...at];
}

/** Where a cam touches its follower, and how. */
export interface Touch {
    at: Pair;
    /** The direction of the common normal. */
    normal: Pair;
    /** How the follower's point moves that is there. */
    velocity: Pair;
    /** How it moves against the cam's. */
    slip: Pair;
}

/** None where nothing is known of it. */
export function touchOf(motion: Motion, moment: Moment, contact: Contact): Touch | undefined {
    const { cam, follower, tip, roller, face } = contact;
    const told = (at: Pair, normalAt: (slip: Pair) => Pair): Touch => {
        const velocity = velocityOf(moment, [follower, ...within(moment, follower, at)]);
        const [ux, uy] = velocityOf(moment, [cam, ...within(moment, cam, at)]);
        const slip: Pair = [velocity[0] - ux, velocity[1] - uy];
        return { at, normal: normalAt(slip), velocity, slip };
    };
    // a tip slides along the cam
    if (tip) return told(placeOf(moment, [follower, ...tip]), ([x, y]) => [-y, x]);
    if (roller) {
        const place = motion.table.place(roller.argument);
        const w = place === undefined ? NaN : motion.value(place, moment.time);
        const [c, s] = [Math.cos(w), Math.sin(w)];
        const [[ax, ay], [bx, by]] = roller.arms;
        const centre = placeOf(moment, [follower, ...roller.centre]);
        const at = placeOf(moment, [follower, roller.centre[0] + c * ax + s * bx, roller.centre[1] + c * ay + s * by]);
        return Number.isFinite(w) ? told(at, () => [at[0] - centre[0], at[1] - centre[1]]) : undefined;
    }
    if (!face) return undefined;
    const [[x, y], [dx, dy]] = face;
    const origin = placeOf(moment, [follower, x, y]);
    const ahead = placeOf(moment, [follower, x + dx, y + dy]);
    const along: Pair = [ahead[0] - origin[0], ahead[1] - origin[1]];
    const normal: Pair = [-along[1], along[0]];
    // the one place of the face where the cam neither leaves it nor enters it; where both turn alike any place tells as much
    const [vx, vy] = told(origin, () => normal).slip;
    const turning = moment.frames[OF_A_FRAME * follower + 5]! - moment.frames[OF_A_FRAME * cam + 5]!;
    const s = turning === 0 ? 0 : -(vx * normal[0] + vy * normal[1]) / turning;
    return told([origin[0] + s * along[0], origin[1] + s * along[1]], () => normal);
}

/** Below such a share of the speed at which it slides a follower dwells, and goes nowhere. */
const DWELLS = 1e-9;

/**
 * The pressure angle (0 … π/2), as `pressure_angle(joint, body)` has it: between the common normal and the velocity of the follower's
 * point at the contact. None in a dwell, where there is no way.
 */
export function pressure(motion: Motion, moment: Moment, contact: Contact): number | undefined {
    const touch = touchOf(motion, moment, contact);
    if (!touch) return undefined;
    const { normal, velocity, slip } = touch;
    const speed = Math.hypot(...velocity);
    if (!(speed > DWELLS * Math.hypot(...slip)) || Math.hypot(...normal) === 0) return undefined;
    return Math.atan2(Math.abs(cross(normal, velocity)), Math.abs(normal[0] * velocity[0] + normal[1] * velocity[1]));
}

function cross([ax, ay]: Pair, [bx, by]: Pair): number {
    return ax * by - ay * bx;
}

/** The pitch curve: the way of the follower's centre in the cam's frame, row by row. */
export function pitchCurve(motion: Motion, contact: Contact): Pair[] {
    const centre = centreOf(contact);
    if (!centre) return [];
    const moment = motion.moment();
    return Array.from({ length: motion.table.rows }, (_, row) => {
        motion.atRow(row, moment);
        return within(moment, contact.cam, placeOf(moment, centre));
    });
}
