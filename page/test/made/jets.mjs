// Numbers with their first and second derivatives with time, so that made motions have exact ones.

export const jet = (x, d = 0, dd = 0) => ({ x, d, dd });
const of = (a) => (typeof a === "number" ? jet(a) : a);
export const add = (...all) => all.map(of).reduce((a, b) => jet(a.x + b.x, a.d + b.d, a.dd + b.dd));
export const mul = (a, b) => {
    [a, b] = [of(a), of(b)];
    return jet(a.x * b.x, a.d * b.x + a.x * b.d, a.dd * b.x + 2 * a.d * b.d + a.x * b.dd);
};
export const neg = (a) => mul(-1, a);
/** A function with its derivatives, of a jet. */
const chain = (f, f1, f2) => (a) => {
    a = of(a);
    return jet(f(a.x), f1(a.x) * a.d, f1(a.x) * a.dd + f2(a.x) * a.d * a.d);
};
export const sin = chain(Math.sin, Math.cos, (x) => -Math.sin(x));
export const cos = chain(Math.cos, (x) => -Math.sin(x), (x) => -Math.cos(x));
export const sqrt = chain(Math.sqrt, (x) => 0.5 / Math.sqrt(x), (x) => -0.25 / (x * Math.sqrt(x)));
export const asin = chain(Math.asin, (x) => 1 / Math.sqrt(1 - x * x), (x) => x / Math.sqrt(1 - x * x) ** 3);
export const inverse = chain((x) => 1 / x, (x) => -1 / (x * x), (x) => 2 / x ** 3);
export const atan2 = (y, x) => {
    [y, x] = [of(y), of(x)];
    const r = add(mul(x, x), mul(y, y));
    const rate = (a, b) => mul(add(mul(x, a), neg(mul(y, b))), inverse(r));
    const d = rate(jet(y.d, y.dd), jet(x.d, x.dd));
    return jet(Math.atan2(y.x, x.x), d.x, d.d);
};
