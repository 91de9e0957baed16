// What joints exert, loads and weights as arrows, all to one scale for the whole motion.

import type { Document } from "../data/document.ts";
import type { Anchor, ForceVector } from "../data/format.ts";
import { svg } from "../elements.ts";
import { OF_A_FRAME, placeOf, type Moment, type Motion, type Pair } from "../motion/motion.ts";
import { set, short } from "../numbers.ts";
import type { Camera } from "../picture/camera.ts";
import type { Wishes } from "../wishes.ts";
import type { Box, Layer } from "./layer.ts";
import { evenStep } from "./traces.ts";
import { arrow } from "./vectors.ts";

/** The longest arrow, in parts of the picture's smaller side. */
const LONGEST = 0.22;
/** Rows that are looked at for the greatest. */
const LOOKS = 200;
/** From this force on (N) it is told in kilonewtons. */
const KILO = 1e4;
/** What the legend takes above that of velocities (pixels). */
const LINE = 22;
const WIDE = 300;

const KINDS = ["reaction", "load", "weight"] as const;

type Kind = (typeof KINDS)[number];

export class Forces implements Layer {
    readonly element = svg("g", { class: "vectors forces", "aria-hidden": "true" });
    private arrows: { force: ForceVector; path: SVGPathElement }[] = [];
    private legend: { kind: Kind; path: SVGPathElement; text: SVGTextElement }[] = [];
    private motion: Motion | undefined;
    private greatest = 0;
    /** Lines below the legend. */
    private below = 0;
    written: Box | undefined;

    show({ scene, motion, table }: Document, wishes: Wishes): void {
        const forces = wishes.forces ? (scene.forces ?? []) : [];
        [this.motion, this.greatest] = [motion, 0];
        const moment = motion.moment();
        const step = Math.max(1, Math.floor(table.rows / LOOKS));
        for (let row = 0; row < table.rows && forces.length > 0; row += step) {
            motion.atRow(row, moment);
            for (const force of forces) this.greatest = Math.max(this.greatest, Math.hypot(...this.valueOf(force, moment)) || 0);
        }
        const drawn = this.greatest > 0 ? forces : [];
        this.below = wishes.vectors || wishes.vectorsAt.size > 0 ? 2 : 0;
        this.arrows = drawn.map((force) => ({ force, path: svg("path", { class: `force-${force.kind}` }) }));
        const kinds = KINDS.filter((kind) => drawn.some((force) => force.kind === kind)).reverse();
        this.legend = kinds.map((kind) => ({ kind, path: svg("path", { class: `force-${kind}` }), text: svg("text", { class: "legend" }) }));
        this.written = undefined;
        this.element.replaceChildren(
            ...this.arrows.map(({ path }) => path),
            ...this.legend.flatMap(({ path, text }) => [path, text]),
        );
    }

    draw(moment: Moment, camera: Camera): void {
        const { grain, height } = camera;
        const scale = (LONGEST * Math.min(camera.width, camera.height)) / this.greatest;
        for (const { force, path } of this.arrows) {
            const [x, y] = camera.pixel(placeOf(moment, force.at));
            const [fx, fy] = this.valueOf(force, moment);
            path.setAttribute("d", Number.isFinite(fx + fy) ? arrow([x, y], [x + scale * fx, y - scale * fy], false, grain) : "");
        }
        const [unit, size] = this.greatest >= KILO ? ["kN", 1e3] : ["N", 1];
        const value = evenStep((60 * grain) / (scale * size));
        this.legend.forEach(({ kind, path, text }, k) => {
            const y = height - (16 + LINE * (k + this.below)) * grain;
            const to = 14 * grain + value * size * scale;
            path.setAttribute("d", arrow([14 * grain, y], [to, y], false, grain));
            text.setAttribute("x", String(to + 9 * grain));
            text.setAttribute("y", String(y + 5 * grain));
            text.textContent = `${kind} ${short(value)} ${set(unit)}`;
        });
        const lines = this.below + this.legend.length;
        this.written = this.legend.length > 0 ? [[0, height - (6 + LINE * lines) * grain], [WIDE * grain, height]] : undefined;
    }

    /** What a force is at a moment (N). */
    private valueOf({ constant, columns, along, apart }: ForceVector, moment: Moment): Pair {
        if (constant) return constant;
        const of = (column: string) => this.at(column, moment.time);
        if (columns) return [of(columns[0]), of(columns[1])];
        if (along) {
            const [column, frame, [x, y]] = along;
            const phi = moment.frames[OF_A_FRAME * frame + 2]!;
            const [c, s, force] = [Math.cos(phi), Math.sin(phi), of(column)];
            return [force * (c * x - s * y), force * (s * x + c * y)];
        }
        const [column, from, to] = apart!;
        const [dx, dy] = between(moment, from, to);
        const force = of(column) / Math.hypot(dx, dy);
        return [force * dx, force * dy];
    }

    private at(column: string, time: number): number {
        const place = this.motion?.table.place(column);
        return place === undefined ? NaN : this.motion!.value(place, time);
    }
}

function between(moment: Moment, from: Anchor, to: Anchor): Pair {
    const [[fx, fy], [tx, ty]] = [placeOf(moment, from), placeOf(moment, to)];
    return [tx - fx, ty - fy];
}
