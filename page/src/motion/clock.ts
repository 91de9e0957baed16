// The page's own time: what is shown now, whether it goes on, how fast, and what it does at an end.

export type Turning = "loop" | "to and fro";

/** One run lasts so long at first (s). */
export const FIRST_RUN = 6;

/** A step of speed. */
const FASTER = 2;

export class Clock {
    time = 0;
    /** The time that was asked for last: one that is not in the span comes back with a span that has it. */
    private asked = 0;
    playing = false;
    turning: Turning = "loop";
    /** Seconds of the mechanism in one of the reader's. */
    rate = 1;
    private from = 0;
    private to = 0;
    private direction = 1;

    /** The span of time there is. */
    span(from: number, to: number, anew: boolean): void {
        this.from = from;
        this.to = to;
        if (anew) {
            this.rate = to > from ? (to - from) / FIRST_RUN : 1;
            this.asked = from;
        }
        this.time = this.held(this.asked);
    }

    /** To a time, or the end that is nearest. */
    go(time: number): void {
        this.time = this.asked = this.held(time);
    }

    held(time: number): number {
        return Math.min(Math.max(time, this.from), this.to);
    }

    faster(): void {
        this.rate *= FASTER;
    }

    slower(): void {
        this.rate /= FASTER;
    }

    /** Goes on by so many of the reader's seconds. */
    advance(seconds: number): void {
        const length = this.to - this.from;
        if (!(length > 0)) return;
        let gone = this.time - this.from + this.direction * this.rate * seconds;
        if (this.turning === "loop") {
            this.direction = 1;
            gone = gone > length ? gone % length : gone;
        } else {
            // a saw of twice the length, folded
            const there = this.direction > 0 ? gone : 2 * length - gone;
            const folded = ((there % (2 * length)) + 2 * length) % (2 * length);
            this.direction = folded <= length ? 1 : -1;
            gone = folded <= length ? folded : 2 * length - folded;
        }
        this.go(this.from + gone);
    }
}

/** A rate in words. */
export function told(rate: number): string {
    const near = (value: number) => Number(value.toPrecision(3));
    if (near(rate) === 1) return "real time";
    return rate < 1 ? `1/${near(1 / rate)} of real time` : `${near(rate)} × real time`;
}
