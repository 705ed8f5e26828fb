import { DecoderPool } from './decoder_pool.ts';
import { Heap } from './heap.ts';
import type { ViewerProgram } from './program.ts';
import { isMixedContent, isThereButNotAllowed, type Requests } from './requests.ts';
import { StoredFiles } from './stored_files.ts';
import type { StoredFile } from './stored_ranges.ts';

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
    private readonly decoders: DecoderPool;
    private readonly stored: StoredFiles;

    constructor(
        readonly wake: () => void,
        private readonly sending: Requests,
    ) {
        this.stored = new StoredFiles(sending);
        // They start while the viewer's program is on its way.
        this.decoders = new DecoderPool({
            decoded: (job, message, arrays) => this.decoded(job, message, arrays),
            failed: (job, detail) =>
                this.heap.lendTexts([detail], (at) => this.program._stipple_decode_failed(job, at!)),
        });
    }

    /** Starts with the program that this host serves. */
    attach(program: ViewerProgram): Heap {
        this.program = program;
        this.heap = new Heap(program);
        return this.heap;
    }

    dispose(): void {
        this.requests.forEach((request) => request.abort());
        this.requests.clear();
        this.decoders.dispose();
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
        this.decoders.describe(cloud, metadata);
    }

    forgetCloud(cloud: number): void {
        this.decoders.forget(cloud);
    }

    decode(job: number, message: Uint8Array, picture: Uint8Array, attributes: Uint8Array): void {
        this.decoders.decode(job, message, picture, attributes);
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
            const stored = await this.stored.of(url);
            if (stored && (await this.answerStored(request, stored, range))) return;
            if (signal.aborted) return;
            const prepared = await this.sending.prepared(url, range);
            asked = prepared.url;
            if (signal.aborted) return;
            if (isMixedContent(asked)) return this.fail(request, Failure.mixedContent, '');
            failure = Failure.network;
            const response = await fetch(asked, { ...prepared.init, signal });
            const fields = fieldsOf(response);
            if (stored && fields.etag !== stored.etag) this.stored.forget(url);
            const expected = this.acceptHeaders(request, response.status, fields);
            if (expected < 0) return; // the program has it aborted
            failure = Failure.shortBody;
            const isToStay = fields.etag === stored?.etag;
            const body = await this.readBody(request, response, isToStay ? expected : 0);
            if (isToStay && body) void stored.keep(firstOf(range), body);
        } catch (error) {
            if (signal.aborted) return;
            const isHidden = failure === Failure.network && (await isThereButNotAllowed(asked, signal));
            if (isHidden) this.fail(request, Failure.notAllowed, location.origin);
            else this.fail(request, failure, navigator.onLine ? messageOf(error) : 'this machine is offline');
        }
    }

    /** Of the version that was found to be its server's. False: not all of it is there, or nobody wants it any more. */
    private async answerStored(request: number, stored: StoredFile, range: string): Promise<boolean> {
        if (!this.requests.has(request)) return false;
        if (stored.wasKnown) this.program._stipple_read_is_stored(request);
        const [first, last] = range.slice('bytes='.length).split('-').map(Number) as [number, number];
        const end = Math.min(last + 1, stored.sizeBytes);
        const body = first < end ? await stored.read(first, end).catch(() => undefined) : undefined;
        if (!body || !this.requests.has(request)) return false;
        const contentRange = `bytes ${first}-${end - 1}/${stored.sizeBytes}`;
        const fields = { contentRange, etag: stored.etag, lastModified: '', retryAfter: '', contentLength: body.length };
        if (this.acceptHeaders(request, 206, fields) >= 0 && this.put(request, body)) this.end(request);
        return true;
    }

    /** Each piece goes to its place as it comes, so that the program knows how far the answer is. A copy, if it is `copied` bytes. */
    private async readBody(request: number, response: Response, copied: number): Promise<Uint8Array | undefined> {
        const copy = new Uint8Array(copied);
        const reader = response.body?.getReader();
        for (let here = 0; ; ) {
            const { done, value } = (await reader?.read()) ?? { done: true, value: undefined };
            if (done) {
                this.end(request);
                return here === copied ? copy : undefined;
            }
            if (!this.put(request, value)) return undefined; // taken back, or longer than it may be: aborted
            if (here + value.length <= copied) copy.set(value, here);
            here += value.length;
        }
    }

    private acceptHeaders(request: number, status: number, fields: Fields): number {
        const { contentRange, etag, lastModified, retryAfter, contentLength } = fields;
        return this.heap.lendTexts([contentRange, etag, lastModified, retryAfter], (a, b, c, d) =>
            this.program._stipple_read_headers(request, status, a!, b!, c!, contentLength, d!),
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

/** What an answer's header says; empty where it says nothing, or -1. */
interface Fields {
    contentRange: string;
    etag: string;
    lastModified: string;
    retryAfter: string;
    contentLength: number;
}

function fieldsOf(response: Response): Fields {
    const field = (name: string): string => response.headers.get(name) ?? '';
    const isCoded = field('content-encoding') !== '';
    return {
        contentRange: field('content-range'),
        etag: field('etag'),
        lastModified: field('last-modified'),
        retryAfter: inSeconds(field('retry-after'), field('date')),
        contentLength: isCoded || field('content-length') === '' ? -1 : Number(field('content-length')),
    };
}

/** A Retry-After: of a date, the seconds after the answer's own, or after now where that is not shown (shared/io/retry_after.hpp). */
function inSeconds(retryAfter: string, date: string): string {
    const timeOf = (text: string): number => Date.parse(/ GMT$/.test(text) ? text : `${text} GMT`);
    const until = /^[A-Z][a-z]+,? /.test(retryAfter) ? timeOf(retryAfter) : NaN, from = timeOf(date);
    if (Number.isNaN(until)) return retryAfter;
    return String(Math.max(0, Math.ceil((until - (Number.isNaN(from) ? Date.now() : from)) / 1000)));
}

/** Of "bytes=0-65535". */
function firstOf(range: string): number {
    return Number(/\d+/.exec(range)![0]);
}

function messageOf(error: unknown): string {
    return error instanceof Error ? error.message : String(error);
}
