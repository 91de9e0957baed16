// What lies over the picture of the mechanism.

import type { Document } from "../data/document.ts";
import type { Moment, Pair } from "../motion/motion.ts";
import { OF_A_FRAME } from "../motion/motion.ts";
import type { Camera } from "../picture/camera.ts";
import type { Wishes } from "../wishes.ts";

export interface Layer {
    readonly element: SVGGElement;
    /** There is another motion, or other wishes. */
    show(document: Document, wishes: Wishes, camera: Camera): void;
    draw(moment: Moment, camera: Camera): void;
    /** Where it has written something, which no label covers (pixels). */
    readonly written?: Box | undefined;
}

/** From the least to the greatest corner. */
export type Box = [Pair, Pair];

/** A path through places in metres, in the picture's units; undefined is a gap. */
export function through(places: readonly (Pair | undefined)[], camera: Camera): string {
    return joined(places.map((place) => place && camera.units(place)));
}

/** The same of places in a frame. */
export function throughWithin(places: readonly (Pair | undefined)[], camera: Camera): string {
    return joined(places.map((place) => place && [place[0] * camera.scale, place[1] * camera.scale]));
}

/** What is farther away than this is not drawn (units). */
const FAR = 1e5;

function joined(places: readonly (Pair | undefined)[]): string {
    let d = "";
    let before = false;
    for (const place of places) {
        const there = place !== undefined && Math.abs(place[0]) < FAR && Math.abs(place[1]) < FAR;
        if (there) d += `${before ? "L" : "M"}${place[0].toFixed(2)} ${place[1].toFixed(2)}`;
        before = there;
    }
    return d;
}

/** From the picture's units to its pixels. */
export function inUnits(camera: Camera): string {
    const [x, y] = camera.origin;
    return `translate(${x} ${y}) scale(${camera.pixels} ${-camera.pixels})`;
}

/** From a frame's coordinates, in units, to the picture's. */
export function inFrame({ frames }: Moment, frame: number, camera: Camera): string {
    const at = OF_A_FRAME * frame;
    const [x, y] = camera.units([frames[at]!, frames[at + 1]!]);
    const [c, s] = [Math.cos(frames[at + 2]!), Math.sin(frames[at + 2]!)];
    return `matrix(${c} ${s} ${-s} ${c} ${x} ${y})`;
}
