// The ways of points, with marks at equal times.

import type { Document } from "../data/document.ts";
import type { Anchor, Trace } from "../data/format.ts";
import { svg } from "../elements.ts";
import { anchor } from "../motion/meetings.ts";
import { short } from "../numbers.ts";
import { placeOf, type Moment, type Motion, type Pair } from "../motion/motion.ts";
import type { Camera } from "../picture/camera.ts";
import type { Wishes } from "../wishes.ts";
import { inUnits, through, type Layer } from "./layer.ts";

/** Marks on a way: about so many, at times that are 1, 2 or 5 of something. */
const MARKS = 12;
/** A way has so many places at least, as far as rows let it. */
const FINE = 400;

export class Traces implements Layer {
    readonly element = svg("g", { class: "traces", "aria-hidden": "true" });
    private readonly ways = svg("g");
    private readonly legend = svg("text", { class: "legend", "text-anchor": "end" });

    show(document: Document, wishes: Wishes, camera: Camera): void {
        this.ways.replaceChildren();
        this.element.replaceChildren();
        const { scene, motion, table } = document;
        if (table.rows < 2) return;
        const times = fine(table.times);
        const marks = evenTimes(motion.from, motion.to, MARKS);
        const points = [...wishes.traced].flatMap((point) => scene.points[point] ?? []);
        const ways: Way[] = [
            ...(wishes.traces ? scene.traces.map((trace) => wayOf(trace, motion)) : []),
            ...points.map((point) => ({ declaration: point.declaration, at: (moment: Moment) => placeOf(moment, anchor(point)) })),
        ];
        // each time once for all ways
        const moment = motion.moment();
        const along = (times: number[]): (Pair | undefined)[][] => {
            const places = ways.map((): (Pair | undefined)[] => []);
            for (const time of times) {
                motion.at(time, moment);
                ways.forEach((way, k) => places[k]!.push(way.at(moment)));
            }
            return places;
        };
        const [lines, dots] = [along(times), along(marks)];
        ways.forEach(({ declaration }, k) => {
            const dot = (at: Pair | undefined) => (at ? `${through([at], camera)}h0` : "");
            this.ways.append(
                svg("path", { class: "trace", d: through(lines[k]!, camera), "data-declaration": declaration }),
                svg("path", { class: "trace-marks", d: dots[k]!.map(dot).join("") }),
            );
        });
        if (ways.length === 0) return;
        const every = `every ${short(evenStep((motion.to - motion.from) / MARKS))} s`;
        this.legend.replaceChildren(svg("tspan", { class: "legend-mark" }, "●"), ` ${every}`);
        this.element.append(this.ways, this.legend);
    }

    draw(_: Moment, camera: Camera): void {
        this.ways.setAttribute("transform", inUnits(camera));
        const { width, height, grain } = camera;
        this.legend.setAttribute("x", String(width - 12 * grain));
        this.legend.setAttribute("y", String(height - 11 * grain));
    }
}

interface Way {
    declaration: number;
    at: (moment: Moment) => Pair | undefined;
}

function wayOf({ declaration, columns, frame, at, pose, mirrored }: Trace, motion: Motion): Way {
    if (columns === undefined) {
        const anchor: Anchor = [frame, ...(at ?? [0, 0])];
        return { declaration, at: (moment) => placeOf(moment, anchor) };
    }
    const places = ["x", "y"].map((part) => motion.table.place(`${columns}.${part}`));
    const [px, py, phi] = pose ?? [0, 0, 0];
    const [c, s] = [Math.cos(phi), Math.sin(phi)];
    const place = (moment: Moment): Pair | undefined => {
        const [x, y] = places.map((place) => (place === undefined ? NaN : motion.value(place, moment.time))) as Pair;
        if (!Number.isFinite(x + y)) return undefined;
        const up = mirrored ? -y : y;
        return placeOf(moment, [frame, px + c * x - s * up, py + s * x + c * up]);
    };
    return { declaration, at: place };
}

/** The rows' times, and times between them where they are few. */
function fine(times: Float64Array): number[] {
    const parts = Math.max(1, Math.ceil(FINE / (times.length - 1)));
    const all: number[] = [];
    for (let row = 0; row + 1 < times.length; row++) {
        for (let part = 0; part < parts; part++) all.push(times[row]! + (part / parts) * (times[row + 1]! - times[row]!));
    }
    all.push(times[times.length - 1]!);
    return all;
}

/** Times at equal steps of 1, 2 or 5 times a power of ten, about so many. */
export function evenTimes(from: number, to: number, about: number): number[] {
    const step = evenStep((to - from) / about);
    if (!(step > 0)) return [];
    const first = Math.ceil(from / step - 1e-9);
    const times: number[] = [];
    for (let k = first; k * step <= to + 1e-9 * step; k++) times.push(k * step);
    return times;
}

/** The least of 1, 2, 5 times a power of ten that is not below. */
export function evenStep(least: number): number {
    const power = 10 ** Math.floor(Math.log10(least));
    return [1, 2, 5, 10].map((times) => times * power).find((step) => step >= least * (1 - 1e-9)) ?? NaN;
}
