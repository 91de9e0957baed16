// The nodes of a scene, ready to be drawn: paths in the picture's units, and where each node is at a moment.

import type { Anchor, Node, Scene } from "../data/format.ts";
import { OF_A_FRAME, placeOf, type Moment } from "../motion/motion.ts";
import type { Camera } from "./camera.ts";
import { mapped, parsed, upright, written, type Command } from "./path.ts";

/** Bodies are tinted in turn by so many colours. */
const TINTS = 8;
/** A turn and a place: `matrix(cos sin -sin cos x y)`. */
export type Placed = [cos: number, sin: number, x: number, y: number];

export interface Shape {
    look: string;
    /** As the scene has it, and in the picture's units. */
    from: string;
    path: Command[];
    d: string;
}

export interface Figure {
    node: Node;
    /** The frame that gives it its colour; 0 for none. */
    frame: number;
    tint: string;
    shapes: Shape[];
    /** Whether its paths change as it moves. */
    stretches: boolean;
}

export function figures(scene: Scene, camera: Camera): Figure[] {
    return scene.nodes.map((node) => {
        const shapes = node.shapes.map((shape) => shaped(shape, camera));
        const frame = node.fixed ?? node.upright?.[0] ?? 0;
        return { node, frame, tint: tint(frame), shapes, stretches: node.between?.[2] === "stretched" };
    });
}

function shaped({ look, d: from }: Node["shapes"][number], camera: Camera): Shape {
    const path = upright(parsed(from), camera.scale);
    return { look, from, path, d: written(path) };
}

/** Whether nodes differ in nothing but shapes and places. */
export function areAlike(one: Node, other: Node): boolean {
    const looks = one.shapes.length === other.shapes.length && one.shapes.every(({ look }, k) => look === other.shapes[k]!.look);
    const frames = one.fixed === other.fixed && one.upright?.[0] === other.upright?.[0];
    return looks && frames && one.declaration === other.declaration && one.between?.[2] === other.between?.[2];
}

/** Takes another node that is alike; says which shapes are others. */
export function renewed(figure: Figure, node: Node, camera: Camera): number[] {
    figure.node = node;
    return node.shapes.flatMap((shape, k) => {
        if (shape.d === figure.shapes[k]!.from) return [];
        figure.shapes[k] = shaped(shape, camera);
        return [k];
    });
}

/** The class that colours what belongs to a frame. */
export function tint(frame: number): string {
    return frame === 0 ? "tint-ground" : `tint-${(frame - 1) % TINTS}`;
}

/** Where a figure is at a moment. */
export function placed({ node }: Pick<Figure, "node">, moment: Moment, camera: Camera): Placed {
    if (node.upright) {
        const [x, y] = camera.units(placeOf(moment, node.upright));
        return [1, 0, x, y];
    }
    if (node.between) {
        const [from, to, held] = node.between;
        const [x, y] = camera.units(placeOf(moment, held === "to" ? to : from));
        const [dx, dy, length] = span(from, to, moment);
        return length > 0 ? [dx / length, dy / length, x, y] : [1, 0, x, y];
    }
    const at = OF_A_FRAME * (node.fixed ?? 0);
    const frames = moment.frames;
    const [x, y] = camera.units([frames[at]!, frames[at + 1]!]);
    return [Math.cos(frames[at + 2]!), Math.sin(frames[at + 2]!), x, y];
}

/** The path of a shape that is stretched between two places, at a moment. */
export function stretched({ node, shapes }: Figure, shape: number, moment: Moment): string {
    const [from, to] = node.between!;
    const length = span(from, to, moment)[2];
    // along the way the path is in parts of it, which were scaled like lengths
    const along = (x: number) => x * length;
    return written(mapped(shapes[shape]!.path, along, (y) => y, 1));
}

function span(from: Anchor, to: Anchor, moment: Moment): [number, number, number] {
    const [x, y] = placeOf(moment, from);
    const [tx, ty] = placeOf(moment, to);
    return [tx - x, ty - y, Math.hypot(tx - x, ty - y)];
}
