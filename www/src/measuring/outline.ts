import type { PlacedPoint, Vector } from '../wasm/values.ts';
import type { Measurement } from './measurement.ts';

/** What a map shows of a measurement: its points, or the corners that bound a box in plan, counter-clockwise. */
export function outlineOf({ box, points }: Measurement): PlacedPoint[] {
    return box ? hull(points) : points;
}

/** In plan (Andrew, "Another efficient algorithm for convex hulls in two dimensions", 1979). */
function hull(points: PlacedPoint[]): PlacedPoint[] {
    const sorted = [...points].sort(({ position: a }, { position: b }) => a[0] - b[0] || a[1] - b[1]);
    const half = (row: PlacedPoint[]): PlacedPoint[] => {
        const chain: PlacedPoint[] = [];
        for (const point of row) {
            while (chain.length > 1 && !turnsLeft(chain.at(-2)!.position, chain.at(-1)!.position, point.position)) chain.pop();
            chain.push(point);
        }
        return chain.slice(0, -1);
    };
    return [...half(sorted), ...half(sorted.reverse())];
}

function turnsLeft(a: Vector, b: Vector, c: Vector): boolean {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0;
}
