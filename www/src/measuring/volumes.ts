import type { Model } from '../model.ts';
import type { MeasureAnswer, PlacedPoint, RegionRequest, RequestPoint } from '../wasm/values.ts';
import type { Viewer } from '../wasm/viewer.ts';
import type { Measurement } from './measurement.ts';

/** A person who drags a corner is not yet where it is to be. */
const pauseMs = 250;

/** Measures cut and fill, which takes all points of a polygon: one after the other, each given up when it is asked for anew. */
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
            const { workOnRegion } = await import('../regions/region_work.ts'); // loaded when it is first wanted
            const made = await workOnRegion(this.model, this.viewer, item.points[0]!.point.cloud, requestOf(item), {
                signal: abort.signal,
                progress: ({ share }) => {
                    item.share = share;
                    this.changed();
                },
            });
            if (!made || abort.signal.aborted) return;
            item.answer = made.answer as MeasureAnswer;
        } catch (error) {
            if (abort.signal.aborted) return;
            item.error = this.model.texts.sentenceOf(error);
        }
        this.stop(item);
        this.changed();
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
