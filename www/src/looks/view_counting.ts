import type { Model } from '../model.ts';
import type { Histogram, HistogramRequest, ViewCounts } from '../wasm/values.ts';
import type { Viewer } from '../wasm/viewer.ts';

/** So long after the last frame the picture counts as standing still. */
const restPauseMs = 150;
/** While values are on their way it is counted again after so long, then after twice that, … */
const lookAgainMs = 250;
const longestLookAgainMs = 8000;

/**
 * How often values occur among the points in view: asked for by elements while they are seen, counted between frames once
 * the picture stands still, and again as long as values arrive. 'change' says that there are new counts.
 */
export class ViewCounting extends EventTarget {
    /** Of the picture that was counted last. */
    counts: ViewCounts | undefined;
    private readonly wanted = new Map<object, HistogramRequest>();
    private counted: string[] = []; // the requests, as JSON
    private timer: ReturnType<typeof setTimeout> | undefined;
    private run = 0;
    private lookAgainMs = lookAgainMs;

    constructor(
        private readonly model: Model,
        private readonly viewer: Viewer,
    ) {
        super();
        model.addEventListener('frame', () => {
            this.lookAgainMs = lookAgainMs;
            this.countSoon(restPauseMs);
        });
    }

    /** From now on, for `owner`, in place of what it wanted before. */
    want(owner: object, request: HistogramRequest): void {
        if (JSON.stringify(this.wanted.get(owner)) === JSON.stringify(request)) return;
        this.wanted.set(owner, request);
        this.lookAgainMs = lookAgainMs;
        this.countSoon(0);
    }
    forget(owner: object): void {
        if (this.wanted.delete(owner) && this.wanted.size === 0) this.countSoon(0); // nothing more is fetched
    }

    /** For good. */
    stop(): void {
        this.run++;
        clearTimeout(this.timer);
        this.wanted.clear();
        this.counted = [];
    }

    /** Undefined as long as it has not been counted. */
    histogram(request: HistogramRequest): Histogram | undefined {
        return this.counts?.histograms[this.counted.indexOf(JSON.stringify(request))];
    }

    private countSoon(pauseMs: number): void {
        if (this.wanted.size === 0 && this.counted.length === 0) return;
        clearTimeout(this.timer);
        this.timer = setTimeout(() => void this.count(), pauseMs);
    }

    private async count(): Promise<void> {
        const run = ++this.run;
        const texts = [...new Set([...this.wanted.values()].map((request) => JSON.stringify(request)))];
        this.viewer.count(texts.map((text) => JSON.parse(text) as HistogramRequest));
        this.model.wake(); // what they look at is asked for between frames
        let counts: ViewCounts | undefined;
        while (texts.length > 0 && counts === undefined) {
            await new Promise((resolve) => requestAnimationFrame(resolve));
            if (run !== this.run) return; // a later one takes its place
            counts = this.viewer.takeCounts().counts;
        }
        this.counted = texts;
        this.counts = counts;
        this.dispatchEvent(new Event('change'));
        if (!counts || counts.nodesMissing === 0) return;
        this.countSoon(this.lookAgainMs);
        this.lookAgainMs = Math.min(longestLookAgainMs, 2 * this.lookAgainMs);
    }
}
