// The named points: what is clicked, and their labels.

import { declareAlike, type Document } from "../data/document.ts";
import type { Node } from "../data/format.ts";
import { svg } from "../elements.ts";
import { anchor, meetings } from "../motion/meetings.ts";
import { OF_A_FRAME, placeOf, type Moment, type Pair } from "../motion/motion.ts";
import type { Camera } from "../picture/camera.ts";
import { placed } from "../picture/figures.ts";
import { parsed, upright, written } from "../picture/path.ts";
import type { Wishes } from "../wishes.ts";
import type { Layer } from "./layer.ts";

/** The radius of what a pointer has to meet (pixels). */
const REACH = 9;

export class Points implements Layer {
    readonly element = svg("g", { class: "points" });
    private spots: { point: number; circle: SVGGElement }[] = [];
    private document: Document | undefined;

    show(document: Document): void {
        if (this.document === document) return;
        const before = this.document;
        this.document = document;
        if (declareAlike(before, document)) return;
        this.spots = document.scene.points.map(({ name, declaration, pin }, point) => {
            const circle = svg(
                "g",
                { class: "spot", "data-point": name, "data-declaration": declaration, "data-number": point },
                svg("circle", { class: "reach", r: REACH }),
                svg("circle", { class: pin ? "dot pin-dot" : "dot", r: pin ? 2.2 : 3.2 }),
            );
            return { point, circle };
        });
        this.element.replaceChildren(...this.spots.map(({ circle }) => circle));
    }

    light(lit: ReadonlySet<number>): void {
        for (const { point, circle } of this.spots) circle.classList.toggle("lit", lit.has(this.document!.scene.points[point]!.declaration));
    }

    draw(moment: Moment, camera: Camera): void {
        const points = this.document?.scene.points ?? [];
        for (const { point, circle } of this.spots) {
            const [x, y] = camera.pixel(placeOf(moment, anchor(points[point]!)));
            circle.setAttribute("transform", `translate(${x.toFixed(3)} ${y.toFixed(3)})`);
        }
    }
}

interface Label {
    text: SVGTextElement;
    /** Where it points to. */
    at: (moment: Moment) => Pair;
    size: Pair;
    /** Which of the places around it has. */
    side: number;
}

/** Around a place: right above first, then the other corners, then sides; in parts of the label's size beside a gap. */
const SIDES: readonly Pair[] = [[1, -1], [-1, -1], [1, 1], [-1, 1], [1, 0], [-1, 0], [0, -1], [0, 1]];
const GAP = 9;
/** What the buttons of the view take, and what is explained in the lower corners (pixels). */
const CORNER: Pair = [44, 152];
const LEGEND_OF_VECTORS: Pair = [350, 50];
const LEGEND_OF_TRACES: Pair = [150, 28];
/** Places on the line of an arrow that no label covers, and how far from them labels keep (pixels). */
const ON_ARROW = 9;
const BESIDE_ARROW = 4;
/** Between one label and the next (pixels). */
const AIR = 3;
/** More labels than this say nothing. */
const MOST = 120;

export class Labels implements Layer {
    readonly element = svg("g", { class: "labels", "aria-hidden": "true" });
    private labels: Label[] = [];
    private document: Document | undefined;
    private shown = false;
    private arrows: { node: Node; places: Pair[] }[] = [];
    private legends: { vectors: boolean; traces: boolean } = { vectors: false, traces: false };
    private measuredAt = 0;

    /** Beside others, which are drawn before. */
    constructor(private readonly others: readonly Layer[]) {}

    show(document: Document, wishes: Wishes, camera: Camera): void {
        this.legends = {
            vectors: wishes.vectors || wishes.vectorsAt.size > 0,
            traces: (wishes.traces && document.scene.traces.length > 0) || wishes.traced.size > 0,
        };
        if (!wishes.labels) {
            this.element.replaceChildren();
            this.shown = false;
            return;
        }
        if (this.shown && this.document === document) return;
        [this.shown, this.document] = [true, document];
        this.labels = [...labelsOfPoints(document), ...labelsOfBodies(document)].slice(0, MOST);
        this.element.replaceChildren(...this.labels.map(({ text }) => text));
        this.measure();
        this.measuredAt = camera.grain;
        this.arrows = document.scene.nodes.flatMap((node) => {
            const lines = node.shapes.filter(({ look }) => look === "arrow" || look === "arrow-head");
            return lines.length > 0 ? [{ node, places: lines.flatMap(({ d }) => this.along(written(upright(parsed(d), camera.scale)))) }] : [];
        });
    }

    private measure(): void {
        for (const label of this.labels) {
            const { width, height } = label.text.getBBox();
            label.size = [width + 2 * AIR, height];
        }
    }

