import type { Model } from '../model.ts';
import { download } from '../ui/download.ts';
import type { RegionFormat, RegionOf } from '../wasm/values.ts';
import type { Viewer } from '../wasm/viewer.ts';
import type { RegionProgress } from './region_work.ts';

/** More points than this are a matter for `stipple export`: the page holds the file while it is made. */
const mostPoints = 30_000_000;

/** A file of a region's points that is being made. */
export interface RegionFile extends RegionProgress {
    /** What it is of: the part of the page that asked for it knows. */
    readonly key: string;
    readonly format: RegionFormat;
    cancel(): void;
}

/** Files of regions, made by the page itself: of a static host or a file there is no server that could. 'change' says that something did. */
export class RegionFiles extends EventTarget {
    files: RegionFile[] = [];

    constructor(
        private readonly model: Model,
        private readonly viewer: Viewer,
    ) {
        super();
    }

    of(key: string): RegionFile | undefined {
        return this.files.find((file) => file.key === key);
    }

    /** Makes and saves it; what goes wrong is told. One at a time for each key. */
    async save(key: string, cloud: number, region: RegionOf, format: RegionFormat, name: string): Promise<void> {
        if (this.of(key)) return;
        const abort = new AbortController();
        const file: RegionFile = { key, format, share: 0, points: 0, cancel: () => abort.abort() };
        this.files = [...this.files, file];
        this.changed();
        try {
            const { workOnRegion } = await import('./region_work.ts'); // loaded when it is first wanted
            const made = await workOnRegion(this.model, this.viewer, cloud, { make: 'file', format, region, mostPoints }, {
                signal: abort.signal,
                progress: (progress) => {
                    Object.assign(file, progress);
                    this.changed();
                },
            });
            if (made?.file) download(made.file, `${name}.${format}`);
            for (const warning of (made?.answer['warnings'] as string[] | undefined) ?? []) this.model.notify(warning);
        } catch (error) {
            this.model.tell(error);
        }
        this.files = this.files.filter((other) => other !== file);
        this.changed();
    }

    private changed(): void {
        this.dispatchEvent(new Event('change'));
    }
}
