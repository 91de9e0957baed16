// What joints exert, loads and weights as arrows, torques as arcs, each to one scale for the whole motion.

import type { Document } from "../data/document.ts";
import type { Anchor, ForceVector, Torque } from "../data/format.ts";
import { svg } from "../elements.ts";
import { OF_A_FRAME, placeOf, type Moment, type Motion, type Pair } from "../motion/motion.ts";
import { set, short } from "../numbers.ts";
import type { Camera } from "../picture/camera.ts";
import type { Wishes } from "../wishes.ts";
import type { Box, Layer } from "./layer.ts";
import { arc } from "./torques.ts";
import { evenStep } from "./traces.ts";
import { arrow } from "./vectors.ts";

/** The longest arrow, in parts of the picture's smaller side. */
const LONGEST = 0.22;
/** The largest radius of a torque's arc, as a part of that. */
const LARGEST = 0.55;
/** Rows that are looked at for the greatest. */
const LOOKS = 200;
/** From this force on (N) it is told in kilonewtons, from this torque on (N·m) in kilonewton metres. */
const KILO = 1e4;
/** What the legend takes above that of velocities (pixels). */
const LINE = 22;
const WIDE = 300;

const KINDS = ["reaction", "load", "weight"] as const;

type Kind = (typeof KINDS)[number];

interface Line {
    kind: Kind;
    isTorque: boolean;
    path: SVGPathElement;
    text: SVGTextElement;
}

export class Forces implements Layer {
    readonly element = svg("g", { class: "vectors forces", "aria-hidden": "true" });
    private arrows: { force: ForceVector; path: SVGPathElement }[] = [];
    private arcs: { torque: Torque; path: SVGPathElement }[] = [];
    private legend: Line[] = [];
    private motion: Motion | undefined;
    private greatest = 0;
    private greatestTorque = 0;
    /** Lines below the legend. */
    private below = 0;
    written: Box | undefined;

    show({ scene, motion, table }: Document, wishes: Wishes): void {
        const forces = wishes.forces ? (scene.forces ?? []) : [];
        const torques = wishes.forces ? (scene.torques ?? []) : [];
        [this.motion, this.greatest, this.greatestTorque] = [motion, 0, 0];
        const moment = motion.moment();
        const step = Math.max(1, Math.floor(table.rows / LOOKS));
        for (let row = 0; row < table.rows && forces.length + torques.length > 0; row += step) {
            motion.atRow(row, moment);
            for (const force of forces) this.greatest = Math.max(this.greatest, Math.hypot(...this.valueOf(force, moment)) || 0);
            for (const torque of torques) this.greatestTorque = Math.max(this.greatestTorque, Math.abs(this.torqueOf(torque, moment)) || 0);
        }
        const drawn = this.greatest > 0 ? forces : [];
        const turning = this.greatestTorque > 0 ? torques : [];
        this.below = wishes.vectors || wishes.vectorsAt.size > 0 ? 2 : 0;
        this.arrows = drawn.map((force) => ({ force, path: pathOf(force.kind) }));
        this.arcs = turning.map((torque) => ({ torque, path: pathOf(torque.kind) }));
        this.legend = [...lines(drawn, false), ...lines(turning, true)];
        this.written = undefined;
        this.element.replaceChildren(
            ...this.arrows.map(({ path }) => path),
            ...this.arcs.map(({ path }) => path),
            ...this.legend.flatMap(({ path, text }) => [path, text]),
        );
    }

    draw(moment: Moment, camera: Camera): void {
        const { grain, height } = camera;
        const longest = LONGEST * Math.min(camera.width, camera.height);
        const scale = longest / this.greatest;
        for (const { force, path } of this.arrows) {
            const [x, y] = camera.pixel(placeOf(moment, force.at));
            const [fx, fy] = this.valueOf(force, moment);
            path.setAttribute("d", Number.isFinite(fx + fy) ? arrow([x, y], [x + scale * fx, y - scale * fy], false, grain) : "");
        }
        const round = (LARGEST * longest) / this.greatestTorque;
        for (const { torque, path } of this.arcs) {
            path.setAttribute("d", arc(camera.pixel(placeOf(moment, torque.at)), round * this.torqueOf(torque, moment)));
        }
        this.legend.forEach((line, k) => {
            const y = height - (16 + LINE * (k + this.below)) * grain;
            const end = line.isTorque ? this.tellTorque(line, y, round, grain) : this.tellForce(line, y, scale, grain);
            line.text.setAttribute("x", String(end + 9 * grain));
            line.text.setAttribute("y", String(y + 5 * grain));
        });
        const all = this.below + this.legend.length;
        this.written = this.legend.length > 0 ? [[0, height - (6 + LINE * all) * grain], [WIDE * grain, height]] : undefined;
    }

    /** A line of the legend: an arrow, which ends there. */
    private tellForce({ kind, path, text }: Line, y: number, scale: number, grain: number): number {
        const [unit, size] = this.greatest >= KILO ? ["kN", 1e3] : ["N", 1];
        const value = evenStep((60 * grain) / (scale * size));
        const to = 14 * grain + value * size * scale;
        path.setAttribute("d", arrow([14 * grain, y], [to, y], false, grain));
        text.textContent = `${kind} ${short(value)} ${set(unit)}`;
        return to;
    }

    /** The same with an arc. */
    private tellTorque({ kind, path, text }: Line, y: number, round: number, grain: number): number {
        const [unit, size] = this.greatestTorque >= KILO ? ["kN*m", 1e3] : ["N*m", 1];
        const value = evenStep((3.6 * grain) / (round * size));
        const radius = value * size * round;
        path.setAttribute("d", arc([14 * grain + radius, y], radius));
        text.textContent = `${kind} torque ${short(value)} ${set(unit)}`;
        return 14 * grain + 2 * radius;
    }

    /** What a torque is at a moment (N·m), counter-clockwise. */
    private torqueOf({ column, sign }: Torque, moment: Moment): number {
        return sign * this.at(column, moment.time);
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

function pathOf(kind: Kind): SVGPathElement {
    return svg("path", { class: `force-${kind}` });
}

/** Lines of the legend, from the lowest. */
function lines(drawn: readonly { kind: Kind }[], isTorque: boolean): Line[] {
    const kinds = KINDS.filter((kind) => drawn.some((one) => one.kind === kind)).reverse();
    return kinds.map((kind) => ({ kind, isTorque, path: pathOf(kind), text: svg("text", { class: "legend" }) }));
}

function between(moment: Moment, from: Anchor, to: Anchor): Pair {
    const [[fx, fy], [tx, ty]] = [placeOf(moment, from), placeOf(moment, to)];
    return [tx - fx, ty - fy];
}
