// The rows of a motion: columns in SI, by name, and how each is printed.

import type { Column } from "./format.ts";

export class Table {
    readonly times: Float64Array;
    private readonly places: Map<string, number>;

    constructor(
        readonly columns: readonly Column[],
        readonly values: readonly Float64Array[],
    ) {
        this.times = values[0] ?? new Float64Array(0);
        this.places = new Map(columns.map((column, place) => [column.name, place]));
    }

    get rows(): number {
        return this.times.length;
    }

    place(name: string): number | undefined {
        return this.places.get(name);
    }

    /** The column of a name, in SI. */
    named(name: string): Float64Array | undefined {
        const place = this.places.get(name);
        return place === undefined ? undefined : this.values[place];
    }

    /** The row at a time or the last before it; -1 where there are none. */
    rowAt(time: number): number {
        const times = this.times;
        if (times.length === 0) return -1;
        let low = 0;
        let high = times.length - 1;
        while (low < high) {
            const middle = (low + high + 1) >> 1;
            if (times[middle]! <= time) low = middle;
            else high = middle - 1;
        }
        return low;
    }

    /** The row whose time is nearest. */
    nearest(time: number): number {
        const row = this.rowAt(time);
        const next = Math.min(row + 1, this.rows - 1);
        return row >= 0 && this.times[next]! - time < time - this.times[row]! ? next : row;
    }
}

/** A value in SI, in the unit of its column: the very number of the table. */
export function printed(column: Column, value: number): number {
    const scale = column.scale;
    return scale ? ((value / scale[0]) * scale[1]) / scale[2] : value;
}
