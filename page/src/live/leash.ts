// A body that a hand turns by its input, of which only the program knows what angle it makes: the input is led by how the angle has changed
// with it until now.

/** Where a body is: its angle (rad), with what the input is there (SI). */
export interface Place {
    angle: number;
    input: number;
}

/** A body so near to the hand is at it (rad). */
const NEAR = 1e-3;
/** So often the input is corrected for one place of the hand: a body that cannot come there is let go. */
const CORRECTIONS = 12;
/** Angles that differ by less say nothing of a rate (rad). */
const DIFFERENT = 1e-7;
/** A rate is no less than so much of the one at first: near a turn of the angle steps would have no end. */
const LEAST = 0.05;

export class Leash {
    private wanted: number;
    private asked: number;
    private corrections = 0;
    /** Whether what was asked last has not come to its end. */
    isWaiting = false;

    /** From a place, with how the angle changes with the input at first [rad per SI unit]. */
    constructor(
        private at: Place,
        private rate: number,
        private readonly first = Math.abs(rate),
    ) {
        [this.wanted, this.asked] = [at.angle, at.input];
    }

    /** The hand wants another angle; says the input that leads there. */
    pull(angle: number): number {
        this.wanted = angle;
        this.corrections = 0;
        return this.ask();
    }

    /** The body is somewhere; says the input that leads on to the hand, unless it is there, cannot come nearer, or more was asked meanwhile. */
    answer(there: Place, isLast: boolean): number | undefined {
        if (Number.isFinite(there.angle + there.input)) this.learn(there);
        if (!isLast) return undefined;
        this.isWaiting = false;
        const hasStopped = !(Math.abs(there.input - this.asked) * this.first < NEAR);
        const isThere = Math.abs(this.wanted - this.at.angle) < NEAR;
        if (hasStopped || isThere || this.corrections >= CORRECTIONS) return undefined;
        this.corrections += 1;
        return this.ask();
    }

    private learn(there: Place): void {
        const turned = there.angle - this.at.angle;
        const rate = turned / (there.input - this.at.input);
        const isKnown = Number.isFinite(rate) && Math.abs(turned) > DIFFERENT;
        if (isKnown) this.rate = Math.sign(rate) * Math.max(Math.abs(rate), LEAST * this.first);
        this.at = there;
    }

    private ask(): number {
        this.isWaiting = true;
        this.asked = this.at.input + (this.wanted - this.at.angle) / this.rate;
        return this.asked;
    }
}
