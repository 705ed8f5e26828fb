import type { Model } from '../model.ts';
import type { CloudClass, CloudFacts, Gradients, Limits, Style } from '../wasm/values.ts';
import type { Viewer } from '../wasm/viewer.ts';
import { colourRequest, type Range, rangeFields, typicalRange } from './ranges.ts';
import type { ViewCounting } from './view_counting.ts';

/** A range of one value means that of the clouds: the least that is another. */
function apart([min, max]: Range): Range {
    return [min, Math.max(max, min + 2e-6 * Math.max(1, Math.abs(min)))];
}

/** How fine a picture may be, and what it may cost. */
export type Quality = 'fast' | 'balanced' | 'fine' | 'best';
export const qualities: Record<Quality, { limits: Partial<Limits>; splats: boolean; edl: boolean }> = {
    fast: { limits: { pointBudget: 500_000, minNodePixels: 120 }, splats: false, edl: false },
    balanced: { limits: { pointBudget: 2_000_000, minNodePixels: 60 }, splats: false, edl: true },
    fine: { limits: { pointBudget: 6_000_000, minNodePixels: 40 }, splats: false, edl: true },
    best: { limits: { pointBudget: 20_000_000, minNodePixels: 25 }, splats: true, edl: true },
};

/** What is known of the clouds' colours, and what goes with them beside the style: the legend, a range that follows the view. */
export class Looks {
    showsLegend = true;
    /** The range along the gradient is that of what is in view, each time the camera rests. */
    followsView = false;
    readonly gradients: Gradients;
    private readonly known = new Map<number, CloudFacts>();

    constructor(
        private readonly model: Model,
        private readonly viewer: Viewer,
        private readonly counting: ViewCounting,
    ) {
        this.gradients = viewer.gradients();
        model.addEventListener('change', () => this.ask());
        counting.addEventListener('change', () => this.fit());
    }

    /** With the ranges that the style leaves to the clouds. */
    drawnStyle(): Style {
        return this.viewer.drawnStyle();
    }

    facts(): CloudFacts[] {
        return this.model.clouds.flatMap(({ id }) => this.factsOf(id) ?? []);
    }
    /** Undefined until the cloud is open. */
    factsOf(id: number): CloudFacts | undefined {
        const known = this.known.get(id) ?? this.viewer.cloudFacts(id);
        if (known) this.known.set(id, known);
        return known ?? undefined;
    }

    attributeNames(): string[] {
        return [...new Set(this.model.clouds.flatMap((cloud) => cloud.attributes ?? []))];
    }
    isWhole(attribute: string): boolean {
        const named = this.facts().flatMap(({ attributes }) => attributes.filter(({ name }) => name === attribute));
        return named.length > 0 && named.every(({ isWhole }) => isWhole);
    }

    /** Of all clouds together, ascending. */
    classes(): CloudClass[] {
        const classes = new Map<number, CloudClass>();
        for (const one of this.model.clouds.flatMap((cloud) => cloud.classes ?? []))
            classes.set(one.class, { ...one, points: one.points + (classes.get(one.class)?.points ?? 0) });
        return [...classes.values()].sort((a, b) => a.class - b.class);
    }

    showLegend(isShown: boolean): void {
        this.showsLegend = isShown;
        this.model.changed();
    }

    /** Of the colours, by hand; null: of the clouds. */
    setRange(range: Range | null): void {
        const field = rangeFields[this.model.style.colourMode];
        this.followsView = false;
        if (field) this.model.changeStyle({ [field]: range && apart(range) });
    }
    followView(follows: boolean): void {
        this.setRange(null);
        this.followsView = follows;
        this.model.changed();
        this.fit();
    }

    choose(quality: Quality): void {
        const { limits, splats, edl } = qualities[quality];
        this.model.changeLimits(limits);
        this.model.changeStyle({ splats: { enabled: splats }, edl: { enabled: edl } });
    }
    /** The one that holds; none if something was set by hand. */
    quality(): Quality | undefined {
        const { limits, style } = this.model;
        return (Object.keys(qualities) as Quality[]).find((name) => {
            const wanted = qualities[name];
            return (
                wanted.limits.pointBudget === limits.pointBudget &&
                wanted.limits.minNodePixels === limits.minNodePixels &&
                wanted.splats === style.splats.enabled &&
                wanted.edl === style.edl.enabled
            );
        });
    }

    /** The range can only follow what is counted. */
    private ask(): void {
        const request = this.followsView ? colourRequest(this.model.style) : undefined;
        if (request) this.counting.want(this, request);
        else this.counting.forget(this);
    }

    private fit(): void {
        const { style } = this.model, request = colourRequest(style), field = rangeFields[style.colourMode];
        const histogram = request && this.followsView ? this.counting.histogram(request) : undefined;
        if (!field || !histogram || histogram.points === 0) return;
        const range = typicalRange(histogram, style.colourMode);
        const before = style[field];
        if (!before || range.some((value, at) => value !== before[at])) this.model.changeStyle({ [field]: range });
    }
}
