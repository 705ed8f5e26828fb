import type { CloudClass, Vector } from '../wasm/values.ts';
import type { ProfilePoints } from './profile_points.ts';

export type ProfileColour = 'rgb' | 'elevation' | 'classification' | 'returnNumber' | 'intensity';

/** What colours are made of: a gradient from low values to high, and the classes that there are. */
export interface Palette {
    gradient: Vector[];
    classes: CloudClass[];
}

const plain = wordOf([200, 200, 200]);
/** Of a gradient. */
const entries = 256;

/** A colour for each point, 0xAABBGGRR. What goes along the gradient spans the profile's own values. */
export function coloursOf(points: ProfilePoints, mode: ProfileColour, palette: Palette): Uint32Array {
    if (mode === 'rgb') return points.colour;
    if (mode === 'classification') return classColours(points, palette.classes);
    const values = { elevation: points.height, returnNumber: points.returnNumber, intensity: points.intensity }[mode];
    const [low, high] = mode === 'intensity' ? usualRange(values, points.count) : rangeOf(values, points.count);
    return alongGradient(values, points.count, low, high, palette.gradient);
}

function classColours(points: ProfilePoints, classes: CloudClass[]): Uint32Array {
    const table = new Uint32Array(256).fill(plain);
    for (const one of classes) table[one.class] = wordOf(one.colour);
    return Uint32Array.from(points.classification.subarray(0, points.count), (at) => table[at]!);
}

function alongGradient(values: ArrayLike<number>, count: number, low: number, high: number, stops: Vector[]): Uint32Array {
    const table = Uint32Array.from({ length: entries }, (_, i) => mixed(stops, i / (entries - 1)));
    const scale = (entries - 1) / (high > low ? high - low : 1), colours = new Uint32Array(count);
    for (let i = 0; i < count; i++)
        colours[i] = table[Math.round(Math.min(entries - 1, Math.max(0, (values[i]! - low) * scale)))]!;
    return colours;
}

/** At a part, 0 to 1, of the way through the stops. */
function mixed(stops: Vector[], part: number): number {
    const at = part * (stops.length - 1), from = Math.min(stops.length - 2, Math.floor(at)), share = at - from;
    return wordOf(stops[from]!.map((level, i) => Math.round(level + share * (stops[from + 1]![i]! - level))) as Vector);
}

function rangeOf(values: ArrayLike<number>, count: number): [number, number] {
    let low = Infinity, high = -Infinity;
    for (let i = 0; i < count; i++) {
        low = Math.min(low, values[i]!);
        high = Math.max(high, values[i]!);
    }
    return [low, high];
}

/** Mean and two standard deviations, within what there is: as the picture's own range of intensities (docs/STYLE.md). */
function usualRange(values: ArrayLike<number>, count: number): [number, number] {
    let sum = 0, squares = 0;
    for (let i = 0; i < count; i++) sum += values[i]!;
    const mean = sum / Math.max(1, count);
    for (let i = 0; i < count; i++) squares += (values[i]! - mean) ** 2;
    const reach = 2 * Math.sqrt(squares / Math.max(1, count)), [low, high] = rangeOf(values, count);
    return [Math.max(low, mean - reach), Math.min(high, mean + reach)];
}

function wordOf([red, green, blue]: Vector): number {
    return (0xff000000 | (blue << 16) | (green << 8) | red) >>> 0;
}
