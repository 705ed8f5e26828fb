import type { Key } from '../texts/message.ts';
import type { Texts } from '../texts/texts.ts';
import type { MeasureKind } from '../wasm/values.ts';
import type { Measurement } from './measurement.ts';
import { decimalsOf, type DisplayUnit, inUnit, unitSymbol } from './units.ts';

type ResultKey = Extract<Key, `result.${string}`>;

/** A line of a result: 'Distance', '12.34 m', '0.05 m'. */
export interface ResultLine {
    name: string;
    /** Its field in the answer. */
    field: string;
    value: string;
    /** Standard deviation, with its unit; none where it is not known. */
    deviation?: string;
}

/** What is shown of each kind, the most wanted first; 0: degrees, 1 to 3: powers of the unit of length, 'count': a number of things. */
const fields: Record<MeasureKind, [field: string, name: ResultKey, power: number | 'count'][]> = {
    point: [],
    distance: [
        ['distance', 'result.distance', 1],
        ['horizontal', 'result.horizontal', 1],
        ['vertical', 'result.vertical', 1],
    ],
    height: [
        ['height', 'result.height', 1],
        ['horizontal', 'result.horizontal', 1],
    ],
    azimuth: [
        ['azimuth', 'result.azimuth', 0],
        ['gradient', 'result.gradient', 0],
        ['distance', 'result.distance', 1],
    ],
    angle: [['angle', 'result.angle', 0]],
    area: [
        ['horizontal', 'result.areaInPlan', 2],
        ['inPlane', 'result.areaInPlane', 2],
        ['perimeter', 'result.perimeter', 1],
        ['deviation', 'result.offPlane', 1],
    ],
    volume: [
        ['net', 'result.net', 3],
        ['cut', 'result.cut', 3],
        ['fill', 'result.fill', 3],
        ['area', 'result.areaInPlan', 2],
        ['areaWithoutPoints', 'result.areaWithoutPoints', 2],
        ['cell', 'result.cell', 1],
    ],
    box: [
        ['volume', 'result.volume', 3],
        ['width', 'result.width', 1],
        ['depth', 'result.depth', 1],
        ['height', 'result.height', 1],
        ['pointsInside', 'result.pointsInside', 'count'],
    ],
    circle: [
        ['radius', 'result.radius', 1],
        ['diameter', 'result.diameter', 1],
        ['circumference', 'result.circumference', 1],
        ['area', 'result.area', 2],
    ],
};

export function resultLines(measurement: Measurement, unit: DisplayUnit, texts: Texts): ResultLine[] {
    const { kind, points, answer } = measurement;
    if (!answer) return [];
    if (kind === 'point')
        return points[0]!.position.map((value, axis) => ({
            name: 'XYZ'[axis]!,
            field: 'XYZ'[axis]!,
            value: texts.number(value),
        }));
    return fields[kind].flatMap(([field, name, power]) => {
        const value = answer[field], deviation = answer[`±${field}`];
        if (typeof value !== 'number') return [];
        if (power === 'count') return { name: texts.text(name), field, value: texts.count(value) };
        const shown = (number: number): number => (power === 0 ? number : inUnit(number, power, points[0]!, unit));
        const symbol = power === 0 ? '°' : ` ${unitSymbol(power, points[0]!, unit)}`;
        const off = typeof deviation === 'number' && deviation > 0 ? shown(deviation) : undefined;
        return {
            name: texts.text(name),
            field,
            value: texts.decimals(shown(value), decimalsOf(off)) + symbol,
            ...(off !== undefined && { deviation: texts.decimals(off, decimalsOf(off)) + symbol }),
        };
    });
}
