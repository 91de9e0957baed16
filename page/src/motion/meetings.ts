// Points of several frames that are one place all the time: pins.

import type { Anchor, NamedPoint, Scene } from "../data/format.ts";
import { placeOf, type Motion } from "./motion.ts";

/** So near, in parts of the extent, is one place. */
const ONE_PLACE = 1e-6;
/** Rows that are looked at. */
const LOOKS = 7;

export function anchor({ frame, at }: NamedPoint): Anchor {
    return [frame, at[0], at[1]];
}

/** The places of points with these numbers; none if one of them is not there. */
export function anchors({ points }: Scene, numbers: readonly number[]): Anchor[] | undefined {
    const all = numbers.flatMap((number) => (points[number] ? [anchor(points[number])] : []));
    return all.length === numbers.length ? all : undefined;
}

/** The points' numbers, those of one place together, in the order of the first of each. */
export function meetings(motion: Motion): number[][] {
    const { points, extent } = motion.scene;
    const [[left, bottom], [right, top]] = extent;
    const grain = ONE_PLACE * (Math.hypot(right - left, top - bottom) || 1);
    const rows = motion.table.rows;
    const looks = rows === 0 ? [] : Array.from({ length: LOOKS }, (_, k) => Math.round((k * (rows - 1)) / (LOOKS - 1)));
    const moments = looks.map((row) => motion.atRow(row, motion.moment()));
    const places = points.map((point) => moments.map((moment) => placeOf(moment, anchor(point))));
    const together = (a: number, b: number) =>
        moments.length > 0 && places[a]!.every(([x, y], k) => Math.hypot(x - places[b]![k]![0], y - places[b]![k]![1]) < grain);
    // those that are near in the first look only are compared
    const cells = new Map<string, number[]>();
    const groups: number[][] = [];
    for (let k = 0; k < points.length; k++) {
        const [x, y] = places[k]![0] ?? [k, 0];
        const [cx, cy] = [Math.round(x / grain / 8), Math.round(y / grain / 8)];
        let found: number | undefined;
        for (let dx = -1; dx <= 1 && found === undefined; dx++) {
            for (let dy = -1; dy <= 1 && found === undefined; dy++) {
                found = cells.get(`${cx + dx} ${cy + dy}`)?.find((group) => together(groups[group]![0]!, k));
            }
        }
        if (found !== undefined) {
            groups[found]!.push(k);
            continue;
        }
        const key = `${cx} ${cy}`;
        const here = cells.get(key) ?? [];
        here.push(groups.length);
        cells.set(key, here);
        groups.push([k]);
    }
    return groups;
}
