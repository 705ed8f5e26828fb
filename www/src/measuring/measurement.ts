import type { MeasureAnswer, MeasureKind, MeasureRequest, PlacedPoint } from '../wasm/values.ts';

/** Something that was measured: exact points of clouds, and what client/survey says of them. */
export interface Measurement {
    id: number;
    kind: MeasureKind;
    name: string;
    hidden: boolean;
    points: PlacedPoint[];
    /** Absent while there are too few points. */
    answer?: MeasureAnswer;
    /** Why there is no answer. */
    error?: string;
}

export interface KindOfMeasurement {
    kind: MeasureKind;
    label: string;
    /** With so many points it is complete; none: as many as the person wants. */
    points?: number;
    least: number;
    isClosed?: boolean;
}

export const kindsOfMeasurement: KindOfMeasurement[] = [
    { kind: 'distance', label: 'Distance', least: 2 },
    { kind: 'height', label: 'Height', least: 2, points: 2 },
    { kind: 'area', label: 'Area', least: 3, isClosed: true },
    { kind: 'angle', label: 'Angle', least: 3, points: 3 },
    { kind: 'circle', label: 'Circle', least: 3, points: 3 },
    { kind: 'azimuth', label: 'Azimuth', least: 2, points: 2 },
    { kind: 'point', label: 'Point', least: 1, points: 1 },
];

export function kindOf(kind: MeasureKind): KindOfMeasurement {
    return kindsOfMeasurement.find((known) => known.kind === kind)!;
}

export function requestOf({ kind, points }: Measurement): MeasureRequest {
    return {
        kind,
        geocentric: points[0]?.geocentric ?? false,
        points: points.map(({ integers, scale, offset, spacing }) => ({ integers, scale, offset, spacing })),
    };
}

/** Why nothing can be measured of such points, whatever the kind; none if it can. */
export function obstacleOf({ kind, points }: Measurement): string | undefined {
    if (kind === 'point') return undefined;
    if (points.some((point) => isAngular(point)))
        return 'The coordinates are degrees: there is no distance between them. Convert the cloud to a projected coordinate system.';
    if (points.some((point) => point.crs !== points[0]!.crs))
        return `The points are of different coordinate systems: ${[...new Set(points.map(({ crs }) => crs || 'none'))].join(' and ')}.`;
    return undefined;
}

function isAngular(point: PlacedPoint): boolean {
    return point.unitMeters === 0 && /deg|rad|grad/i.test(point.unit);
}
