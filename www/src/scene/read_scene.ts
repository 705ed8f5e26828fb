import type { Annotation } from '../annotations/annotation.ts';
import { kindsOfMeasurement, kindOf, type MeasuredBox, type VolumeBase } from '../measuring/measurement.ts';
import { displayUnits } from '../measuring/units.ts';
import type { Bounds, Camera, Keyframe, Limits, PlacedPoint, Style, Vector } from '../wasm/values.ts';
import { Problem } from '../texts/message.ts';
import { mostKeyframes } from '../navigation/film.ts';
import type { ProfileSetting } from '../profile/profile.ts';
import { FieldReader, readPlace } from './fields.ts';
import { type Scene, type SceneCloud, type SceneMeasurement, sceneVersion } from './scene.ts';

export const mostSceneBytes = 16 << 20;

const isWhole = (value: number): boolean => Number.isSafeInteger(value);

/**
 * The scene of a text. Throws a sentence that names the first field that is wrong. Camera, style and limits are objects
 * here; the program says what is wrong in them when they are set.
 */
export function readScene(text: string): Scene {
    if (text.length > mostSceneBytes) throw new Problem('scene.tooLarge', { mebibytes: mostSceneBytes >> 20 });
    let value: unknown;
    try {
        value = JSON.parse(text);
    } catch (error) {
        throw new Problem('scene.notJson', { reason: error instanceof Error ? error.message : String(error) });
    }
    const fields = FieldReader.of(value, '');
    if (fields.text('stipple', '') !== 'scene') throw new Problem('scene.notOurs');
    const version = fields.number('version', 0, isWhole);
    if (version > sceneVersion)
        throw new Problem('scene.tooNew', { version, known: sceneVersion });
    const profile = fields.optionalObject('profile');
    const scene: Scene = {
        stipple: 'scene',
        version,
        clouds: fields.list('clouds', 10_000, readCloud),
        camera: fields.object('camera') as unknown as Camera,
        style: fields.object('style') as Partial<Style>,
        limits: fields.object('limits') as Partial<Limits>,
        navigation: fields.oneOf('navigation', ['orbit', 'earth', 'fly'], 'orbit'),
        unit: fields.oneOf('unit', displayUnits, 'stored'),
        measurements: fields.list('measurements', 10_000, readMeasurement),
        annotations: fields.list('annotations', 10_000, readAnnotation),
        cameraPath: fields.list('cameraPath', mostKeyframes, readKeyframe),
        ...(profile && { profile: readProfile(profile, 'profile') }),
        followsView: fields.flag('followsView', false),
        legend: fields.flag('legend', true),
        map: fields.flag('map', false),
    };
    fields.finish();
    checkTree(scene.annotations);
    return scene;
}

function readCloud(value: unknown, path: string): SceneCloud {
    const fields = FieldReader.of(value, path);
    const address = fields.text('address', '', 4000), file = fields.text('file', '');
    const cloud: SceneCloud = {
        ...(address && { address: checkedAddress(address, path) }),
        ...(file && { file }),
        name: fields.text('name', address || file),
        visible: fields.flag('visible', true),
        ...readBounds(fields.optionalObject('bounds'), `${path}.bounds`),
    };
    if (!address === !file) throw new Problem('scene.cloudAddress', { place: path });
    fields.finish();
    return cloud;
}

function readBounds(value: unknown, path: string): { bounds?: Bounds } {
    if (value === undefined) return {};
    const fields = FieldReader.of(value, path);
    const bounds = { min: fields.vector('min'), max: fields.vector('max') };
    fields.finish();
    return { bounds };
}

/** Only what a page may fetch. */
function checkedAddress(address: string, path: string): string {
    let protocol = '';
    try {
        ({ protocol } = new URL(address, document.baseURI));
    } catch {
        // told below
    }
    if (protocol !== 'http:' && protocol !== 'https:')
        throw new Problem('scene.address', { place: `${path}.address` });
    return address;
}

function readMeasurement(value: unknown, path: string): SceneMeasurement {
    const fields = FieldReader.of(value, path);
    const kind = fields.oneOf('kind', kindsOfMeasurement.map((known) => known.kind));
    const measurement: SceneMeasurement = {
        kind,
        name: fields.text('name', ''),
        hidden: fields.flag('hidden', false),
        points: fields.list('points', 10_000, readPoint),
        ...(kind === 'box' && { box: readBox(fields.object('box'), `${path}.box`) }),
        ...(kind === 'volume' && { base: readBase(fields.optionalObject('base') ?? { from: 'rim' }, `${path}.base`) }),
    };
    fields.finish();
    const { least, points } = kindOf(kind), count = measurement.points.length;
    if (count < least) throw new Problem('scene.fewPoints', { place: path, kind, number: count });
    if (points !== undefined && count > points) throw new Problem('scene.manyPoints', { place: path, kind, number: count });
    return measurement;
}

