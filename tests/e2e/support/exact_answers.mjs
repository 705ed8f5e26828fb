// What the tools have to say of points that were picked, from the points' integers alone.
import { abs, cross, degreesOf, dot, exact, minus, norm, one, over, pi, root, times } from './exact_numbers.mjs';

/** From the first point, whatever the offset: differences of integers, times the scale. All are of one cloud. */
export function localPoints(points) {
    const first = points[0];
    return points.map(({ integers, scale }) =>
        integers.map((value, axis) => BigInt(value - first.integers[axis]) * exact(scale[axis])),
    );
}

/** Where a point is in the world. */
export function placeOf({ integers, scale, offset }) {
    return integers.map((value, axis) => exact(offset[axis]) + BigInt(value) * exact(scale[axis]));
}

const steps = (points, isClosed) =>
    points.flatMap((point, i) => {
        const next = i + 1 < points.length ? points[i + 1] : isClosed ? points[0] : undefined;
        return next ? [minus(next, point)] : [];
    });
const sum = (values) => values.reduce((total, value) => total + value, 0n);
const plan = ([x, y]) => root(times(x, x) + times(y, y));
const turnOf = ([x, y]) => {
    const degrees = degreesOf(x, y);
    return degrees < 0n ? degrees + 360n * one : degrees;
};

/** The normal of the plane from which the sum of the squared distances is least, and the mean, through which it goes. */
function bestFit(points) {
    const count = BigInt(points.length), mean = [0, 1, 2].map((axis) => sum(points.map((p) => p[axis])) / count);
    const away = points.map((p) => minus(p, mean));
    const m = [0, 1, 2].map((row) => [0, 1, 2].map((column) => sum(away.map((p) => times(p[row], p[column])))));
    const less = (least) => m.map((row, i) => row.map((value, j) => (i === j ? value - least : value)));
    const minors = (a) => [0, 1, 2].map((i) => {
        const [j, k] = [0, 1, 2].filter((other) => other !== i);
        return times(a[j][j], a[k][k]) - times(a[j][k], a[k][j]);
    });
    // The least root of the characteristic polynomial: from 0, below all roots, Newton's steps rise to it.
    let least = 0n;
    for (let i = 0; i < 400; i++) {
        const a = less(least), slope = sum(minors(a));
        const step = slope === 0n ? 0n : over(dot(a[0], cross(a[1], a[2])), slope);
        if (abs(step) <= 1n << 40n) break;
        least += step;
    }
    const [a, b, c] = less(least);
    const normal = [cross(a, b), cross(b, c), cross(c, a)].reduce((best, one) => (dot(one, one) > dot(best, best) ? one : best));
    const size = norm(normal);
    return { mean, normal: normal.map((value) => over(value, size)) };
}

/** Twice the vector of the polygon's area. */
function areaVector(points) {
    return points.reduce(
        (total, point, i) => total.map((value, axis) => value + cross(point, points[(i + 1) % points.length])[axis]),
        [0n, 0n, 0n],
    );
}

const answers = {
    distance(points) {
        const ways = steps(points, false);
        return { distance: sum(ways.map(norm)), horizontal: sum(ways.map(plan)), vertical: points.at(-1)[2] };
    },
    height([a, b]) {
        const way = minus(b, a);
        return { height: abs(way[2]), horizontal: plan(way) };
    },
    azimuth([a, b]) {
        const way = minus(b, a);
        return { azimuth: turnOf(way), gradient: degreesOf(way[2], plan(way)), distance: norm(way), horizontal: plan(way) };
    },
    angle([a, corner, b]) {
        const u = minus(a, corner), v = minus(b, corner);
        return { angle: degreesOf(norm(cross(u, v)), dot(u, v)) };
    },
    area(points) {
        const vector = areaVector(points).map((value) => value / 2n), { normal, mean } = bestFit(points);
        const off = points.map((p) => abs(dot(minus(p, mean), normal)));
        return {
            horizontal: abs(vector[2]),
            inPlane: abs(dot(vector, normal)),
            perimeter: sum(steps(points, true).map(norm)),
            deviation: off.reduce((most, value) => (value > most ? value : most)),
        };
    },
    circle([a, b, c]) {
        const u = minus(b, a), v = minus(c, a), doubled = norm(cross(u, v));
        const radius = over(times(times(norm(u), norm(v)), norm(minus(u, v))), 2n * doubled);
        return { radius, diameter: 2n * radius, circumference: times(2n * pi, radius), area: times(pi, times(radius, radius)) };
    },
};

/** The right answer's numbers by name, of up along z. */
export function exactAnswer(kind, points) {
    return answers[kind](localPoints(points));
}

/** The circle's centre in the world. */
export function exactCentre(points) {
    const [a, b, c] = localPoints(points), u = minus(b, a), v = minus(c, a), normal = cross(u, v);
    const [first, second] = [cross(v, normal), cross(normal, u)], square = 2n * dot(normal, normal);
    return placeOf(points[0]).map(
        (value, axis) => value + a[axis] + over(times(first[axis], dot(u, u)) + times(second[axis], dot(v, v)), square),
    );
}
