// Arithmetic that is right to some 90 digits: numbers are BigInts of 2^-320, so sums of doubles are exact, and products, quotients,
// roots and angles are off by less than 2^-300. Of its own, to hold the page's results against.

const places = 320n;
export const one = 1n << places;

const bits = new DataView(new ArrayBuffer(8));

/** The double itself; an error for one that has binary places beyond the 320th. */
export function exact(double) {
    if (!Number.isFinite(double)) throw new Error(`${double} is no number`);
    bits.setFloat64(0, double);
    const word = bits.getBigUint64(0), exponent = (word >> 52n) & 0x7ffn, fraction = word & 0xfffffffffffffn;
    const mantissa = exponent === 0n ? fraction : fraction | 0x10000000000000n;
    const shift = (exponent === 0n ? 1n : exponent) - 1075n + places;
    const size = shift >= 0n ? mantissa << shift : mantissa >> -shift;
    if (shift < 0n && size << -shift !== mantissa) throw new Error(`${double} is too small to be exact here`);
    return word >> 63n ? -size : size;
}

/** The nearest double, or the next to it. */
export function toNumber(value) {
    return Number(value) / 2 ** Number(places);
}

export const abs = (a) => (a < 0n ? -a : a);
export const times = (a, b) => (a * b) >> places;
export const over = (a, b) => (a << places) / b;

export function root(a) {
    if (a <= 0n) return 0n;
    const square = a << places;
    let x = 1n << (BigInt(square.toString(2).length + 1) / 2n + 1n); // above the root, so Newton's steps fall
    for (;;) {
        const next = (x + square / x) >> 1n;
        if (next >= x) return x;
        x = next;
    }
}

/** Of 0 <= t <= 1: halved until the series converges quickly. */
function arcTangent(t) {
    const halvings = 12n;
    for (let i = 0n; i < halvings; i++) t = over(t, one + root(one + times(t, t)));
    const square = times(t, t);
    let sum = 0n, power = t;
    for (let n = 1n; power !== 0n && power !== -1n; n += 2n) {
        sum += power / n;
        power = -times(power, square);
    }
    return sum << halvings;
}

export const pi = 4n * arcTangent(one);
const degree = pi / 180n;

/** As Math.atan2, in degrees. */
export function degreesOf(y, x) {
    const [u, v] = [abs(x), abs(y)];
    if (u === 0n && v === 0n) return 0n;
    const first = v <= u ? arcTangent(over(v, u)) : pi / 2n - arcTangent(over(u, v));
    const turn = x < 0n ? pi - first : first;
    return over(y < 0n ? -turn : turn, degree);
}

/** How far a double is off, as a part of what is right. */
export function relativeError(found, right) {
    if (!Number.isFinite(found)) return Infinity;
    const off = abs(exact(found) - right);
    return off === 0n ? 0 : right === 0n ? Infinity : Number(off) / Number(abs(right));
}
export function absoluteError(found, right) {
    return Number.isFinite(found) ? toNumber(abs(exact(found) - right)) : Infinity;
}

// Vectors.
export const minus = (a, b) => a.map((value, axis) => value - b[axis]);
export const dot = (a, b) => a.reduce((sum, value, axis) => sum + times(value, b[axis]), 0n);
export const norm = (a) => root(dot(a, a));
export const cross = ([a, b, c], [x, y, z]) => [times(b, z) - times(c, y), times(c, x) - times(a, z), times(a, y) - times(b, x)];
