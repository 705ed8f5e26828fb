import { isMixedContent, type Requests } from './requests.ts';
import type { StoredFile, StoredRanges } from './stored_ranges.ts';

/** The stored versions of the files that are open. Of each its server is asked once which version it has now. */
export class StoredFiles {
    private store: Promise<StoredRanges | undefined> | undefined;
    private readonly files = new Map<string, Promise<StoredFile | undefined>>();

    constructor(private readonly sending: Requests) {}

    /** Undefined: nothing is stored of it, and nothing is to be. */
    async of(url: string): Promise<StoredFile | undefined> {
        if (this.sending.storeBytes <= 0) return undefined;
        let file = this.files.get(url);
        if (!file) this.files.set(url, (file = this.open(url)));
        try {
            return await file;
        } catch {
            this.files.delete(url); // whatever it was, the request that follows says so
            return undefined;
        }
    }

    /** Its server has another version: it is asked again. */
    forget(url: string): void {
        this.files.delete(url);
    }

    private async open(url: string): Promise<StoredFile | undefined> {
        this.store ??= import('./stored_ranges.ts').then(({ StoredRanges }) => StoredRanges.open(this.sending.storeBytes)); // few want it
        const store = await this.store;
        if (!store) return undefined;
        // One byte, not HEAD: signed addresses are often good for GET alone.
        const prepared = await this.sending.prepared(url, 'bytes=0-0');
        if (isMixedContent(prepared.url)) throw new Error('not to be asked for');
        const response = await fetch(prepared.url, prepared.init);
        void response.body?.cancel();
        if (response.status !== 206) throw new Error(`status ${response.status}`);
        const etag = response.headers.get('etag') ?? '';
        const size = /^bytes 0-0\/(\d+)$/.exec(response.headers.get('content-range') ?? '')?.[1];
        return etag.startsWith('"') && size !== undefined ? store.version(url, etag, Number(size)) : undefined;
    }
}
