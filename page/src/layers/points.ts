// The named points: what is clicked, and their labels.

import { declareAlike, type Document } from "../data/document.ts";
import { svg } from "../elements.ts";
import { anchor, meetings } from "../motion/meetings.ts";
import { OF_A_FRAME, placeOf, type Moment, type Pair } from "../motion/motion.ts";
import type { Camera } from "../picture/camera.ts";
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
/** What the buttons of the view take (pixels). */
const CORNER: Pair = [44, 116];
/** Between one label and the next (pixels). */
const AIR = 3;
/** More labels than this say nothing. */
const MOST = 120;

export class Labels implements Layer {
    readonly element = svg("g", { class: "labels", "aria-hidden": "true" });
    private labels: Label[] = [];
    private document: Document | undefined;
    private shown = false;

    show(document: Document, wishes: Wishes): void {
        if (!wishes.labels) {
            this.element.replaceChildren();
            this.shown = false;
            return;
        }
        if (this.shown && this.document === document) return;
        [this.shown, this.document] = [true, document];
        this.labels = [...labelsOfPoints(document), ...labelsOfBodies(document)].slice(0, MOST);
        this.element.replaceChildren(...this.labels.map(({ text }) => text));
        for (const label of this.labels) {
            const { width, height } = label.text.getBBox();
            label.size = [width + 2 * AIR, height];
        }
    }

    draw(moment: Moment, camera: Camera): void {
        if (!this.shown) return;
        // buttons stand in the corner
        const taken: [Pair, Pair][] = [[[camera.width - CORNER[0], 0], [camera.width, CORNER[1]]]];
        const isInside = (from: Pair, to: Pair) => from[0] >= 0 && from[1] >= 0 && to[0] <= camera.width && to[1] <= camera.height;
        const free = (from: Pair, to: Pair) =>
            isInside(from, to) && !taken.some(([a, b]) => a[0] < to[0] && from[0] < b[0] && a[1] < to[1] && from[1] < b[1]);
        for (const label of this.labels) {
            const [x, y] = camera.pixel(label.at(moment));
            const box = (side: number): [Pair, Pair] => {
                const [dx, dy] = SIDES[side]!;
                const [width, height] = label.size;
                const left = x + dx * GAP + (dx - 1) * 0.5 * width;
                const top = y + dy * GAP + (dy - 1) * 0.5 * height;
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
