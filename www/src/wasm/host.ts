import { DecoderPool } from './decoder_pool.ts';
import { Heap } from './heap.ts';
import type { ViewerProgram } from './program.ts';
import { isMixedContent, isThereButNotAllowed, type Requests } from './requests.ts';

/** ReadFailure of client/web/browser_source.hpp. */
const enum Failure {
    network = 0,
    shortBody = 1,
    fileGone = 3,
    notAllowed = 4,
    mixedContent = 5,
    notPrepared = 6,
}

/**
 * What the viewer's program asks of the page (client/web/host.hpp): bytes of addresses and files, workers, and
 * to be called again when something arrived. It judges nothing: status, ranges and versions are C++'s matter.
 */
export class Host {
    private readonly requests = new Map<number, AbortController>();
    private readonly files = new Map<number, File>();
    private lastFile = 0;
    private program!: ViewerProgram;
    private heap!: Heap;
    private decoders: DecoderPool | undefined;

    constructor(
        readonly wake: () => void,
        private readonly sending: Requests,
    ) {}

    /** Starts with the program that this host serves. */
    attach(program: ViewerProgram): Heap {
        this.program = program;
        this.heap = new Heap(program);
        this.decoders = new DecoderPool({
            decoded: (job, message, arrays) => this.decoded(job, message, arrays),
            failed: (job, detail) =>
                this.heap.lendTexts([detail], (at) => program._stipple_decode_failed(job, at!)),
        });
        return this.heap;
    }

    dispose(): void {
        this.requests.forEach((request) => request.abort());
        this.requests.clear();
        this.decoders?.dispose();
    }

    keepFile(file: File): number {
        this.files.set(++this.lastFile, file);
        return this.lastFile;
    }

    closeFile(file: number): void {
        this.files.delete(file);
    }

    fetch(request: number, url: string, range: string): void {
        const controller = new AbortController();
        this.requests.set(request, controller);
        void this.fetchRange(request, url, range, controller).finally(() => this.requests.delete(request));
    }

    readFile(request: number, file: number, offset: number, size: number): void {
        this.requests.set(request, new AbortController());
        void this.files
            .get(file)!
            .slice(offset, offset + size)
            .arrayBuffer()
            .then(
                (buffer) => this.put(request, new Uint8Array(buffer)) && this.end(request),
                (error: unknown) => this.fail(request, Failure.fileGone, messageOf(error)),
            );
    }

    abort(request: number): void {
        this.requests.get(request)?.abort();
        this.requests.delete(request);
    }

    describeCloud(cloud: number, metadata: Uint8Array): void {
        this.decoders!.describe(cloud, metadata);
    }

    forgetCloud(cloud: number): void {
        this.decoders!.forget(cloud);
    }

    decode(job: number, message: Uint8Array, picture: Uint8Array, attributes: Uint8Array): void {
        this.decoders!.decode(job, message, picture, attributes);
    }

    private async fetchRange(
        request: number,
        url: string,
        range: string,
        { signal }: AbortController,
    ): Promise<void> {
        let failure = Failure.notPrepared;
        let asked = url;
        try {
            const prepared = await this.sending.prepared(url, range);
            asked = prepared.url;
            if (signal.aborted) return;
            if (isMixedContent(asked)) return this.fail(request, Failure.mixedContent, '');
            failure = Failure.network;
            const response = await fetch(asked, { ...prepared.init, signal });
            if (this.acceptHeaders(request, response) < 0) return; // the program has it aborted
            failure = Failure.shortBody;
            await this.readBody(request, response);
        } catch (error) {
            if (signal.aborted) return;
            const isHidden = failure === Failure.network && (await isThereButNotAllowed(asked, signal));
            if (isHidden) this.fail(request, Failure.notAllowed, location.origin);
            else this.fail(request, failure, navigator.onLine ? messageOf(error) : 'this machine is offline');
        }
    }

    /** Each piece goes to its place as it comes, so that the program knows how far the answer is. */
    private async readBody(request: number, response: Response): Promise<void> {
        const reader = response.body?.getReader();
        for (;;) {
            const { done, value } = (await reader?.read()) ?? { done: true, value: undefined };
            if (done) return this.end(request);
            if (!this.put(request, value)) return; // taken back, or longer than it may be: aborted
        }
    }

    private acceptHeaders(request: number, response: Response): number {
        const field = (name: string): string => response.headers.get(name) ?? '';
        const isCoded = field('content-encoding') !== '';
        const length = isCoded || field('content-length') === '' ? -1 : Number(field('content-length'));
        return this.heap.lendTexts(
            [field('content-range'), field('etag'), field('last-modified'), field('retry-after')],
            (contentRange, etag, lastModified, retryAfter) =>
                this.program._stipple_read_headers(
                    request,
                    response.status,
                    contentRange!,
                    etag!,
                    lastModified!,
                    length,
                    retryAfter!,
                ),
        );
    }

    /** False: nobody wants it any more. */
    private put(request: number, part: Uint8Array): boolean {
        if (!this.requests.has(request)) return false;
        if (part.length === 0) return true;
        const at = this.program._stipple_read_buffer(request, part.length);
        if (at !== 0) this.heap.put(at, part);
        return at !== 0;
    }

    private end(request: number): void {
        if (this.requests.delete(request)) this.program._stipple_read_done(request);
    }

    private fail(request: number, failure: Failure, detail: string): void {
        if (this.requests.delete(request))
            this.heap.lendTexts([detail], (at) => this.program._stipple_read_failed(request, failure, at!));
    }

    private decoded(job: number, message: Uint8Array, arrays: Uint8Array[]): void {
        const wanted = this.heap.lend([message], (at) =>
            this.program._stipple_decode_answer(job, at!, message.length),
        );
        if (!wanted) return;
        arrays.forEach((array, index) => {
            const at = this.program._stipple_decode_array(job, index, array.length);
            if (array.length > 0 && at === 0) throw new Error('a decoding worker is of another version');
            this.heap.put(at, array);
        });
        this.program._stipple_decode_done(job);
    }
}

function messageOf(error: unknown): string {
    return error instanceof Error ? error.message : String(error);
}
