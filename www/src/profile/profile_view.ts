import type { ProfilePoints } from './profile_points.ts';

/** Where a profile's stations and heights are in its panel: pixels a unit across, and `exaggeration` times as many upwards. */
export interface ProfileView {
    width: number;
    height: number;
    /** Station at the left edge, height at the bottom one. */
    left: number;
    bottom: number;
    scale: number;
    exaggeration: number;
}

export const margin = { left: 56, bottom: 26, top: 8, right: 10 };

/** All of it, centred. */
export function fitted(
    size: { width: number; height: number },
    length: number,
    [low, high]: [number, number],
    exaggeration: number,
): ProfileView {
    const across = size.width - margin.left - margin.right, upwards = size.height - margin.bottom - margin.top;
    const rise = Math.max(high - low, length * 1e-3) * exaggeration;
    const scale = 0.95 * Math.min(across / length, upwards / rise);
    const view = { ...size, scale, exaggeration, left: 0, bottom: 0 };
    view.left = length / 2 - across / 2 / scale;
    view.bottom = (low + high) / 2 - upwards / 2 / scale / exaggeration;
    return view;
}

export function toPixels(view: ProfileView, station: number, height: number): { x: number; y: number } {
    return {
        x: margin.left + (station - view.left) * view.scale,
        y: view.height - margin.bottom - (height - view.bottom) * view.scale * view.exaggeration,
    };
}
export function toProfile(view: ProfileView, x: number, y: number): { station: number; height: number } {
    return {
        station: view.left + (x - margin.left) / view.scale,
        height: view.bottom + (view.height - margin.bottom - y) / view.scale / view.exaggeration,
    };
}

export function panned(view: ProfileView, dx: number, dy: number): ProfileView {
    return { ...view, left: view.left - dx / view.scale, bottom: view.bottom + dy / view.scale / view.exaggeration };
}
/** By `factor` (> 1 nearer); what is under the pointer stays. */
export function zoomed(view: ProfileView, factor: number, x: number, y: number): ProfileView {
    const at = toProfile(view, x, y), scale = view.scale * factor;
    const nearer = { ...view, scale }, then = toProfile(nearer, x, y);
    return { ...nearer, left: view.left + at.station - then.station, bottom: view.bottom + at.height - then.height };
}

/** Steps of 1, 2 or 5 × 10^n, at least `pixels` apart. */
export function ticks(from: number, to: number, unitsPerPixel: number, pixels = 60): number[] {
    const least = unitsPerPixel * pixels, power = 10 ** Math.floor(Math.log10(least));
    const step = [1, 2, 5, 10].map((part) => part * power).find((size) => size >= least)!;
    const result = [];
    for (let i = Math.ceil(from / step); i * step <= to; i++) result.push(Number((i * step).toPrecision(12)));
    return result;
}

/** Points as pixels in their colours, those that come later over those before. `ratio`: device pixels a CSS pixel. */
export function draw(
    points: ProfilePoints,
    colours: Uint32Array,
    view: ProfileView,
    image: ImageData,
    ratio: number,
    size = 2,
): void {
    const pixels = new Uint32Array(image.data.buffer), { width, height } = image;
    const side = Math.max(1, Math.round(size * ratio)), low = Math.floor((side - 1) / 2);
    for (let i = 0; i < points.count; i++) {
        const at = toPixels(view, points.station[i]!, points.height[i]!);
        const x0 = Math.round(at.x * ratio) - low, y0 = Math.round(at.y * ratio) - low;
        for (let y = Math.max(0, y0); y < Math.min(height, y0 + side); y++)
            for (let x = Math.max(0, x0); x < Math.min(width, x0 + side); x++) pixels[y * width + x] = colours[i]!;
    }
}

/** The point that shows nearest to a place, within `radius` pixels; -1: none. */
export function nearest(points: ProfilePoints, view: ProfileView, x: number, y: number, radius = 8): number {
    let best = -1, least = radius * radius;
    for (let i = 0; i < points.count; i++) {
        const at = toPixels(view, points.station[i]!, points.height[i]!);
        const square = (at.x - x) ** 2 + (at.y - y) ** 2;
        if (square <= least) {
            least = square;
            best = i;
        }
    }
    return best;
}
