// From metres to the picture. Drawing is done in units of the picture's own (a thousand over the motion's extent, from its middle), so
// that a micrometre and a kilometre are drawn with the same numbers.

import type { Scene } from "../data/format.ts";
import type { Pair } from "../motion/motion.ts";

/** The extent's greater side is so many units. */
const UNITS = 1000;
/** Around the extent there is so much of the picture's smaller side at least. */
const MARGIN = 0.07;
/** How far it goes in and out. */
const [FARTHEST, NEAREST] = [0.2, 60];

/** What is farther away (units) is as far as this: browsers read no greater numbers. */
const BEYOND = 1e9;

function near(value: number): number {
    return value > BEYOND ? BEYOND : value < -BEYOND ? -BEYOND : value;
}

export class Camera {
    /** Units in a metre. */
    readonly scale: number;
    private readonly middle: Pair;
    private readonly size: Pair;
    /** The picture in pixels. */
    width = 640;
    height = 480;
    /** What is drawn in pixels of its own, such as letters and arrows' heads, is so many times its usual size. */
    grain = 1;
    private zoom = 1;
    private moved: Pair = [0, 0];

    constructor(private readonly scene: Scene) {
        const [[left, bottom], [right, top]] = scene.extent;
        // what is no extent at all is given the size of a symbol
        const least = 8 * (scene.unit > 0 ? scene.unit : 1);
        const [wide, high] = [Math.max(right - left, least), Math.max(top - bottom, least)];
        const greater = Math.max(wide, high);
        this.scale = UNITS / (Number.isFinite(greater) ? greater : 1);
        this.middle = [(left + right) / 2, (bottom + top) / 2].map((at) => (Number.isFinite(at) ? at : 0)) as Pair;
        this.size = [wide * this.scale, high * this.scale];
    }

    /** Pixels in a unit. */
    get pixels(): number {
        const free = 1 - 2 * MARGIN;
        return this.zoom * Math.min((free * this.width) / this.size[0], (free * this.height) / this.size[1]);
    }

    /** Metres in a pixel. */
    get metres(): number {
        return 1 / (this.pixels * this.scale);
    }

    units([x, y]: Pair): Pair {
        return [near((x - this.middle[0]) * this.scale), near((y - this.middle[1]) * this.scale)];
    }

    /** The picture's pixel of a place in metres. */
    pixel(place: Pair): Pair {
        const [x, y] = this.units(place);
        const [left, top] = this.origin;
        return [left + this.pixels * x, top - this.pixels * y];
    }

    /** The place in metres of a pixel. */
    place([x, y]: Pair): Pair {
        const [left, top] = this.origin;
        const inUnits = [(x - left) / this.pixels, (top - y) / this.pixels];
        return [inUnits[0]! / this.scale + this.middle[0], inUnits[1]! / this.scale + this.middle[1]];
    }

    /** The pixel of the extent's middle. */
    get origin(): Pair {
        return [this.width / 2 + this.moved[0], this.height / 2 + this.moved[1]];
    }

    /** Nearer by a factor, around a pixel. */
    nearer(by: number, around: Pair = [this.width / 2, this.height / 2]): void {
        const zoom = Math.min(Math.max(this.zoom * by, FARTHEST), NEAREST);
        const grown = zoom / this.zoom;
        const [x, y] = this.origin;
        this.zoom = zoom;
        this.move([(1 - grown) * (around[0] - x), (1 - grown) * (around[1] - y)]);
    }

    move([x, y]: Pair): void {
        this.moved = [this.moved[0] + x, this.moved[1] + y];
    }

    /** All of it. */
    whole(): void {
        this.zoom = 1;
        this.moved = [0, 0];
    }

    get isWhole(): boolean {
        return this.zoom === 1 && this.moved[0] === 0 && this.moved[1] === 0;
    }

    /** Whether it is one for a scene. */
    fits(scene: Scene): boolean {
        return this.scene.unit === scene.unit && String(this.scene.extent) === String(scene.extent);
    }

    /** As another one looks. */
    as(other: Camera): void {
        [this.width, this.height, this.grain] = [other.width, other.height, other.grain];
        [this.zoom, this.moved] = [other.zoom, other.moved];
    }
}
