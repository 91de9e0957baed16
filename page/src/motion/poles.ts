// Instant centres: where two bodies have the same velocity.

import { OF_A_FRAME, within, type Moment, type Motion, type Pair } from "./motion.ts";

/** Below such a share of the speeds at play two bodies turn alike, and their pole is at infinity. */
const TURN_ALIKE = 1e-9;

/** The instant centre of two frames at a moment; none where they do not turn against each other. */
export function pole({ frames }: Moment, one: number, other: number): Pair | undefined {
    const a = OF_A_FRAME * one;
    const b = OF_A_FRAME * other;
    const [ax, ay, aw] = [frames[a]!, frames[a + 1]!, frames[a + 5]!];
    const [bx, by, bw] = [frames[b]!, frames[b + 1]!, frames[b + 5]!];
    const w = aw - bw;
    if (!(Math.abs(w) > TURN_ALIKE * Math.max(Math.abs(aw), Math.abs(bw), Number.MIN_VALUE))) return undefined;
    // v_a + w_a ẑ×(p - a) = v_b + w_b ẑ×(p - b), for p
    const dx = frames[a + 3]! - frames[b + 3]! + aw * ay - bw * by;
    const dy = frames[a + 4]! - frames[b + 4]! - aw * ax + bw * bx;
    return [(-dy) / w, dx / w];
}

/** The paths of the pole of two frames in each of them, row by row; gaps are undefined. */
export interface Polodes {
    one: (Pair | undefined)[];
    other: (Pair | undefined)[];
}

export function polodes(motion: Motion, one: number, other: number): Polodes {
    const moment = motion.moment();
    const paths: Polodes = { one: [], other: [] };
    for (let row = 0; row < motion.table.rows; row++) {
        motion.atRow(row, moment);
        const at = pole(moment, one, other);
        paths.one.push(at && within(moment, one, at));
        paths.other.push(at && within(moment, other, at));
    }
    return paths;
}
