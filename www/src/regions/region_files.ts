import type { Model } from '../model.ts';
import type { RegionFormat, RegionOf } from '../wasm/values.ts';
import type { Viewer } from '../wasm/viewer.ts';
import type { RegionProgress } from './region_work.ts';

/** More points than this are a matter for `stipple export`. Where a file can't go to the disk as it comes, the page holds it. */
const mostPointsOnDisk = 1_000_000_000, mostPointsHeld = 30_000_000;

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
            const [{ workOnRegion }, { hasDisk, intoFile, newFile }] = await Promise.all([
                import('./region_work.ts'), // loaded when they are first wanted
                import('../files/output_file.ts'),
            ]);
            await intoFile(this.model, `${name}.${format}`, newFile, async (to) => {
                const mostPoints = hasDisk() ? mostPointsOnDisk : mostPointsHeld;
                const answer = await workOnRegion(this.model, this.viewer, cloud, { make: 'file', format, region, mostPoints }, {
                    signal: abort.signal,
                    progress: (progress) => {
                        Object.assign(file, progress);
                        this.changed();
                    },
                    piece: (bytes) => to.write(bytes),
                    patch: (offset, bytes) => to.overwrite(offset, bytes),
                });
                for (const warning of (answer?.['warnings'] as string[] | undefined) ?? []) this.model.notify(warning);
                return answer !== undefined;
            });
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
