// What the reader asked to see. Panes look here, and are told when it changes.


/** Two frames whose pole is looked at. */
export interface Pairing {
    one: number;
    other: number;
    polodes: boolean;
}

/** An angle at a pin, between the directions to two points: by their numbers, for in another variant they are elsewhere. */
export interface Corner {
    one: number;
    pin: number;
    other: number;
}

export class Wishes {
    labels = false;
    traces = true;
    strobe = false;
    /** Vectors at all pins. */
    vectors = false;
    /** What joints exert, loads and weights. */
    forces = false;
    /** Points with vectors of their own, by number. */
    readonly vectorsAt = new Set<number>();
    /** Points with a trace, beside those that the text declares. */
    readonly traced = new Set<number>();
    /** The declaration that was chosen. */
    chosen: number | undefined;
    /** The declarations under the pointer. */
    pointed: readonly number[] = [];
    pairing: Pairing | undefined;
    corner: Corner | undefined;
    /** The number of the cam's contact that is looked at. */
    contact: number | undefined;

    private readonly told: ((change: Change) => void)[] = [];

    onChange(tell: (change: Change) => void): void {
        this.told.push(tell);
    }

    change(what: (wishes: this) => void): void {
        what(this);
        for (const tell of this.told) tell("wish");
    }

    /** The pointer is on other declarations. */
    point(pointed: readonly number[]): void {
        if (pointed.join() === this.pointed.join()) return;
        this.pointed = pointed;
        for (const tell of this.told) tell("pointer");
    }
}

/** What changed: what is to be seen, or only where the pointer is. */
export type Change = "wish" | "pointer";

export function toggle<T>(set: Set<T>, value: T): void {
    if (!set.delete(value)) set.add(value);
}
