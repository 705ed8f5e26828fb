import type { ClipBox, RegionOf, Vector } from '../wasm/values.ts';

/** Clip boxes as a person edits them. Values, never changed: each step gives another box. World units, degrees. */

const unturned: [Vector, Vector, Vector] = [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
];
/** A side is never shorter than this part of what it was. */
const leastPart = 1e-3;

export function axesOf(box: ClipBox): [Vector, Vector, Vector] {
    return box.axes ?? unturned;
}

/** How far it is turned about z, counter-clockwise, -180..180; undefined if it is turned in another way. */
export function headingOf(box: ClipBox): number | undefined {
    const [x, , z] = axesOf(box);
    if (Math.hypot(z[0], z[1], z[2] - 1) > 1e-6) return undefined;
    return (Math.atan2(x[1], x[0]) * 180) / Math.PI;
}

export function withHeading(box: ClipBox, degrees: number): ClipBox {
    const [c, s] = directionOf(degrees);
    const { rotation: _, ...rest } = box;
    return {
        ...rest,
        axes: [
            [c, s, 0],
            [s === 0 ? 0 : -s, c, 0],
            [0, 0, 1],
        ],
    };
}

/** Its own `axis` goes so far towards another of its axes, and that away from it; the third stays. */
export function turnedAbout(box: ClipBox, axis: number, towards: number, degrees: number): ClipBox {
    const axes = axesOf(box), a = axes[axis]!, b = axes[towards]!, [c, s] = directionOf(degrees);
    const first = unit(a.map((value, i) => c * value + s * b[i]!)), second = b.map((value, i) => c * value - s * a[i]!);
    const off = second.reduce((sum, value, i) => sum + value * first[i]!, 0); // of rounding
    const { rotation: _, ...rest } = box, next = [...axes] as typeof axes;
    next[axis] = first;
    next[towards] = unit(second.map((value, i) => value - off * first[i]!));
    return { ...rest, axes: next };
}

function unit(v: number[]): Vector {
    const length = Math.hypot(...v);
    return v.map((value) => value / length) as Vector;
}

/** Cosine and sine; of right angles exactly, as the server's boxes are turned (shared/geometry/oriented_box.hpp). */
function directionOf(degrees: number): [number, number] {
    const quarters = (((degrees / 90) % 4) + 4) % 4, radians = (degrees * Math.PI) / 180;
    const exactly: [number, number][] = [[1, 0], [0, 1], [-1, 0], [0, -1]];
    return exactly[quarters] ?? [Math.cos(radians), Math.sin(radians)];
}

/** The side along `axis` at its end `sign` (1 or -1) goes outwards by `way`; the opposite side stays. */
export function withFaceMoved(box: ClipBox, axis: number, sign: number, way: number): ClipBox {
    const half = box.halfSize[axis]!, next = Math.max(half * leastPart, half + way / 2);
    const along = axesOf(box)[axis]!;
    return {
        ...box,
        halfSize: replaced(box.halfSize, axis, next),
        centre: box.centre.map((value, i) => value + along[i]! * sign * (next - half)) as Vector,
    };
}

export function withCentre(box: ClipBox, centre: Vector): ClipBox {
    return { ...box, centre };
}

/** `size`: full, along its own axes. */
export function withSize(box: ClipBox, axis: number, size: number): ClipBox {
    return { ...box, halfSize: replaced(box.halfSize, axis, size / 2) };
}

/** A place by its coordinates along the box's axes from its centre. */
export function placeIn(box: ClipBox, along: Vector): Vector {
    const axes = axesOf(box);
    return box.centre.map(
        (value, i) => value + along[0] * axes[0][i]! + along[1] * axes[1][i]! + along[2] * axes[2][i]!,
    ) as Vector;
}

/** The eight corners, x running fastest, and the twelve edges between them. */
export function cornersOf(box: ClipBox): Vector[] {
    const [x, y, z] = box.halfSize;
    return Array.from({ length: 8 }, (_, i) =>
        placeIn(box, [i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z]),
    );
}
export const edges: [number, number][] = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((corner) =>
    [1, 2, 4].filter((bit) => !(corner & bit)).map((bit): [number, number] => [corner, corner | bit]),
);

/** What it holds, as a region that the page reads. */
export function regionOf(box: ClipBox): RegionOf {
    return { box: { centre: box.centre, halfSize: box.halfSize, axes: axesOf(box) } };
}

function replaced(vector: Vector, axis: number, value: number): Vector {
    return vector.map((old, i) => (i === axis ? value : old)) as Vector;
}
