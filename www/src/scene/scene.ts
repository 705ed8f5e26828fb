import type { Annotation } from '../annotations/annotation.ts';
import type { Measurement } from '../measuring/measurement.ts';
import type { DisplayUnit } from '../measuring/units.ts';
import type { NavigationMode } from '../navigation/navigator.ts';
import type { Camera, Keyframe, Limits, MeasureKind, PlacedPoint, Style } from '../wasm/values.ts';

/**
 * What a person has set up, as JSON: clouds, camera, looks, measurements. A reader of a later version reads earlier ones;
 * fields that are absent have their defaults, fields that nobody knows are an error. www/public/scene.schema.json is its JSON Schema.
 */
export const sceneVersion = 2;

export interface SceneCloud {
    /** Of the file, absolute or relative to the page; or the name of a file that has to be opened by hand. */
    address?: string;
    file?: string;
    name: string;
    visible: boolean;
}

export interface SceneMeasurement {
    kind: MeasureKind;
    name: string;
    hidden: boolean;
    /** `point.cloud` is an index of the scene's clouds, -1 for one that is not among them. */
    points: PlacedPoint[];
}

export interface Scene {
    stipple: 'scene';
    version: number;
    clouds: SceneCloud[];
    camera: Camera;
    /** What differs from the defaults. */
    style: Partial<Style>;
    limits: Partial<Limits>;
    navigation: NavigationMode;
    unit: DisplayUnit;
    measurements: SceneMeasurement[];
    annotations: Annotation[];
    /** Since version 2. */
    cameraPath: Keyframe[];
    /** The range of the colours is that of what is in view. */
    followsView: boolean;
    legend: boolean;
    map: boolean;
}

/** The fields of `value` that are not as in `defaults`. */
export function differences<T extends object>(value: T, defaults: T): Partial<T> {
    return Object.fromEntries(
        Object.entries(value).filter(
            ([name, field]) => JSON.stringify(field) !== JSON.stringify(defaults[name as keyof T]),
        ),
    ) as Partial<T>;
}

/** Without what a picked point says beyond its place. */
export function sceneMeasurement(item: Measurement, indexOfCloud: (id: number) => number): SceneMeasurement {
    const points = item.points.map(
        ({ integers, position, point, cloudName, crs, epsg, unit, unitMeters, geocentric, scale, offset, spacing }) => ({
            integers,
            position,
            point: { ...point, cloud: indexOfCloud(point.cloud) },
            cloudName,
            crs,
            epsg,
            unit,
            unitMeters,
            geocentric,
            scale,
            offset,
            spacing,
        }),
    );
    return { kind: item.kind, name: item.name, hidden: item.hidden, points };
}