function readBox(value: unknown, path: string): MeasuredBox {
    const fields = FieldReader.of(value, path);
    const box: MeasuredBox = {
        centre: fields.vector('centre'),
        halfSize: fields.vector('halfSize', (half) => half >= 0),
        axes: fields.list('axes', 3, (axis, at) => FieldReader.of({ axis }, at).vector('axis')) as [Vector, Vector, Vector],
    };
    fields.finish();
    if (box.axes!.length !== 3) throw new Problem('scene.mustBeVector', { place: `${path}.axes` });
    return box;
}

function readBase(value: unknown, path: string): VolumeBase {
    const fields = FieldReader.of(value, path);
    const from = fields.oneOf('from', ['rim', 'height', 'point']);
    const base: VolumeBase =
        from === 'height'
            ? { from, height: fields.number('height', 0) }
            : from === 'point'
              ? { from, point: readPoint(fields.object('point'), `${path}.point`) }
              : { from };
    fields.finish();
    return base;
}

function readAnnotation(value: unknown, path: string): Annotation {
    const fields = FieldReader.of(value, path);
    const camera = fields.optionalObject('camera');
    const annotation: Annotation = {
        id: fields.number('id', 0, (id) => isWhole(id) && id > 0),
        parent: fields.number('parent', 0, isWhole),
        title: fields.text('title', ''),
        text: fields.text('text', '', 100_000),
        position: fields.vector('position'),
        ...(camera && { camera: camera as unknown as Camera }),
        hidden: fields.flag('hidden', false),
        maxDistance: fields.number('maxDistance', 0, (distance) => distance >= 0),
    };
    fields.finish();
    return annotation;
}

/** The program says what is wrong with the cameras. */
function readKeyframe(value: unknown, path: string): Keyframe {
    const fields = FieldReader.of(value, path);
    const keyframe: Keyframe = {
        camera: fields.object('camera') as unknown as Camera,
        seconds: fields.number('seconds', 0, (seconds) => seconds > 0 && seconds <= 3600),
    };
    fields.finish();
    return keyframe;
}

function readProfile(value: unknown, path: string): ProfileSetting {
    const fields = FieldReader.of(value, path);
    const profile: ProfileSetting = {
        line: fields.list('line', 10_000, readPlace),
        width: fields.number('width', 1, (width) => width > 0),
        exaggeration: fields.number('exaggeration', 1, (times) => times >= 0.1 && times <= 100),
    };
    fields.finish();
    if (profile.line.length < 2) throw new Problem('scene.fewPoints', { place: path, kind: 'profile', number: profile.line.length });
    return profile;
}

const deepestTree = 32;

/** Ids are different, parents are there, none belongs to itself, and none too deep in others. */
function checkTree(annotations: Annotation[]): void {
    const parents = new Map(annotations.map(({ id, parent }) => [id, parent]));
    if (parents.size !== annotations.length) throw new Problem('scene.sameId');
    for (const { id } of annotations) {
        let at: number | undefined = id;
        for (let depth = 0; at !== 0 && at !== undefined && depth <= deepestTree; depth++) at = parents.get(at);
        if (at !== 0) throw new Problem('scene.badParent', { id: String(id), most: deepestTree });
    }
}

function readPoint(value: unknown, path: string): PlacedPoint {
    const fields = FieldReader.of(value, path);
    const identity = FieldReader.of(fields.object('point'), `${path}.point`);
    const point: PlacedPoint = {
        integers: fields.vector('integers', isWhole),
        position: fields.vector('position'),
        point: {
            cloud: identity.number('cloud', -1, isWhole),
            node: identity.text('node', ''),
            index: identity.number('index', 0, isWhole),
        },
        cloudName: fields.text('cloudName', ''),
        crs: fields.text('crs', ''),
        epsg: fields.number('epsg', 0, isWhole) || null,
        unit: fields.text('unit', ''),
        unitMeters: fields.number('unitMeters', 0, (metres) => metres >= 0),
        geocentric: fields.flag('geocentric', false),
        scale: fields.vector('scale', (step) => step > 0),
        offset: fields.vector('offset'),
        spacing: fields.number('spacing', 0, (spacing) => spacing >= 0),
    };
    identity.finish();
    fields.finish();
    return point;
}
