// Cut and fill over a polygon, by the definition that docs/PAGE.md gives, from every point of a scan: exact sides, exact means, exact parts of
// cells.
import { abs, exact, one, over, root, times } from './exact_numbers.mjs';

const twice = (a, b, c) => times(b[0] - a[0], c[1] - a[1]) - times(b[1] - a[1], c[0] - a[0]);

/** Corners, counter-clockwise, of triangles: ears are cut, each time the one whose new edge is shortest. */
function triangles(ring) {
    const left = ring.map((_, i) => i), made = [];
    if (area(ring) < 0n) left.reverse();
    while (left.length > 2) {
        let best, shortest;
        left.forEach((here, at) => {
            const before = left[(at + left.length - 1) % left.length], after = left[(at + 1) % left.length];
            const [a, b, c] = [ring[before], ring[here], ring[after]];
            const holds = (p) => twice(a, b, p) >= 0n && twice(b, c, p) >= 0n && twice(c, a, p) >= 0n;
            const isEar = twice(a, b, c) > 0n && !left.some((i) => ![before, here, after].includes(i) && holds(ring[i]));
            const edge = times(c[0] - a[0], c[0] - a[0]) + times(c[1] - a[1], c[1] - a[1]);
            if (isEar && (best === undefined || edge < shortest)) [best, shortest] = [{ at, corners: [before, here, after] }, edge];
        });
        if (!best) throw new Error('the polygon can not be cut into triangles');
        made.push(best.corners);
        left.splice(best.at, 1);
    }
    return made;
}

function area(ring) {
    return ring.reduce((sum, a, i) => sum + twice(ring[0], a, ring[(i + 1) % ring.length]), 0n) / 2n;
}

/** What of the ring has sign × (coordinate - bound) <= 0. */
function cutAt(ring, axis, sign, bound) {
    return ring.flatMap((a, i) => {
        const b = ring[(i + 1) % ring.length], [overA, overB] = [a, b].map((p) => sign * (p[axis] - bound));
        const kept = overA <= 0n ? [a] : [];
        if ((overA < 0n && overB > 0n) || (overA > 0n && overB < 0n)) {
            const t = over(overA, overA - overB);
            kept.push(a.map((value, at) => (at === axis ? bound : value + times(t, b[at] - value))));
        }
        return kept;
    });
}

/** Height of the base over a place: a level plane, or the rim's triangle that holds it. */
function baseOf(corners, level) {
    if (level !== undefined) return () => level;
    const facets = triangles(corners).map((at) => at.map((i) => corners[i]));
    return (p) => {
        const [a, b, c] = facets.find(([a, b, c]) => twice(a, b, p) >= 0n && twice(b, c, p) >= 0n && twice(c, a, p) >= 0n);
        const u = twice(p, b, c), v = twice(a, p, c), w = twice(a, b, p);
        return over(times(u, a[2]) + times(v, b[2]) + times(w, c[2]), u + v + w);
    };
}

/** Cells without points get the mean of those of their eight neighbours that got a height in an earlier round. */
function fill(heights, columns, rows) {
    while (heights.size < columns * rows) {
        const found = [];
        for (let at = 0; at < columns * rows; at++) {
            if (heights.has(at)) continue;
            const near = [];
            for (const dy of [-1, 0, 1])
                for (const dx of [-1, 0, 1]) {
                    const column = (at % columns) + dx, row = Math.floor(at / columns) + dy;
                    if (column < 0 || column >= columns || row < 0 || row >= rows) continue;
                    const height = heights.get(row * columns + column);
                    if (height !== undefined) near.push(height);
                }
            if (near.length > 0) found.push([at, near.reduce((sum, height) => sum + height, 0n) / BigInt(near.length)]);
        }
        for (const [at, height] of found) heights.set(at, height);
    }
}

/**
 * {cut, fill, net, area, cell, pointsInside}. `corners`: the polygon's, as seen from the first (exact_answers.mjs); `points`: those of the
 * scan that lie in it, likewise; `level`: height of a level base as seen from the first corner, none: the rim.
 */
export function exactVolume(corners, points, level) {
    const base = baseOf(corners, level), whole = abs(area(corners));
    const cell = 2n * root(over(whole, BigInt(points.length) * one));
    const bounds = [0, 1].map((axis) => corners.map((p) => p[axis]).sort((a, b) => (a < b ? -1 : a > b ? 1 : 0)));
    const [x0, y0] = bounds.map((sorted) => sorted[0]);
    const [columns, rows] = bounds.map((sorted) => Math.max(1, Number((sorted.at(-1) - sorted[0] + cell - 1n) / cell)));
    const sums = new Map();
    for (const p of points) {
        const column = Math.min(columns - 1, Number((p[0] - x0) / cell)), row = Math.min(rows - 1, Number((p[1] - y0) / cell));
        const at = row * columns + column, { sum, count } = sums.get(at) ?? { sum: 0n, count: 0n };
        sums.set(at, { sum: sum + p[2] - base(p), count: count + 1n });
    }
    const heights = new Map([...sums].map(([at, { sum, count }]) => [at, sum / count]));
    fill(heights, columns, rows);
    let cut = 0n, filled = 0n, covered = 0n;
    for (let row = 0; row < rows; row++) {
        const low = y0 + BigInt(row) * cell;
        const strip = cutAt(cutAt(corners.map(([x, y]) => [x, y]), 1, -1n, low), 1, 1n, low + cell);
        for (let column = 0; column < columns; column++) {
            const left = x0 + BigInt(column) * cell;
            const part = cutAt(cutAt(strip, 0, -1n, left), 0, 1n, left + cell);
            const size = part.length < 3 ? 0n : abs(area(part)), height = heights.get(row * columns + column);
            covered += size;
            if (height > 0n) cut += times(size, height);
            else filled -= times(size, height);
        }
    }
    return { cut, fill: filled, net: cut - filled, area: covered, cell, pointsInside: points.length };
}

/** The points of the scan that lie in the polygon, edges included, by their integers; both as seen from the first corner. */
export function pointsInPolygon(scan, points) {
    const [fx, fy, fz] = points[0].integers, ring = points.map(({ integers: [x, y] }) => [x, y]);
    const low = [0, 1].map((axis) => Math.min(...ring.map((p) => p[axis]))), high = [0, 1].map((axis) => Math.max(...ring.map((p) => p[axis])));
    const scale = points[0].scale.map(exact), inside = [];
    for (let i = 0; i < scan.count; i++) {
        const x = scan.x[i], y = scan.y[i];
        if (x < low[0] || x > high[0] || y < low[1] || y > high[1] || !holds(ring, x, y)) continue;
        inside.push([BigInt(x - fx) * scale[0], BigInt(y - fy) * scale[1], BigInt(scan.z[i] - fz) * scale[2]]);
    }
    return inside;
}

/** By crossings. Products of whole numbers below 2^53 are exact; others are not taken. */
function holds(ring, x, y) {
    let isInside = false;
    for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
        const [ax, ay] = ring[i], [bx, by] = ring[j];
        const left = (bx - ax) * (y - ay), right = (by - ay) * (x - ax);
        if (Math.max(Math.abs(left), Math.abs(right)) > 2 ** 53) throw new Error('the polygon is too large to be tested exactly here');
        const side = left - right;
        if (side === 0 && x >= Math.min(ax, bx) && x <= Math.max(ax, bx) && y >= Math.min(ay, by) && y <= Math.max(ay, by)) return true;
        if (ay > y !== by > y && side > 0 === by > ay) isInside = !isInside;
    }
    return isInside;
}
