/** How handles over the picture follow the pointer. Steps and directions are in CSS pixels. */

export type Place = { x: number; y: number };

/** World units along two directions for a step of the pointer, where these show as `a` and `b` (pixels a unit); none if they show as one line. */
export function inPlane(step: Place, a: Place, b: Place): [number, number] | undefined {
    const area = a.x * b.y - a.y * b.x;
    if (Math.abs(area) < 0.02 * Math.hypot(a.x, a.y) * Math.hypot(b.x, b.y) || area === 0) return undefined;
    return [(step.x * b.y - step.y * b.x) / area, (a.x * step.y - a.y * step.x) / area];
}

/** World units along one direction that shows as `a`. */
export function along(step: Place, a: Place): number {
    const square = a.x * a.x + a.y * a.y;
    return square > 1e-12 ? (step.x * a.x + step.y * a.y) / square : 0;
}
