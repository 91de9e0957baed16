// Between two rows: the polynomial through what both know, and its derivatives. Where accelerations jump in between or at an end, what
// they are there is not asked.

/** What of a stretch may be used: its accelerations at its begin and its end. */
export const enum Smooth {
    Neither = 0,
    AtBegin = 1,
    AtEnd = 2,
    AtBoth = 3,
}

/** Value, first and second derivative with time. */
export type Three = [number, number, number] | Float64Array;

/**
 * The value and two derivatives at a share `s` (0 … 1) of a stretch of length `h`, from values `x`, velocities `v` and accelerations
 * `a` at its ends: a quintic; a quartic where one acceleration is unknown, a cubic where both are.
 */
export function between(
    out: Three,
    s: number,
    h: number,
    x0: number,
    v0: number,
    a0: number,
    x1: number,
    v1: number,
    a1: number,
    smooth: Smooth,
): void {
    const u0 = v0 * h;
    const u1 = v1 * h;
    // x0 + u0 s + c2 s² + … + c5 s⁵; what is left for the higher terms at s = 1
    const d = x1 - x0 - u0;
    const e = u1 - u0;
    let c2: number;
    let c3: number;
    let c4 = 0;
    let c5 = 0;
    if (smooth === Smooth.Neither) {
        c2 = 3 * d - e;
        c3 = e - 2 * d;
    } else if (smooth === Smooth.AtBegin) {
        c2 = 0.5 * a0 * h * h;
        c3 = 4 * d - e - 2 * c2;
        c4 = e - 3 * d + c2;
    } else if (smooth === Smooth.AtEnd) {
        const w1 = a1 * h * h;
        c2 = 6 * d - 3 * e + 0.5 * w1;
        c3 = -8 * d + 5 * e - w1;
        c4 = 3 * d - 2 * e + 0.5 * w1;
    } else {
        const w0 = a0 * h * h;
        const w1 = a1 * h * h;
        c2 = 0.5 * w0;
        c3 = 10 * d - 4 * e + 0.5 * w1 - 1.5 * w0;
        c4 = -15 * d + 7 * e - w1 + 1.5 * w0;
        c5 = 6 * d - 3 * e + 0.5 * w1 - 0.5 * w0;
    }
    out[0] = x0 + s * (u0 + s * (c2 + s * (c3 + s * (c4 + s * c5))));
    out[1] = (u0 + s * (2 * c2 + s * (3 * c3 + s * (4 * c4 + s * 5 * c5)))) / h;
    out[2] = (2 * c2 + s * (6 * c3 + s * (12 * c4 + s * 20 * c5))) / (h * h);
}
