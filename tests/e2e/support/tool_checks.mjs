// Results of the page's tools against what is right (exact_answers.mjs, exact_volume.mjs, exact_regions.mjs) and against what the native
// program says of the same points: how far each is off, as a part of its own size or of the one that matters for it.
import { spawn } from 'node:child_process';
import { readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';

import { exactAnswer, exactCentre, localPoints, placeOf } from './exact_answers.mjs';
import { abs, absoluteError, exact, relativeError, toNumber } from './exact_numbers.mjs';
import { pointsInCorridor, readScan, recordOf } from './exact_regions.mjs';
import { exactVolume, pointsInPolygon } from './exact_volume.mjs';
import { root, stipple } from './program.mjs';

/** No result may be off by more; world coordinates (positions, centres) by two roundings of a double. */
export const bound = 1e-12;
const worldBound = 2 ** -51;

/** Answers of tests/e2e/native_answers.cpp, in the order of the requests. */
export async function nativeAnswers(cloud, requests) {
    const program = process.env.STIPPLE_NATIVE_ANSWERS ?? join(root, 'build/release/tests/e2e/native_answers');
    const child = spawn(program, [cloud], { stdio: ['pipe', 'pipe', 'inherit'] });
    let said = '';
    child.stdout.on('data', (chunk) => (said += chunk));
    child.stdin.end(requests.map((request) => `${JSON.stringify(request)}\n`).join(''));
    const code = await new Promise((resolve, reject) => child.once('close', resolve).once('error', reject));
    const answers = said.split('\n').filter(Boolean).map((line) => JSON.parse(line));
    if (code !== 0 || answers.length !== requests.length) throw new Error(`native_answers ended with ${code} after ${answers.length} answers`);
    return answers;
}

/** What the page asked its program about an item. */
export function requestOf({ kind, points, base = { from: 'rim' } }) {
    const corner = ({ integers, scale, offset, spacing }) => ({ integers, scale, offset, spacing });
    const request = { geocentric: false, points: points.map(corner) };
    if (kind !== 'volume') return { kind, ...request };
    const bases = { rim: () => 'rim', height: () => ({ height: base.height }), point: () => ({ point: corner(base.point) }) };
    return { make: 'volume', ...request, base: bases[base.from]() };
}

/** [{field, off, bound}]: each number of an answer against the right one. */
export function errorsOf(item, scan) {
    const { kind, points, answer } = item;
    if (kind === 'point') return worldErrors('position', answer.position, placeOf(points[0]));
    if (kind === 'volume') return volumeErrors(item, scan);
    const right = exactAnswer(kind, points);
    const errors = Object.entries(right).map(([field, value]) => ({ field, off: offOf(kind, field, answer[field], value, right), bound }));
    return kind === 'circle' ? [...errors, ...worldErrors('centre', answer.centre, exactCentre(points), answer.radius)] : errors;
}

const angles = ['azimuth', 'gradient', 'angle'];

/** Angles: in half turns; how far corners lie off their plane: as a part of the perimeter; anything else of itself. */
function offOf(kind, field, found, right, all) {
    if (angles.includes(field)) return absoluteError(found, right) / 180;
    if (field === 'deviation') return absoluteError(found, right) / toNumber(all.perimeter);
    return relativeError(found, right);
}

/** `size`: of what the coordinate was computed from, where that is more than itself. */
function worldErrors(name, found, right, size = 0) {
    const offs = found.map((value, axis) => absoluteError(value, right[axis]) / Math.max(Math.abs(value), size));
    return offs.map((off, axis) => ({ field: `${name} ${'xyz'[axis]}`, off, bound: worldBound }));
}

/** Cut, fill and net as parts of all that is moved; points counted exactly. */
function volumeErrors({ points, answer, base = { from: 'rim' } }, scan) {
    const height = base.from === 'height' ? exact(base.height) : base.from === 'point' ? placeOf(base.point)[2] : undefined;
    const level = height === undefined ? undefined : height - placeOf(points[0])[2];
    const right = exactVolume(localPoints(points), pointsInPolygon(scan, points), level), moved = toNumber(right.cut + right.fill);
    return [
        ...['cut', 'fill', 'net'].map((field) => ({ field, off: absoluteError(answer[field], right[field]) / moved, bound })),
        ...['area', 'cell'].map((field) => ({ field, off: relativeError(answer[field], right[field]), bound })),
        { field: 'pointsInside', off: Math.abs(answer.pointsInside - right.pointsInside), bound: 0 },
    ];
}

/** The largest difference of any number from that of the native program's answer, deviations included, likewise. */
export function differenceFromNative(answer, native) {
    const differences = Object.entries(native).flatMap(([field, value]) => {
        const size = field === 'deviation' ? native.perimeter : field === 'normal' ? 1 : 0;
        const numbers = (of) => (typeof of === 'number' ? [of] : of && typeof of === 'object' ? Object.values(of).flatMap(numbers) : []);
        const [found, right] = [numbers(answer[field]), numbers(value)];
        if (found.length !== right.length) return [Infinity];
        return found.map((one, i) => (one === right[i] ? 0 : Math.abs(one - right[i]) / (size || Math.abs(right[i]))));
    });
    return native.error || differences.length === 0 ? Infinity : Math.max(...differences);
}

/** Fields that a picked point has and the scan has otherwise; the point has to be in the scan. */
export function recordDifferences(point, scan) {
    const [x, y, z] = point.integers;
    for (let i = 0; i < scan.count; i++) {
        if (scan.x[i] !== x || scan.y[i] !== y || scan.z[i] !== z) continue;
        const values = scan.values(i), names = Object.keys(values).filter((name) => name in point.values);
        if (names.length > 0 && names.every((name) => values[name] === point.values[name])) return 0;
    }
    return 1;
}

/** How many are in one list and not in the other, each as often as it is there. */
export function multisetDifference(a, b) {
    const counts = new Map();
    for (const one of a) counts.set(one, (counts.get(one) ?? 0) + 1);
    for (const one of b) counts.set(one, (counts.get(one) ?? 0) - 1);
    return [...counts.values()].reduce((sum, count) => sum + Math.abs(count), 0);
}

const allRecords = (scan) => Array.from({ length: scan.count }, (_, i) => recordOf(scan, i));
const scratch = (folder, name) => join(folder, name);

/**
 * Points of a LAS file at `address` against those of `right` (indices of the scan) and those that `stipple export` writes of the region:
 * {points, off, native}, the last two numbers of points that differ.
 */
export async function exportDifferences(address, right, region, { scan, cloud, folder }) {
    const response = await fetch(address);
    if (!response.ok) throw new Error(`${address}: ${response.status}`);
    await writeFile(scratch(folder, 'clip.las'), Buffer.from(await response.arrayBuffer()));
    const found = allRecords(await readScan(scratch(folder, 'clip.las')));
    await stipple('export', cloud, '-o', scratch(folder, 'native.las'), '--force', '--region', JSON.stringify(region));
    const native = allRecords(await readScan(scratch(folder, 'native.las')));
    const off = multisetDifference(found, right.map((i) => recordOf(scan, i)));
    return { points: right.length, off, native: multisetDifference(found, native) };
}

async function profileRows(text, scan) {
    const [head, ...lines] = text.trim().split(/\r?\n/), names = head.split(',');
    const at = ['X', 'Y', 'Z', 'Station', 'Offset'].map((name) => names.indexOf(name));
    return lines.map((line) => {
        const fields = line.split(',').map(Number), [x, y, z, station, offset] = at.map((i) => fields[i]);
        const steps = [x, y, z].map((value, axis) => Math.round((value - scan.offset[axis]) / scan.scale[axis]));
        return { key: steps.join(' '), station, offset };
    });
}

/** A profile's points as CSV at `address`: the numbers of points that differ, and how far places along the line are off, as parts of its length. */
export async function profileDifferences(address, line, width, scan, cloud, folder) {
    const response = await fetch(address);
    if (!response.ok) throw new Error(`${address}: ${response.status}`);
    const text = await response.text(), found = await profileRows(text, scan);
    const right = pointsInCorridor(scan, line.map((p) => p.slice(0, 2)), width);
    const keyOf = (i) => `${scan.x[i]} ${scan.y[i]} ${scan.z[i]}`;
    const places = new Map(right.map((point) => [keyOf(point.index), point]));
    const length = line.slice(1).reduce((sum, p, i) => sum + Math.hypot(p[0] - line[i][0], p[1] - line[i][1]), 0);
    let offPlace = 0;
    for (const { key, station, offset } of found) {
        const place = places.get(key);
        if (place) offPlace = Math.max(offPlace, toNumber(abs(exact(station) - place.station)) / length, toNumber(abs(exact(offset) - place.offset)) / length);
    }
    const way = line.map(([x, y]) => `${x},${y}`).join(';'), file = scratch(folder, 'native.csv');
    await stipple('export', cloud, '-o', file, '--force', '--profile', way, '--width', String(width));
    const native = await profileRows(await readFile(file, 'utf8'), scan);
    const exactly = ({ key, station, offset }) => `${key} ${station} ${offset}`;
    return {
        points: right.length,
        off: multisetDifference(found.map(({ key }) => key), right.map(({ index }) => keyOf(index))),
        offPlace,
        native: multisetDifference(found.map(exactly), native.map(exactly)),
    };
}