    /** Places along a path. */
    private along(d: string): Pair[] {
        const path = svg("path", { d, class: "probe" });
        this.element.append(path);
        const length = path.getTotalLength();
        const places = Array.from({ length: ON_ARROW }, (_, k): Pair => {
            const { x, y } = path.getPointAtLength((k / (ON_ARROW - 1)) * length);
            return [x, y];
        });
        path.remove();
        return places;
    }

    /** Where arrows are now, as boxes. */
    private arrowBoxes(moment: Moment, camera: Camera): [Pair, Pair][] {
        const [left, top] = camera.origin;
        const air = BESIDE_ARROW * camera.grain;
        return this.arrows.flatMap(({ node, places }) => {
            const [c, s, x0, y0] = placed({ node }, moment, camera);
            return places.map(([x, y]): [Pair, Pair] => {
                const px = left + camera.pixels * (x0 + c * x - s * y);
                const py = top - camera.pixels * (y0 + s * x + c * y);
                return [[px - air, py - air], [px + air, py + air]];
            });
        });
    }

    draw(moment: Moment, camera: Camera): void {
        if (!this.shown) return;
        if (this.measuredAt !== camera.grain) this.measure();
        this.measuredAt = camera.grain;
        const { width, height, grain } = camera;
        // buttons stand in the corner
        const taken: [Pair, Pair][] = [[[width - CORNER[0], 0], [width, CORNER[1]]], ...this.arrowBoxes(moment, camera)];
        for (const { written } of this.others) if (written) taken.push(written);
        if (this.legends.vectors) taken.push([[0, height - LEGEND_OF_VECTORS[1] * grain], [LEGEND_OF_VECTORS[0] * grain, height]]);
        if (this.legends.traces) taken.push([[width - LEGEND_OF_TRACES[0] * grain, height - LEGEND_OF_TRACES[1] * grain], [width, height]]);
        const isInside = (from: Pair, to: Pair) => from[0] >= 0 && from[1] >= 0 && to[0] <= camera.width && to[1] <= camera.height;
        const free = (from: Pair, to: Pair) =>
            isInside(from, to) && !taken.some(([a, b]) => a[0] < to[0] && from[0] < b[0] && a[1] < to[1] && from[1] < b[1]);
        for (const label of this.labels) {
            const [x, y] = camera.pixel(label.at(moment));
            const box = (side: number): [Pair, Pair] => {
                const [dx, dy] = SIDES[side]!;
                const [width, height] = label.size;
                const left = x + dx * GAP * grain + (dx - 1) * 0.5 * width;
                const top = y + dy * GAP * grain + (dy - 1) * 0.5 * height;
                return [[left, top], [left + width, top + height]];
            };
            // where it was, if it can stay: labels that jump cannot be read
            const sides = [label.side, ...SIDES.keys()];
            const side = sides.find((side) => free(...box(side)));
            label.text.classList.toggle("hidden", side === undefined);
            if (side === undefined) continue;
            label.side = side;
            const [from, to] = box(side);
            taken.push([from, to]);
            label.text.setAttribute("x", (from[0] + AIR).toFixed(1));
            label.text.setAttribute("y", (to[1] - 0.22 * label.size[1]).toFixed(1));
        }
    }
}

/** The longest label (characters). */
const LONGEST = 24;

export function shortened(name: string): string {
    const letters = [...name];
    return letters.length > LONGEST ? `${letters.slice(0, LONGEST - 1).join("")}…` : name;
}

function label(name: string, kind: string, at: Label["at"]): Label {
    return { text: svg("text", { class: `label label-${kind}` }, shortened(name)), at, size: [0, 0], side: 0 };
}

function labelsOfPoints({ scene, motion }: Document): Label[] {
    return meetings(motion).map((points) => {
        const first = scene.points[points[0]!]!;
        const names = new Set(points.map((point) => scene.points[point]!.name.split(".").pop()!));
        return label([...names].join(" · "), "point", (moment) => placeOf(moment, anchor(first)));
    });
}

function labelsOfBodies({ scene }: Document): Label[] {
    return scene.frames.slice(1).map((declaration, k) => {
        const frame = k + 1;
        const points = scene.points.filter((point) => point.frame === frame);
        const middle = (axis: 0 | 1) => points.reduce((sum, { at }) => sum + at[axis], 0) / (points.length || 1);
        const [x, y] = [middle(0), middle(1)];
        const name = scene.declarations[declaration]![0];
        return label(name, "body", (moment) =>
            points.length > 0 ? placeOf(moment, [frame, x, y]) : [moment.frames[OF_A_FRAME * frame]!, moment.frames[OF_A_FRAME * frame + 1]!],
        );
    });
}
