// Velocities and accelerations as arrows, each kind to one scale for the whole motion.

import type { Document } from "../data/document.ts";
import type { Anchor } from "../data/format.ts";
import { METRE, inUnit, lengthUnit, type LengthUnit } from "../data/lengths.ts";
import { svg } from "../elements.ts";
import { anchor, meetings } from "../motion/meetings.ts";
import { accelerationOf, placeOf, velocityOf, type Moment, type Motion, type Pair } from "../motion/motion.ts";
import { set, short } from "../numbers.ts";
import type { Camera } from "../picture/camera.ts";
import type { Wishes } from "../wishes.ts";
import type { Layer } from "./layer.ts";
import { evenStep } from "./traces.ts";

/** The longest arrow, in parts of the picture's smaller side. */
const LONGEST = 0.22;
/** A head's length and half its width (pixels). */
const HEAD: Pair = [11, 4];
/** What the head of a velocity is larger: an acceleration that lies on it is seen on it. */
const WIDER = 1.5;
/** More arrows than this hide the mechanism. */
const MOST = 80;
/** Rows that are looked at for the greatest. */
const LOOKS = 200;

interface Kind {
    name: "velocity" | "acceleration";
    /** What stands behind the unit of lengths. */
    per: string;
    of: (moment: Moment, anchor: Anchor) => Pair;
    greatest: number;
}

export class Vectors implements Layer {
    readonly element = svg("g", { class: "vectors", "aria-hidden": "true" });
    private kinds: Kind[] = [];
    private unit: LengthUnit = METRE;
    private arrows: { at: Anchor; kind: Kind; path: SVGPathElement }[] = [];
    private legend: { kind: Kind; path: SVGPathElement; text: SVGTextElement }[] = [];

    show(document: Document, wishes: Wishes): void {
        const { scene, motion, page } = document;
        this.unit = lengthUnit(page);
        const asked = [...wishes.vectorsAt];
        // one of the points that meet stands for all
        if (wishes.vectors) asked.push(...meetings(motion).map((points) => points.find((point) => scene.points[point]!.frame > 0) ?? -1));
        const moving = [...new Set(asked)].filter((point) => (scene.points[point]?.frame ?? 0) > 0).slice(0, MOST);
        const anchors = moving.map((point) => anchor(scene.points[point]!));
        this.kinds = kinds(motion, anchors);
        this.arrows = this.kinds.flatMap((kind) => {
            return anchors.map((at) => ({ at, kind, path: svg("path", { class: `arrow-of-${kind.name}` }) }));
        });
        this.legend = this.kinds.map((kind) => {
            return { kind, path: svg("path", { class: `arrow-of-${kind.name}` }), text: svg("text", { class: "legend" }) };
        });
        this.element.replaceChildren(
            ...this.arrows.map(({ path }) => path),
            ...(anchors.length > 0 ? this.legend.flatMap(({ path, text }) => [path, text]) : []),
        );
    }

    draw(moment: Moment, camera: Camera): void {
        const longest = LONGEST * Math.min(camera.width, camera.height);
        for (const { at, kind, path } of this.arrows) {
            const [x, y] = camera.pixel(placeOf(moment, at));
            const [vx, vy] = kind.of(moment, at);
            const scale = longest / kind.greatest;
            path.setAttribute("d", arrow([x, y], [x + scale * vx, y - scale * vy], kind.name === "acceleration", camera.grain));
        }
        this.legend.forEach(({ kind, path, text }, k) => {
            const { grain, height } = camera;
            // of the text's unit it is a round number
            const value = evenStep(inUnit((kind.greatest * 60 * grain) / longest, this.unit));
            const y = height - (16 + 22 * k) * grain;
            const to = 14 * grain + (value * longest) / inUnit(kind.greatest, this.unit);
            path.setAttribute("d", arrow([14 * grain, y], [to, y], kind.name === "acceleration", grain));
            text.setAttribute("x", String(to + 9 * grain));
            text.setAttribute("y", String(y + 5 * grain));
            text.textContent = `${kind.name} ${short(value)} ${set(this.unit.name + kind.per)}`;
        });
    }
}

function kinds(motion: Motion, anchors: Anchor[]): Kind[] {
    const all: Kind[] = [
        { name: "velocity", per: "/s", of: velocityOf, greatest: 0 },
        { name: "acceleration", per: "/s^2", of: accelerationOf, greatest: 0 },
    ];
    const moment = motion.moment();
    const rows = motion.table.rows;
    const step = Math.max(1, Math.floor(rows / LOOKS));
    for (let row = 0; row < rows; row += step) {
        motion.atRow(row, moment);
        for (const kind of all) {
            for (const at of anchors) kind.greatest = Math.max(kind.greatest, Math.hypot(...kind.of(moment, at)) || 0);
        }
    }
    return all.filter(({ greatest }) => greatest > 0);
}

/** An arrow; one of an acceleration has a second head, so that colour is not all that tells them apart. */
export function arrow([x, y]: Pair, [tx, ty]: Pair, twice: boolean, grain: number): string {
    const length = Math.hypot(tx - x, ty - y);
    if (!(length > 1)) return "";
    const [ux, uy] = [(tx - x) / length, (ty - y) / length];
    const size = Math.min((twice ? 1 : WIDER) * grain, length / (2 * HEAD[0]));
    const [long, wide] = [HEAD[0] * size, HEAD[1] * size];
    const at = (back: number, aside: number) => `${(tx - back * ux - aside * uy).toFixed(1)} ${(ty - back * uy + aside * ux).toFixed(1)}`;
    const head = (from: number) => `M${at(from, 0)}L${at(from + long, wide)}L${at(from + long, -wide)}Z`;
    return `M${x.toFixed(1)} ${y.toFixed(1)}L${at(long, 0)}${head(0)}${twice ? head(0.8 * long) : ""}`;
}
