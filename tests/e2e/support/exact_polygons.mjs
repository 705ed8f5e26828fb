// Which points of a scan lie in a footprint or show in a polygon on the screen, tested one by one; and where a perspective camera shows places.
import { exact } from './exact_numbers.mjs';
import { cross, dot, minus, norm } from './town_page.mjs';

/** Does the ring, corners [x, y], hold p, edges included? By crossings. `sideOf(a, b, p)`: positive to the left of the way from a to b, 0 on its line. */
function isHeld(ring, [x, y], sideOf) {
    let isInside = false;
    for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
        const [ax, ay] = ring[j], [bx, by] = ring[i];
        if (Math.max(ay, by) < y || Math.min(ay, by) > y) continue;
        const side = sideOf(ring[j], ring[i], [x, y]);
        if (side === 0 && x >= Math.min(ax, bx) && x <= Math.max(ax, bx)) return true;
        if (ay > y !== by > y && side > 0 === by > ay) isInside = !isInside;
    }
    return isInside;
}

/** Of doubles, as they are: by doubles where these are sure, exactly near the line. */
function exactSide(a, b, p) {
    const [ux, uy, vx, vy] = [b[0] - a[0], b[1] - a[1], p[0] - a[0], p[1] - a[1]], left = ux * vy, right = uy * vx;
    if (Math.abs(left - right) > 1e-12 * (Math.abs(left) + Math.abs(right))) return left - right;
    const [[ax, ay], [bx, by], [x, y]] = [a, b, p].map((place) => place.map(exact));
    const side = (bx - ax) * (y - ay) - (by - ay) * (x - ax);
    return side > 0n ? 1 : side < 0n ? -1 : 0;
}

const isBetween = (z, [low, high] = [null, null]) => (low === null || z >= low) && (high === null || z <= high);

/** Indices of the points in a footprint of a style: {polygon, heights}, without holes. */
export function pointsInFootprint(scan, { polygon, heights }) {
    const found = [];
    for (let i = 0; i < scan.count; i++) {
        const [x, y, z] = scan.placeOf(i);
        if (isBetween(z, heights) && isHeld(polygon, [x, y], exactSide)) found.push(i);
    }
    return found;
}

/** Indices of those of `indices` whose heights are within [low, high]; null: open. */
export function between(scan, indices, heights) {
    return indices.filter((i) => isBetween(scan.placeOf(i)[2], heights));
}

/** (p) => [x, y]: where a perspective camera shows a place, in CSS pixels of its canvas; undefined behind it. */
export function projection({ position, target, up, fovYDegrees }, { width, height }) {
    const unit = (v) => v.map((value) => value / norm(v));
    const forward = unit(minus(target, position)), right = unit(cross(forward, up)), above = cross(right, forward);
    const focal = height / 2 / Math.tan((fovYDegrees * Math.PI) / 360);
    return (p) => {
        const from = minus(p, position), depth = dot(from, forward);
        return depth > 0 ? [width / 2 + (dot(from, right) * focal) / depth, height / 2 - (dot(from, above) * focal) / depth] : undefined;
    };
}

/** So near (pixels) to the line of an edge nobody can say, for the camera's numbers are rounded. */
const unsureReach = 1e-6;

/** {inside, unsure}: indices of the points that show in a ring of pixels, and of those too near to the line of an edge to say. */
export function pointsShownIn(scan, ring, show) {
    const inside = [], unsure = [], side = (a, b, p) => (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    const edges = ring.map((a, i) => [a, ring[(i + 1) % ring.length]]);
    for (let i = 0; i < scan.count; i++) {
        const at = show(scan.placeOf(i));
        if (!at) continue;
        if (edges.some(([a, b]) => Math.abs(side(a, b, at)) < unsureReach * Math.hypot(b[0] - a[0], b[1] - a[1]))) unsure.push(i);
        else if (isHeld(ring, at, side)) inside.push(i);
    }
    return { inside, unsure };
}
