import type { ProfilePoints } from './profile_points.ts';

/** Ways from a point to its neighbours: along the line, or up and down beside it. */
export type CursorWay = 'back' | 'on' | 'up' | 'down';

/**
 * The next point in a way: by station, or, of the points whose station is at most `slack` away, by height; equal ones go by their
 * index, so that steps come to each. `at` itself where there is none further.
 */
export function neighbour(points: ProfilePoints, at: number, way: CursorWay, slack: number): number {
    const isAlong = way === 'on' || way === 'back', sign = way === 'on' || way === 'up' ? 1 : -1;
    const { station } = points, values = isAlong ? station : points.height;
    const isBeyond = (i: number, j: number): boolean => sign * (values[i]! - values[j]! || i - j) > 0;
    let next = at;
    for (let i = 0; i < points.count; i++) {
        if (!isAlong && Math.abs(station[i]! - station[at]!) > slack) continue;
        if (isBeyond(i, at) && (next === at || isBeyond(next, i))) next = i;
    }
    return next;
}
