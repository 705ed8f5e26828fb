// Which points of a scan lie in a turned box or along a profile's line, tested one by one: by doubles where these are sure, exactly
// (exact_numbers.mjs) near the sides. A point is where a double of offset + scale × integer is, as every reader of the file has it.
import { readFile } from 'node:fs/promises';

import { abs, dot, exact, minus, norm, one, over, root, times, toNumber } from './exact_numbers.mjs';

/**
 * All points of a LAS file (ASPRS LAS 1.4, §2.6), as columns, for scans of millions: {count, x, y, z, scale, offset, placeOf(i),
 * values(i): what the record says beside the place, by LAS's names}.
 */
export async function readScan(path) {
    const bytes = await readFile(path);
    const start = bytes.readUInt32LE(96), format = bytes[104] & 0x3f, length = bytes.readUInt16LE(105);
    const count = bytes[25] >= 4 ? Number(bytes.readBigUInt64LE(247)) : bytes.readUInt32LE(107);
    if (bytes.toString('latin1', 0, 4) !== 'LASF' || bytes.length < start + count * length) throw new Error(`${path} is no whole LAS file`);
    const vector = (at) => [0, 8, 16].map((axis) => bytes.readDoubleLE(at + axis)), scale = vector(131), offset = vector(155);
    const column = (at) => Int32Array.from({ length: count }, (_, i) => bytes.readInt32LE(start + i * length + at));
    const [x, y, z] = [0, 4, 8].map(column);
    const isNew = format >= 6, colour = { 2: 20, 3: 28, 5: 28, 7: 30, 8: 30, 10: 30 }[format];
    const values = (i) => {
        const at = start + i * length, returns = bytes[at + 14];
        const rgb = colour === undefined ? [] : [0, 2, 4].map((channel) => bytes.readUInt16LE(at + colour + channel));
        return {
            Intensity: bytes.readUInt16LE(at + 12),
            'Return Number': isNew ? returns & 15 : returns & 7,
            'Number of Returns': isNew ? returns >> 4 : (returns >> 3) & 7,
            Classification: isNew ? bytes[at + 16] : bytes[at + 15] & 31,
            'Point Source ID': bytes.readUInt16LE(at + (isNew ? 20 : 18)),
            ...(rgb.length > 0 && { Red: rgb[0], Green: rgb[1], Blue: rgb[2] }),
        };
    };
    const placeOf = (i) => [offset[0] + scale[0] * x[i], offset[1] + scale[1] * y[i], offset[2] + scale[2] * z[i]];
    return { count, x, y, z, scale, offset, placeOf, values };
}

/** A point's integers and values, as text: for multisets. */
export function recordOf(scan, i) {
    return `${scan.x[i]} ${scan.y[i]} ${scan.z[i]} ${Object.values(scan.values(i)).join(' ')}`;
}

/** Is normal · (p - at) <= distance? `normal` and `distance` are exact, `at` and p doubles. */
function halfSpace(normal, at, distance) {
    const n = normal.map(toNumber), a = at.map(exact), bound = toNumber(distance), size = Math.hypot(...n);
    return (p) => {
        let off = -bound, reach = 0;
        for (let axis = 0; axis < n.length; axis++) {
            off += n[axis] * (p[axis] - at[axis]);
            reach += Math.abs(p[axis]) + Math.abs(at[axis]);
        }
        if (Math.abs(off) > 1e-12 * size * (reach + Math.abs(bound))) return off < 0;
        return dot(normal, minus(p.map(exact), a)) <= distance;
    };
}

/** Indices of the points in a clip box of a style. */
export function pointsInBox(scan, { centre, halfSize, axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]] }) {
    const sides = axes.flatMap((axis, a) =>
        [axis.map(exact), axis.map((value) => exact(-value))].map((normal) => halfSpace(normal, centre, exact(halfSize[a]))),
    );
    const found = [];
    for (let i = 0; i < scan.count; i++) {
        const p = scan.placeOf(i);
        if (sides.every((side) => side(p))) found.push(i);
    }
    return found;
}

const mitreLimit = 4n; // docs/API.md, /profile

/** The parts of a profile's corridor: segments, and what fills the corners' outsides. */
function partsOf(line, width) {
    const half = exact(width) / 2n, parts = [];
    let total = 0n;
    for (let i = 0; i + 1 < line.length; i++) {
        const station = total, a = line[i], b = line[i + 1], from = a.map(exact), d = minus(b.map(exact), from), length = norm(d);
        const left = [-d[1], d[0]], back = d.map((v) => -v), right = left.map((v) => -v), reach = times(half, length);
        if (i > 0) parts.push(...cornerOf(line[i - 1], a, b, half, station));
        const sides = [halfSpace(back, a, 0n), halfSpace(d, b, 0n), halfSpace(left, a, reach), halfSpace(right, a, reach)];
        const place = (p) => {
            const way = minus(p.map(exact), from);
            return { station: station + over(dot(d, way), length), offset: over(times(d[0], way[1]) - times(d[1], way[0]), length) };
        };
        parts.push({ sides, place });
        total += length;
    }
    return parts;
}

function cornerOf(before, at, after, half, station) {
    const [first, middle, last] = [before, at, after].map((p) => p.map(exact)), into = minus(middle, first), out = minus(last, middle);
    const [inLength, outLength] = [into, out].map(norm);
    const turn = times(into[0], out[1]) - times(into[1], out[0]);
    if (turn === 0n) return [];
    const side = turn > 0n ? -1n : 1n, outwards = ([x, y]) => [-side * y, side * x];
    const sides = [
        halfSpace(into.map((v) => -v), at, 0n),
        halfSpace(out, at, 0n),
        halfSpace(outwards(into), at, times(half, inLength)),
        halfSpace(outwards(out), at, times(half, outLength)),
    ];
    // The tip is cut off where it is too far away: at right angles to the way to it, through the rectangles' corners.
    const halfCosine = root((one + over(dot(into, out), times(inLength, outLength))) / 2n);
    if (halfCosine * mitreLimit < one) {
        const outward = minus(into.map((v) => over(v, inLength)), out.map((v) => over(v, outLength)));
        sides.push(halfSpace(outward, at, times(times(half, halfCosine), norm(outward))));
    }
    const place = (p) => ({ station, offset: side * norm(minus(p.map(exact), middle)) });
    return [{ sides, place }];
}

/** [{index, station, offset}] of the points along the line; the nearest of the parts that hold a point says where it is. */
export function pointsInCorridor(scan, line, width) {
    const parts = partsOf(line, width), found = [];
    for (let i = 0; i < scan.count; i++) {
        const p = scan.placeOf(i).slice(0, 2);
        const holding = parts.filter(({ sides }) => sides.every((side) => side(p)));
        if (holding.length === 0) continue;
        const places = holding.map(({ place }) => place(p));
        found.push({ index: i, ...places.reduce((best, place) => (abs(place.offset) < abs(best.offset) ? place : best)) });
    }
    return found;
}
