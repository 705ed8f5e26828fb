/** How handles over the picture follow the pointer. Steps and directions are in CSS pixels. */

export type Place = { x: number; y: number };

/** Something over the picture that is dragged, or moved by keys: a corner, a side, a knob. */
export interface Handle {
    /** What it is, and which. */
    kind: 'face' | 'handle' | 'corner' | 'new';
    which: string;
    /** For those who do not see it. */
    label: string;
    /** CSS pixels of the canvas. */
    at: Place;
    /** It, or the pointer that has it, goes on by a step; `event` has where the pointer is. */
    move(step: Place, event?: PointerEvent): void;
    /** Delete, or a double click. */
    remove?(): void;
    /** Of what is not there yet: makes it. */
    make?(): void;
}

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
