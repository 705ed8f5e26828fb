import type { MeasureKind } from '../wasm/values.ts';
import type { Measurement } from './measurement.ts';
import { type DisplayUnit, formatValue, inUnit, unitSymbol } from './units.ts';

/** A line of a result: 'Distance', '12.34 m', '0.05 m'. */
export interface ResultLine {
    name: string;
    /** Its field in the answer. */
    field: string;
    value: string;
    /** Standard deviation, with its unit; none where it is not known. */
    deviation?: string;
}

/** What is shown of each kind, the most wanted first; 0: degrees, 1 to 3: powers of the unit of length. */
const fields: Record<MeasureKind, [field: string, name: string, power: number][]> = {
    point: [],
    distance: [
        ['distance', 'Distance', 1],
        ['horizontal', 'Horizontal', 1],
        ['vertical', 'Vertical', 1],
    ],
    height: [
        ['height', 'Height', 1],
        ['horizontal', 'Horizontal', 1],
    ],
    azimuth: [
        ['azimuth', 'Azimuth', 0],
        ['gradient', 'Gradient', 0],
        ['distance', 'Distance', 1],
    ],
    angle: [['angle', 'Angle', 0]],
    area: [
        ['horizontal', 'Area in plan', 2],
        ['inPlane', 'Area in its plane', 2],
        ['perimeter', 'Perimeter', 1],
        ['deviation', 'Off the plane', 1],
    ],
    circle: [
        ['radius', 'Radius', 1],
        ['diameter', 'Diameter', 1],
        ['circumference', 'Circumference', 1],
        ['area', 'Area', 2],
    ],
};

export function resultLines(measurement: Measurement, unit: DisplayUnit): ResultLine[] {
    const { kind, points, answer } = measurement;
    if (!answer) return [];
    if (kind === 'point')
        return points[0]!.position.map((value, axis) => ({
            name: 'XYZ'[axis]!,
            field: 'XYZ'[axis]!,
            value: String(value),
        }));
    return fields[kind].flatMap(([field, name, power]) => {
        const value = answer[field], deviation = answer[`±${field}`];
        if (typeof value !== 'number') return [];
        const shown = (number: number): number => (power === 0 ? number : inUnit(number, power, points[0]!, unit));
        const symbol = power === 0 ? '°' : ` ${unitSymbol(power, points[0]!, unit)}`;
        const off = typeof deviation === 'number' && deviation > 0 ? shown(deviation) : undefined;
        return {
            name,
            field,
            value: formatValue(shown(value), off) + symbol,
            ...(off !== undefined && { deviation: formatValue(off, off) + symbol }),
        };
    });
}
