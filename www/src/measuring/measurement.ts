import type { Texts } from '../texts/texts.ts';
import type { ClipBox, MeasureAnswer, MeasureKind, MeasureRequest, PlacedPoint } from '../wasm/values.ts';

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
    /** Of a volume: what heights are taken from. */
    base?: VolumeBase;
    /** Of a box, whose corners are its points (in the order of clipping/boxes.ts). */
    box?: MeasuredBox;
    /** Of a volume or a box whose points are being read: 0..1. */
    share?: number;
}

/** The plane through its corners' triangles; a level one at a height of the cloud's, or at a point that was picked. */
export type VolumeBase = { from: 'rim' } | { from: 'height'; height: number } | { from: 'point'; point: PlacedPoint };

export type MeasuredBox = Omit<ClipBox, 'mode'>;

export interface KindOfMeasurement {
    kind: MeasureKind;
    /** No tool picks its points: it is made of something else. */
    isMade?: boolean;
    /** With so many points it is complete; none: as many as the person wants. */
    points?: number;
    least: number;
    isClosed?: boolean;
}

export const kindsOfMeasurement: KindOfMeasurement[] = [
    { kind: 'distance', least: 2 },
    { kind: 'height', least: 2, points: 2 },
    { kind: 'area', least: 3, isClosed: true },
    { kind: 'angle', least: 3, points: 3 },
    { kind: 'circle', least: 3, points: 3 },
    { kind: 'azimuth', least: 2, points: 2 },
    { kind: 'point', least: 1, points: 1 },
    { kind: 'volume', least: 3, isClosed: true },
    { kind: 'box', least: 8, points: 8, isMade: true },
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
export function obstacleOf({ kind, points }: Measurement, texts: Texts): string | undefined {
    if (kind === 'point') return undefined;
    if (points.some((point) => isAngular(point)))
        return texts.text('measure.angular');
    if (points.some((point) => point.crs !== points[0]!.crs))
        return texts.text('measure.differentSystems', { systems: texts.list(systems(points, texts)) });
    return undefined;
}

function systems(points: PlacedPoint[], texts: Texts): string[] {
    return [...new Set(points.map(({ crs }) => crs || texts.text('measure.noSystem')))];
}

function isAngular(point: PlacedPoint): boolean {
    return point.unitMeters === 0 && /deg|rad|grad/i.test(point.unit);
}
