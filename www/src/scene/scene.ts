import type { Annotation } from '../annotations/annotation.ts';
import type { MeasuredBox, Measurement, VolumeBase } from '../measuring/measurement.ts';
import type { DisplayUnit } from '../measuring/units.ts';
import type { NavigationMode } from '../navigation/navigator.ts';
import type { ProfileSetting } from '../profile/profile.ts';
import type { Bounds, Camera, Keyframe, Limits, MeasureKind, PlacedPoint, Style } from '../wasm/values.ts';

/**
 * What a person has set up, as JSON: clouds, camera, looks, measurements. A reader of a later version reads earlier ones;
 * fields that are absent have their defaults, fields that nobody knows are an error. www/public/scene.schema.json is its JSON Schema.
 */
export const sceneVersion = 3;

export interface SceneCloud {
    /** Of the file, absolute or relative to the page; or the name of a file that has to be opened by hand. */
    address?: string;
    file?: string;
    name: string;
    visible: boolean;
    /** World box of its points: it is opened when that is in view. */
    bounds?: Bounds;
}

export interface SceneMeasurement {
    kind: MeasureKind;
    name: string;
    hidden: boolean;
    /** `point.cloud` is an index of the scene's clouds, -1 for one that is not among them. */
    points: PlacedPoint[];
    /** Of a volume. */
    base?: VolumeBase;
    /** Of a box, whose corners are the points. */
    box?: MeasuredBox;
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
    /** The one that is open. Since version 3. */
    profile?: ProfileSetting;
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

export function sceneMeasurement(item: Measurement, indexOfCloud: (id: number) => number): SceneMeasurement {
    const { kind, name, hidden, base, box } = item;
    const placed = (point: PlacedPoint): PlacedPoint => placedIn(point, indexOfCloud);
    const ofVolume: VolumeBase | undefined = base ?? (kind === 'volume' ? { from: 'rim' } : undefined);
    const stored: VolumeBase | undefined = ofVolume?.from === 'point' ? { from: 'point', point: placed(ofVolume.point) } : ofVolume;
    return { kind, name, hidden, points: item.points.map(placed), ...(stored && { base: stored }), ...(box && { box }) };
}

/** Without what a picked point says beyond its place. */
function placedIn(picked: PlacedPoint, indexOfCloud: (id: number) => number): PlacedPoint {
    const { integers, position, point, cloudName, crs, epsg, unit, unitMeters, geocentric, scale, offset, spacing } = picked;
    return {
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
    };
}
