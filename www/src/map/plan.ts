import type { Camera, Vector } from '../wasm/values.ts';

/** What a map shows of a cloud and a camera, in the cloud's coordinates; pure. */

const pointsASide = 16;

export interface Bounds {
    min: Vector;
    max: Vector;
}

/** The bounds from above, as a ring with points along its sides, so that it stays true where a projection bends them. */
export function footprint({ min, max }: Bounds): Vector[] {
    const corners: [number, number][] = [
        [min[0], min[1]],
        [max[0], min[1]],
        [max[0], max[1]],
        [min[0], max[1]],
    ];
    return corners.flatMap(([x, y], side) => {
        const [endX, endY] = corners[(side + 1) % 4]!;
        return Array.from({ length: pointsASide }, (_, i): Vector => {
            const t = i / pointsASide;
            return [x + t * (endX - x), y + t * (endY - y), min[2]];
        });
    });
}

/** The corners of geocentric bounds: what of the earth lies under them is the hull of these. */
export function boxCorners({ min, max }: Bounds): Vector[] {
    return Array.from({ length: 8 }, (_, i): Vector => [
        (i & 1 ? max : min)[0],
        (i & 2 ? max : min)[1],
        (i & 4 ? max : min)[2],
    ]);
}

/** Counter-clockwise (Andrew's monotone chain, 1979). */
export function convexHull(places: [number, number][]): [number, number][] {
    const sorted = [...places].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
    const turn = (o: [number, number], a: [number, number], b: [number, number]): number =>
        (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
    const half = (from: [number, number][]): [number, number][] => {
        const chain: [number, number][] = [];
        for (const place of from) {
            while (chain.length > 1 && turn(chain.at(-2)!, chain.at(-1)!, place) <= 0) chain.pop();
            chain.push(place);
        }
        return chain.slice(0, -1);
    };
    return [...half(sorted), ...half(sorted.reverse())];
}

const add = (a: Vector, b: Vector, times = 1): Vector => [a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2]];
const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = ([a, b, c]: Vector, [x, y, z]: Vector): Vector => [b * z - c * y, c * x - a * z, a * y - b * x];
const unit = (v: Vector): Vector => {
    const length = Math.hypot(...v);
    return length > 0 ? [v[0] / length, v[1] / length, v[2] / length] : v;
};

/** East, north and up at a place; of geocentric coordinates on a sphere, which is near enough for a direction. */
export function axesAt(place: Vector, geocentric: boolean): [Vector, Vector, Vector] {
    const up: Vector = geocentric ? unit(place) : [0, 0, 1];
    const east: Vector = geocentric ? unit(cross([0, 0, 1], up)) : [1, 0, 0];
    return [east, cross(up, east), up];
}

/**
 * What the camera sees from above, as a triangle from where it stands over the width of its view, as far as its target;
 * looking down, or orthographic, the rectangle around the target.
 */
export function viewCone(camera: Camera, aspect: number, geocentric: boolean): Vector[] {
    const { position, target, projection, fovYDegrees, orthoHeight } = camera;
    const [, , up] = axesAt(target, geocentric);
    const sight = add(target, position, -1), distance = Math.hypot(...sight);
    const level = add(sight, up, -dot(sight, up)), reach = Math.hypot(...level);
    const slope = Math.tan((fovYDegrees * Math.PI) / 360);
    const height = projection === 'orthographic' ? orthoHeight : 2 * slope * distance;
    if (projection === 'orthographic' || reach < 0.3 * distance) {
        const ahead = unit(reach > 1e-6 * distance ? level : add(camera.up, up, -dot(camera.up, up)));
        const forward = Math.hypot(...ahead) > 0 ? ahead : axesAt(target, geocentric)[1];
        const right = cross(forward, up);
        return [
            [-1, -1],
            [1, -1],
            [1, 1],
            [-1, 1],
        ].map(([x, y]) => add(add(target, right, (x! * aspect * height) / 2), forward, (y! * height) / 2));
    }
    const right = unit(cross(level, up)), half = slope * aspect;
    const end = add(position, level);
    return [position, add(end, right, reach * half), add(end, right, -reach * half)];
}

/** The camera that looks at another place in the same way: east stays east, and up up. */
export function movedTo(camera: Camera, target: Vector, geocentric: boolean): Camera {
    const from = axesAt(camera.target, geocentric), to = axesAt(target, geocentric);
    const turned = (v: Vector): Vector =>
        from.reduce<Vector>((sum, axis, i) => add(sum, to[i]!, dot(v, axis)), [0, 0, 0]);
    return {
        ...camera,
        target,
        position: add(target, turned(add(camera.position, camera.target, -1))),
        up: turned(camera.up),
    };
}
