// The mechanism on a canvas: for so many bodies that an SVG would be slow. Looks are those of the style sheet, read once.

import type { Scene } from "../data/format.ts";
import { html, svg } from "../elements.ts";
import type { Moment, Pair } from "../motion/motion.ts";
import type { Camera } from "./camera.ts";
import type { Drawing } from "./drawing.ts";
import type { Command } from "./path.ts";
import { figures, placed, stretched, type Figure } from "./figures.ts";

interface Style {
    fill: string | undefined;
    stroke: string | undefined;
    width: number;
    dash: number[];
    /** What is left of it for the smallest shapes. */
    spot?: Style;
}

interface Drawn {
    figure: Figure;
    shapes: { path: Path2D; look: string; reach: number }[];
    /** How its shapes are drawn, looked up once; none since looks or sizes changed. */
    dress: { mark: string; styles: Style[] } | undefined;
}

/** What reaches less far is a spot of one colour (pixels). */
const SPOT = 4;

/** Pixels of the screen in one of the picture's, at the most: more cost time that nobody sees. */
const SHARPEST = 2;

export class CanvasDrawing implements Drawing {
    readonly element = html("canvas", { class: "mechanism", "aria-hidden": "true" });
    private readonly context = this.element.getContext("2d", { willReadFrequently: true })!;
    private readonly drawn: Drawn[];
    private readonly styles = new Map<string, Style>();
    private lit: ReadonlySet<number> = new Set();
    private wrong: ReadonlySet<number> = new Set();
    private behind: readonly Moment[] = [];
    private sharp = 1;

    constructor(scene: Scene, camera: Camera) {
        this.drawn = figures(scene, camera).map((figure) => {
            const shapes = figure.shapes.map(({ look, d, path }) => ({ path: new Path2D(d), look, reach: reach(path) }));
            return { figure, shapes, dress: undefined };
        });
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.forget());
    }

    renew(): boolean {
        return false;
    }

    look(camera: Camera): void {
        this.sharp = Math.min(devicePixelRatio, SHARPEST);
        this.element.width = Math.round(camera.width * this.sharp);
        this.element.height = Math.round(camera.height * this.sharp);
        this.forget();
    }

    /** Looks or sizes are others. */
    private forget(): void {
        this.styles.clear();
        for (const one of this.drawn) one.dress = undefined;
    }

    draw(moment: Moment, camera: Camera): void {
        const context = this.context;
        context.setTransform(1, 0, 0, 1, 0, 0);
        context.clearRect(0, 0, this.element.width, this.element.height);
        context.globalAlpha = 0.15;
        for (const shade of this.behind) this.drawAll(shade, camera);
        context.globalAlpha = 1;
        this.drawAll(moment, camera);
    }

    light(lit: ReadonlySet<number>, wrong: ReadonlySet<number>): void {
        [this.lit, this.wrong] = [lit, wrong];
    }

    shades(moments: readonly Moment[]): void {
        this.behind = moments;
    }

    hit([x, y]: Pair): number | undefined {
        const context = this.context;
        for (let k = this.drawn.length - 1; k >= 0; k--) {
            const { figure, shapes } = this.drawn[k]!;
            const matrix = this.places[k];
            if (!matrix) continue;
            context.setTransform(...matrix);
            const within = shapes.some(({ path }) => context.isPointInPath(path, x * this.sharp, y * this.sharp, "evenodd"));
            if (within) return figure.node.declaration;
        }
        return undefined;
    }

    /** Where each figure was drawn last. */
    private readonly places: [number, number, number, number, number, number][] = [];

    private drawAll(moment: Moment, camera: Camera): void {
        const context = this.context;
        const [left, top] = camera.origin;
        const pixels = camera.pixels * this.sharp;
        let last: Style | undefined;
        for (let k = 0; k < this.drawn.length; k++) {
            const one = this.drawn[k]!;
            const { figure, shapes } = one;
            const [cos, sin, x, y] = placed(figure, moment, camera);
            const [c, s] = [pixels * cos, pixels * sin];
            const matrix = (this.places[k] ??= [0, 0, 0, 0, 0, 0]);
            matrix[0] = c;
            matrix[1] = -s;
            matrix[2] = -s;
            matrix[3] = -c;
            matrix[4] = left * this.sharp + pixels * x;
            matrix[5] = top * this.sharp - pixels * y;
            context.setTransform(c, -s, -s, -c, matrix[4], matrix[5]);
            const mark = this.lit.has(figure.node.declaration) ? " lit" : this.wrong.has(figure.node.declaration) ? " wrong" : "";
            const dress = one.dress?.mark === mark ? one.dress : (one.dress = this.dressed(one, mark, pixels));
            for (let n = 0; n < shapes.length; n++) {
                const shape = shapes[n]!;
                const style = dress.styles[n]!;
                if (style !== last) {
                    if (style.fill) context.fillStyle = style.fill;
                    if (style.stroke) context.strokeStyle = style.stroke;
                    context.setLineDash(style.dash.map((length) => (length * this.sharp) / pixels));
                    context.lineWidth = (style.width * this.sharp) / pixels;
                    last = style;
                }
                const path = figure.stretches ? new Path2D(stretched(figure, n, moment)) : shape.path;
                if (style.fill) context.fill(path, "evenodd");
                if (style.stroke) context.stroke(path);
            }
        }
    }

    private dressed({ figure, shapes }: Drawn, mark: string, pixels: number): NonNullable<Drawn["dress"]> {
        const styles = shapes.map(({ look, reach }) => {
            const style = this.style(look, figure.tint, mark);
            return style.fill && style.stroke && reach * pixels < SPOT * this.sharp ? (style.spot ??= spotOf(style)) : style;
        });
        return { mark, styles };
    }

    /** What the style sheet says of a look. */
    private style(look: string, tint: string, mark: string): Style {
        const key = `${look} ${tint}${mark}`;
        let style = this.styles.get(key);
        if (!style) {
            style = read(this.element.parentElement!, look, `node ${tint}${mark}`);
            this.styles.set(key, style);
        }
        return style;
    }
}

function spotOf({ stroke, width, dash }: Style): Style {
    return { fill: stroke, stroke: undefined, width, dash };
}

/** How far a path reaches from its origin, but for what arcs reach beyond their ends. */
function reach(path: Command[]): number {
    return Math.max(0, ...path.map(([, ...n]) => (n.length < 2 ? 0 : Math.hypot(n[n.length - 2]!, n[n.length - 1]!))));
}

function read(beside: Element, look: string, node: string): Style {
    const path = svg("path", { class: `look-${look}` });
    const probe = svg("svg", { class: "probe" }, svg("g", { class: node }, path));
    beside.append(probe);
    const { fill, stroke, strokeWidth, strokeDasharray } = getComputedStyle(path);
    const style: Style = {
        fill: fill === "none" ? undefined : fill,
        stroke: stroke === "none" ? undefined : stroke,
        width: parseFloat(strokeWidth),
        dash: strokeDasharray === "none" ? [] : strokeDasharray.split(/[, ]+/).map(parseFloat),
    };
    probe.remove();
    return style;
}
