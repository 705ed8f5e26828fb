import type { Model } from '../model.ts';
import type { MeasureAnswer, PlacedPoint, RegionAnswer, RegionRequest, RequestPoint, Vector } from '../wasm/values.ts';
import type { Viewer } from '../wasm/viewer.ts';
import type { MeasuredBox, Measurement } from './measurement.ts';

/** A person who drags a corner is not yet where it is to be. */
const pauseMs = 250;

/** Measures what takes all points of a place, cut and fill over a polygon and what is in a box; each is given up when it is asked for anew. */
export class Volumes {
    private readonly running = new Map<Measurement, AbortController>();

    /** `changed` is called when there is something new to show of an item. */
    constructor(
        private readonly model: Model,
        private readonly viewer: Viewer,
        private readonly changed: () => void,
    ) {}

    async measure(item: Measurement): Promise<void> {
        this.stop(item);
        const abort = new AbortController();
        this.running.set(item, abort);
        item.share = 0;
        try {
            await new Promise((resolve) => setTimeout(resolve, pauseMs));
            if (abort.signal.aborted) return;
            const answer = item.box ? await this.inBox(item, item.box, abort.signal) : await this.cutAndFill(item, abort.signal);
            if (!answer || abort.signal.aborted) return;
            item.answer = answer;
        } catch (error) {
            if (abort.signal.aborted) return;
            item.error = this.model.texts.sentenceOf(error);
        }
        this.stop(item);
        this.changed();
    }

    private async cutAndFill(item: Measurement, signal: AbortSignal): Promise<MeasureAnswer | undefined> {
        const made = await this.work(item, item.points[0]!.point.cloud, requestOf(item), signal);
        return made as MeasureAnswer | undefined;
    }

    /** Its points are those of all clouds that are shown. */
    private async inBox(item: Measurement, box: MeasuredBox, signal: AbortSignal): Promise<MeasureAnswer | undefined> {
        const [width, depth, height] = box.halfSize.map((half) => 2 * half) as Vector;
        let pointsInside = 0;
        for (const { id } of this.model.clouds.filter(({ visible, stage }) => visible && stage === 'ready')) {
            const made = await this.work(item, id, { make: 'count', region: { box } }, signal);
            if (!made) return undefined;
            pointsInside += Number(made['points']);
        }
        return { kind: 'box', width, depth, height, volume: width * depth * height, pointsInside };
    }

    private async work(
        item: Measurement,
        cloud: number,
        request: RegionRequest,
        signal: AbortSignal,
    ): Promise<RegionAnswer | undefined> {
        const { workOnRegion } = await import('../regions/region_work.ts'); // loaded when it is first wanted
        return workOnRegion(this.model, this.viewer, cloud, request, {
            signal,
            progress: ({ share }) => {
                item.share = share;
                this.changed();
            },
        });
    }

    /** Nothing more is wanted of it. */
    stop(item: Measurement): void {
        this.running.get(item)?.abort();
        this.running.delete(item);
        delete item.share;
    }
}

function requestPoint({ integers, scale, offset, spacing }: PlacedPoint): RequestPoint {
    return { integers, scale, offset, spacing };
}

function requestOf({ points, base = { from: 'rim' } }: Measurement): RegionRequest {
    return {
        make: 'volume',
        points: points.map(requestPoint),
        geocentric: points[0]!.geocentric,
        base:
            base.from === 'height'
                ? { height: base.height }
                : base.from === 'point'
                  ? { point: requestPoint(base.point) }
                  : 'rim',
    };
}
