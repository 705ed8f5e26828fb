import type { MeasuredBox } from '../measuring/measurement.ts';
import type { Model } from '../model.ts';
import { Problem } from '../texts/message.ts';
import type { ClipBox, PlacedPoint } from '../wasm/values.ts';
import { axesOf, cornersOf } from './boxes.ts';

/**
 * A clip box, to be measured in the unit and system of the first cloud that is shown: its corners, places of no point of a
 * cloud, each the offset of a grid of its own, so that measuring keeps them as they are.
 */
export function measuredBox(model: Model, clip: ClipBox): { points: PlacedPoint[]; box: MeasuredBox } {
    const cloud = model.clouds.find(({ visible, stage }) => visible && stage === 'ready');
    const facts = cloud && model.looks.factsOf(cloud.id);
    if (!cloud || !facts) throw new Problem('clip.noCloud');
    const { name, epsg, unit, unitMeters, geocentric } = facts.crs;
    const points = cornersOf(clip).map(
        (position): PlacedPoint => ({
            integers: [0, 0, 0],
            position,
            point: { cloud: cloud.id, node: '', index: 0 },
            cloudName: cloud.name,
            crs: name,
            epsg,
            unit,
            unitMeters,
            geocentric,
            scale: [1, 1, 1],
            offset: position,
            spacing: 0,
        }),
    );
    return { points, box: { centre: clip.centre, halfSize: clip.halfSize, axes: axesOf(clip) } };
}
