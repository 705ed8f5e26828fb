import { DecoderPool } from './decoder_pool.ts';
import { Heap } from './heap.ts';
import type { ViewerProgram } from './program.ts';

/** ReadFailure of client/web/browser_source.hpp. */
const enum Failure {
    network = 0,
    shortBody = 1,
    longBody = 2,
    fileGone = 3,
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

    constructor(readonly wake: () => void) {}

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
                (buffer) => this.deliver(request, [new Uint8Array(buffer)], size),
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
        controller: AbortController,
    ): Promise<void> {
        let failure = Failure.network;
        try {
            // Browsers' caches serialise ranges of one address and have mixed them up; the viewer has its own.
            const options: RequestInit = { cache: 'no-store', signal: controller.signal };
            const response = await fetch(url, { ...options, headers: { Range: range } });
            const expected = this.acceptHeaders(request, response);
            if (expected < 0) return;
            failure = Failure.shortBody;
            const parts = await readAtMost(response, expected);
            if (!controller.signal.aborted) this.deliver(request, parts, expected);
        } catch (error) {
            if (!controller.signal.aborted) this.fail(request, failure, messageOf(error));
        }
    }

    private acceptHeaders(request: number, response: Response): number {
        const field = (name: string): string => response.headers.get(name) ?? '';
        const isCoded = field('content-encoding') !== '';
        const length = isCoded || field('content-length') === '' ? -1 : Number(field('content-length'));
        return this.heap.lendTexts(
            [field('content-range'), field('etag'), field('last-modified')],
            (contentRange, etag, lastModified) =>
                this.program._stipple_read_headers(
                    request,
                    response.status,
                    contentRange!,
                    etag!,
                    lastModified!,
                    length,
                ),
        );
    }

    private deliver(request: number, parts: Uint8Array[], expected: number): void {
        if (!this.requests.delete(request)) return; // taken back meanwhile
        const received = parts.reduce((sum, part) => sum + part.length, 0);
        if (received !== expected) {
            const failure = received < expected ? Failure.shortBody : Failure.longBody;
            this.report(request, failure, '');
            return;
        }
        let at = this.program._stipple_read_buffer(request, expected);
        for (const part of parts) {
            this.heap.put(at, part);
            at += part.length;
        }
        this.program._stipple_read_done(request);
    }

    private fail(request: number, failure: Failure, detail: string): void {
        if (this.requests.delete(request)) this.report(request, failure, detail);
    }

    private report(request: number, failure: Failure, detail: string): void {
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

/** The body, or what came of it as soon as it is longer than `limit`. */
async function readAtMost(response: Response, limit: number): Promise<Uint8Array[]> {
    const parts: Uint8Array[] = [];
    const reader = response.body?.getReader();
    if (!reader) return parts;
    for (let received = 0; received <= limit; ) {
        const { done, value } = await reader.read();
        if (done) return parts;
        parts.push(value);
        received += value.length;
    }
    await reader.cancel();
    return parts;
}

function messageOf(error: unknown): string {
    return error instanceof Error ? error.message : String(error);
}
