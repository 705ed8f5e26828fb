import type { Model } from '../model.ts';
import { reasonOf } from '../problem_document.ts';
import { Problem } from '../texts/message.ts';
import type { ClipRegion, CloudState, RegionOf, Vector } from '../wasm/values.ts';
import type { Viewer } from '../wasm/viewer.ts';
import { profileAttributes, ProfilePoints, readProfile } from './profile_points.ts';

/** Points a metre of the line, roughly, at the first look; each further look has four times as many, the last has all. */
const firstLook = 300;
const looks = 3;
/** The last look is not taken by itself if it promises more. */
const mostPoints = 3_000_000;

/** What was set up of a profile. */
export interface ProfileSetting {
    line: Vector[];
    width: number;
    /** Of heights, in its picture. */
    exaggeration: number;
}

/** Vertical sections along a line that was drawn: the clouds' points within half the width of it, cut by the page's server or, of other clouds, read by the page. */
export class Profile extends EventTarget {
    line: Vector[] = [];
    width = 1;
    exaggeration = 1;
    points = new ProfilePoints();
    /** Of the line, in plan. */
    length = 0;
    isLoading = false;
    isComplete = false;
    error = '';
    private abort: AbortController | undefined;
    /** The clouds that were cut. */
    private cut = '';

    constructor(
        private readonly model: Model,
        private readonly viewer: Viewer,
    ) {
        super();
        // Clouds that come, go, are shown or hidden.
        model.addEventListener('change', () => {
            if (this.isOpen && !this.isLoading && String(this.shown()) !== this.cut) void this.load();
        });
    }

    /** What it is cut from. */
    get region(): RegionOf {
        return { line: this.line.map(([x, y]) => [x, y]), width: this.width };
    }

    get isOpen(): boolean {
        return this.line.length > 1;
    }

    open(line: Vector[]): void {
        const length = lengthOf(line);
        this.show({ line, width: Number((length / 50).toPrecision(1)) || 1, exaggeration: this.exaggeration });
    }
    show({ line, width, exaggeration }: ProfileSetting): void {
        this.move(() => Object.assign(this, { line, width, exaggeration, length: lengthOf(line) }));
        void this.load();
    }
    setting(): ProfileSetting | undefined {
        const { line, width, exaggeration } = this;
        return this.isOpen ? { line, width, exaggeration } : undefined;
    }
    close(): void {
        this.abort?.abort();
        if (this.corridor && !this.model.isDisposed) this.showCorridor();
        this.line = [];
        this.points = new ProfilePoints();
        this.changed();
    }
    exaggerate(exaggeration: number): void {
        if (exaggeration >= 0.1 && exaggeration <= 100) this.exaggeration = exaggeration;
    }
    setWidth(width: number): void {
        if (!(width > 0) || !Number.isFinite(width)) return;
        this.move(() => (this.width = width));
        void this.load();
    }

    /** How it shows in the picture: a clip region of the style that has its line and width. */
    get corridor(): ClipRegion | undefined {
        return this.model.clipping.regions.find((clip) => this.isCorridor(clip));
    }
    /** What else it does there; nothing without a mode. */
    showCorridor(mode?: ClipRegion['mode']): void {
        const others = this.model.clipping.regions.filter((clip) => !this.isCorridor(clip));
        this.model.changeStyle({ clipRegions: mode ? [...others, { mode, region: this.region }] : others });
    }
    /** What shows of it in the picture goes along. */
    private move(change: () => void): void {
        const mode = this.isOpen ? this.corridor?.mode : undefined;
        if (mode) this.showCorridor();
        change();
        if (mode) this.showCorridor(mode);
    }
    private isCorridor({ region }: ClipRegion): boolean {
        const line = this.line.map(([x, y]) => [x, y]);
        return 'line' in region && region.width === this.width && JSON.stringify(region.line) === JSON.stringify(line);
    }

    /** Of each cloud that this page's server has: the profile's address. */
    addresses(format: string, extra: Record<string, string> = {}): { name: string; href: string }[] {
        const query = new URLSearchParams({
            line: this.line.map(([x, y]) => `${x},${y}`).join(';'),
            width: String(this.width),
            format,
            ...extra,
        });
        const shown = this.shown();
        return this.model.clipping
            .apisOfClouds()
            .filter(({ cloud }) => shown.includes(cloud))
            .map(({ name, api }) => ({ name, href: `${api}/profile?${query}` }));
    }
    /** Those whose points the page reads itself. */
    ownClouds(): CloudState[] {
        const shown = this.shown();
        return this.model.clipping.cloudsWithoutApi().filter(({ id }) => shown.includes(id));
    }
    /** Hidden clouds are not cut. */
    private shown(): number[] {
        return this.model.clouds.filter(({ visible, stage }) => visible && stage === 'ready').map(({ id }) => id);
    }

