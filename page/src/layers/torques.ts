// A torque as an arc with a head about a place.

import type { Pair } from "../motion/motion.ts";

/** Where an arc begins and where its head does, counter-clockwise. */
const TURN = [-0.75 * Math.PI, 0.7 * Math.PI] as const;
/** The head: its length and half its width, as parts of the radius. */
const HEAD = [0.36, 0.16] as const;
/** What has a smaller radius (pixels) is not drawn. */
const LEAST = 1.5;

/** Clockwise where the radius is below zero. It goes back on itself, so that nothing is between it and its chord. */
export function arc([x, y]: Pair, radius: number): string {
    const size = Math.abs(radius);
    if (!(size >= LEAST)) return "";
    const place = (by: number, angle: number) =>
        `${(x + radius * by * Math.cos(angle)).toFixed(1)} ${(y - size * by * Math.sin(angle)).toFixed(1)}`;
    const [[from, to], [long, wide]] = [TURN, HEAD];
    const [start, end, round] = [place(1, from), place(1, to), `A${size.toFixed(1)} ${size.toFixed(1)} 0 1`];
    const [sweep, back] = radius < 0 ? [1, 0] : [0, 1];
    const head = `M${place(1, to + long)}L${place(1 + wide, to)}L${place(1 - wide, to)}Z`;
    return `M${start}${round} ${sweep} ${end}${round} ${back} ${start}${head}`;
}
