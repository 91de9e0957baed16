// Where everything is at a time: the rows, and the polynomials between them.

import type { Anchor, Scene } from "../data/format.ts";
import type { Table } from "../data/table.ts";
import { Smooth, between, type Three } from "./quintic.ts";

/** A column with its derivatives, where the table has them. */
interface Followed {
    x: Float64Array;
    d: Float64Array | undefined;
    dd: Float64Array | undefined;
}

/** Numbers of a frame: x, y, phi, their first and their second derivatives. */
export const OF_A_FRAME = 9;

/** A place or a vector. */
export type Pair = [number, number];

/** Everything at one time. */
export interface Moment {
    time: number;
    /** The row at this time or before it; -1 where there is none. */
    row: number;
    /** OF_A_FRAME numbers for each frame; the ground's are 0. */
    frames: Float64Array;
}

export class Motion {
    private readonly frames: (Followed[] | undefined)[];
    private readonly smooth: Uint8Array;
    private readonly three = new Float64Array(3);

    constructor(
        readonly scene: Scene,
        readonly table: Table,
        readonly edges: readonly number[],
        private readonly drawn: readonly (readonly [number, number, number])[] = [],
    ) {
        this.frames = scene.frames.map((declaration, frame) => {
            const name = scene.declarations[declaration]?.[0];
            if (frame === 0 || name === undefined) return undefined;
            const columns = ["x", "y", "phi"].map((part) => this.followed(`${name}.${part}`));
            return columns.every((column) => column !== undefined) ? (columns as Followed[]) : undefined;
        });
        this.smooth = smoothness(table.times, edges);
    }

    get from(): number {
        return this.table.times[0] ?? 0;
    }

    get to(): number {
        return this.table.times[this.table.rows - 1] ?? 0;
    }

    moment(): Moment {
        const frames = new Float64Array(OF_A_FRAME * this.scene.frames.length);
        this.drawn.forEach((pose, frame) => frames.set(pose, OF_A_FRAME * frame));
        return { time: 0, row: -1, frames };
    }

    /** Sets a moment to a time. */
    at(time: number, moment: Moment): Moment {
        const row = this.table.rowAt(time);
        moment.time = time;
        moment.row = row;
        if (row < 0) return moment;
        for (let frame = 1; frame < this.frames.length; frame++) {
            const columns = this.frames[frame];
            if (!columns) continue;
            for (let part = 0; part < 3; part++) {
                this.follow(columns[part]!, time, row, this.three);
                const place = OF_A_FRAME * frame + part;
                moment.frames[place] = this.three[0]!;
                moment.frames[place + 3] = this.three[1]!;
                moment.frames[place + 6] = this.three[2]!;
            }
        }
        return moment;
    }

    /** Sets a moment to a row. */
    atRow(row: number, moment: Moment): Moment {
        return this.at(this.table.times[row] ?? 0, moment);
    }

    /** A column's value at a time (SI): that of the table at a row. */
    value(place: number, time: number): number {
        const row = this.table.rowAt(time);
        if (row < 0) return NaN;
        const { name } = this.table.columns[place]!;
        this.follow(this.followed(name)!, time, row, this.three);
        return this.three[0]!;
    }

    private followed(name: string): Followed | undefined {
        const x = this.table.named(name);
        return x && { x, d: this.table.named(`${name}.d`), dd: this.table.named(`${name}.dd`) };
    }

    private follow({ x, d, dd }: Followed, time: number, row: number, out: Three): void {
        const times = this.table.times;
        const begin = times[row]!;
        if (row + 1 >= times.length || time <= begin) {
            out[0] = x[row]!;
            out[1] = d ? d[row]! : NaN;
            out[2] = dd ? dd[row]! : NaN;
            return;
        }
        const h = times[row + 1]! - begin;
        const s = (time - begin) / h;
        if (!d) {
            out[0] = x[row]! + s * (x[row + 1]! - x[row]!);
            out[1] = NaN;
            out[2] = NaN;
            return;
        }
        const smooth: Smooth = dd ? this.smooth[row]! : Smooth.Neither;
        const a0 = dd ? dd[row]! : 0;
        const a1 = dd ? dd[row + 1]! : 0;
        between(out, s, h, x[row]!, d[row]!, a0, x[row + 1]!, d[row + 1]!, a1, smooth);
    }
}

/** What of each stretch between two rows may be used. */
function smoothness(times: Float64Array, edges: readonly number[]): Uint8Array {
    const smooth = new Uint8Array(Math.max(times.length - 1, 0)).fill(Smooth.AtBoth);
    for (const edge of edges) {
        for (let row = 0; row < smooth.length; row++) {
            const begin = times[row]!;
            const end = times[row + 1]!;
            const near = 1e-9 * (end - begin);
            if (edge < begin - near || edge > end + near) continue;
            // at an end of the stretch the row's acceleration may be that of the other side; inside, neither side's holds for all of it
            if (edge <= begin + near) smooth[row]! &= ~Smooth.AtBegin;
            else if (edge >= end - near) smooth[row]! &= ~Smooth.AtEnd;
            else smooth[row] = Smooth.Neither;
        }
    }
    return smooth;
}

/** Where a place of a frame is. */
export function placeOf({ frames }: Moment, [frame, x, y]: Anchor): Pair {
    const at = OF_A_FRAME * frame;
    const c = Math.cos(frames[at + 2]!);
    const s = Math.sin(frames[at + 2]!);
    return [frames[at]! + c * x - s * y, frames[at + 1]! + s * x + c * y];
}

/** How fast a place of a frame moves. */
export function velocityOf(moment: Moment, anchor: Anchor): Pair {
    const at = OF_A_FRAME * anchor[0];
    const [x, y] = arm(moment, anchor);
    const w = moment.frames[at + 5]!;
    return [moment.frames[at + 3]! - w * y, moment.frames[at + 4]! + w * x];
}

/** How a place of a frame is accelerated. */
export function accelerationOf(moment: Moment, anchor: Anchor): Pair {
    const at = OF_A_FRAME * anchor[0];
    const [x, y] = arm(moment, anchor);
    const w = moment.frames[at + 5]!;
    const e = moment.frames[at + 8]!;
    return [moment.frames[at + 6]! - e * y - w * w * x, moment.frames[at + 7]! + e * x - w * w * y];
}

/** From a frame's origin to a place of it, in the ground's directions. */
function arm({ frames }: Moment, [frame, x, y]: Anchor): Pair {
    const phi = frames[OF_A_FRAME * frame + 2]!;
    const c = Math.cos(phi);
    const s = Math.sin(phi);
    return [c * x - s * y, s * x + c * y];
}

/** Where a place of the plane is in a frame. */
export function within({ frames }: Moment, frame: number, [x, y]: Pair): Pair {
    const at = OF_A_FRAME * frame;
    const c = Math.cos(frames[at + 2]!);
    const s = Math.sin(frames[at + 2]!);
    const dx = x - frames[at]!;
    const dy = y - frames[at + 1]!;
    return [c * dx + s * dy, c * dy - s * dx];
}
