// Params that a reader has set, each in the unit that the text has for it; and those that are kept for when a text has them again.

import type { Knob } from "../data/live.ts";

interface Kept {
    value: number;
    knob: Knob;
}

/** A number that came of two others has no more digits than these are sure of. */
const DIGITS = 15;

export class Settings {
    /** In the units of the knobs that there are. */
    readonly values = new Map<string, number>();
    private readonly aside = new Map<string, Kept>();
    private knobs: readonly Knob[] = [];

    knob(name: string): Knob | undefined {
        return this.knobs.find((knob) => knob.name === name);
    }

    /** What is set of all copies of a part takes the place of what is set of each. */
    set(name: string, value: number): void {
        for (const copy of this.knobs) if (copy.of === name) this.values.delete(copy.name);
        const own = this.knob(name);
        // a formula, or one of several copies, may be something else by now
        const isAsSaid = own?.value === value && own.formula === null && !(own.of !== null && this.values.has(own.of));
        if (isAsSaid) this.values.delete(name);
        else this.values.set(name, value);
    }

    clear(): void {
        this.values.clear();
        this.aside.clear();
    }

    /** What is set, as options have it. */
    asked(): [name: string, value: string][] {
        return [...this.values].map(([name, value]) => [name, withUnit(value, this.knob(name)?.unit ?? "")]);
    }

    /** What is kept, in words. */
    get said(): string {
        const kept = [...this.aside].map(([name, { value, knob }]) => `${name} = ${withUnit(value, knob.unit)}`);
        return kept.length > 0 ? `Kept for when the text has it again: ${kept.join(", ")}` : "";
    }

    /** There are other knobs: what is set of the same kind stays what it is; says whether anything is set otherwise. */
    follow(knobs: readonly Knob[]): boolean {
        const before = this.asked().join();
        for (const [name, value] of this.values) {
            const knob = this.knob(name);
            if (knob) this.aside.set(name, { value, knob });
        }
        this.knobs = knobs;
        this.values.clear();
        for (const [name, { value, knob }] of this.aside) {
            const now = this.knob(name);
            if (!now || now.dimension !== knob.dimension) continue;
            this.aside.delete(name);
            this.values.set(name, now.unit === knob.unit ? value : Number(((value * knob.si) / now.si).toPrecision(DIGITS)));
        }
        return this.asked().join() !== before;
    }
}

/** A value as `--set` takes it. */
export function withUnit(value: number, unit: string): string {
    return unit === "" || unit.startsWith("/") ? `${value}${unit}` : `${value} ${unit}`;
}