    /** Coarse points first, then finer ones in their place. What was under way is given up at once. */
    private async load(): Promise<void> {
        this.abort?.abort();
        const abort = (this.abort = new AbortController());
        this.points = new ProfilePoints();
        this.error = '';
        this.isComplete = false;
        this.isLoading = true;
        this.changed();
        try {
            await this.cloudsAreOpen();
            if (abort.signal.aborted) return;
            this.cut = String(this.shown());
            const served = this.addresses('csv').length > 0;
            let isWhole = true;
            for (let look = 0, goesOn = served; look <= looks && goesOn; look++) {
                const isLast = look === looks;
                const spacing = this.length / firstLook / 2 ** look;
                goesOn = await this.look(isLast ? undefined : spacing, abort.signal);
                if (abort.signal.aborted) return;
                isWhole = isLast && goesOn;
                this.changed();
            }
            for (const { id } of this.ownClouds()) {
                isWhole = (await this.read(id, abort)) && isWhole;
                if (abort.signal.aborted) return;
            }
            this.isComplete = isWhole;
            this.model.access.granted('profile');
        } catch (error) {
            if (abort.signal.aborted) return;
            this.model.access.takes(error, 'profile', () => void this.load());
            this.error = this.model.texts.sentenceOf(error);
        }
        this.isLoading = false;
        this.changed();
    }

    /** Those of a scene are still on their way. */
    private async cloudsAreOpen(): Promise<void> {
        while (this.model.readClouds().some(({ stage }) => stage === 'opening'))
            await new Promise((resolve) => this.model.addEventListener('change', resolve, { once: true }));
    }

    /** One look at all clouds; false if a further one would be too much. */
    private async look(spacing: number | undefined, signal: AbortSignal): Promise<boolean> {
        const points = new ProfilePoints();
        for (const { name, href } of this.addresses('csv', spacing === undefined ? {} : { spacing: String(spacing) })) {
            const wanted = this.attributesOf(name);
            const response = await this.model.requests.fetch(`${href}&attributes=${encodeURIComponent(wanted)}`, { signal });
            if (!response.ok) throw await refusalOf(response);
            await readProfile(response.body!, points);
        }
        if (signal.aborted) return false;
        this.points = points;
        return 4 * points.count <= mostPoints || spacing === undefined;
    }

    /** The points of a cloud that no server cuts, coarse ones first; false if there are more than are shown. */
    private async read(cloud: number, abort: AbortController): Promise<boolean> {
        const { points } = this, own = new AbortController();
        const stop = (): void => own.abort();
        abort.signal.addEventListener('abort', stop);
        let told = 0;
        const { workOnRegion } = await import('../regions/region_work.ts'); // loaded when it is first wanted
        await workOnRegion(this.model, this.viewer, cloud, { make: 'profile', region: this.region }, {
            signal: own.signal,
            piece: (bytes) => {
                points.addPiece(bytes);
                if (points.count >= mostPoints) own.abort();
            },
            progress: () => {
                if (points.count === told || abort.signal.aborted) return;
                told = points.count;
                this.changed();
            },
        });
        abort.signal.removeEventListener('abort', stop);
        return !own.signal.aborted;
    }

    private attributesOf(name: string): string {
        const has = this.model.clouds.find((cloud) => cloud.name === name)?.attributes ?? [];
        const wanted = profileAttributes.filter((attribute) => has.includes(attribute));
        return wanted.length > 0 ? wanted.join(',') : 'none';
    }

    private changed(): void {
        this.dispatchEvent(new Event('change'));
    }
}

/** In plan. */
function lengthOf(line: Vector[]): number {
    return line.slice(1).reduce((sum, [x, y], i) => sum + Math.hypot(x - line[i]![0], y - line[i]![1]), 0);
}

async function refusalOf(response: Response): Promise<Error> {
    const reason = await reasonOf(response);
    if (reason === undefined) return new Problem('profile.refusedStatus', { status: String(response.status) });
    return new Problem('profile.refused', { reason });
}
