import { DecoderPool } from './decoder_pool.ts';
import { Heap } from './heap.ts';
import type { ViewerProgram } from './program.ts';
import { contentRangeOf, type Fields, fieldsOf, isGap, rangeOf, spanOf } from './range_answers.ts';
import { isMixedContent, isThereButNotAllowed, type Requests } from './requests.ts';
import { StoredFiles } from './stored_files.ts';
import type { Part, StoredFile } from './stored_ranges.ts';

/** ReadFailure of client/web/browser_source.hpp. */
const enum Failure {
    network = 0,
    shortBody = 1,
    longBody = 2,
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
        void this.fetchRange(request, url, range, controller.signal).finally(() => {
            controller.abort(); // what else is on its way for it
            this.requests.delete(request);
        });
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

    describeCloud(cloud: number, description: Uint8Array): void {
        this.decoders.describe(cloud, description);
    }

    forgetCloud(cloud: number): void {
        this.decoders.forget(cloud);
    }

    decode(job: number, message: Uint8Array, picture: Uint8Array, attributes: Uint8Array): void {
        this.decoders.decode(job, message, picture, attributes);
    }

    private async fetchRange(request: number, url: string, range: string, signal: AbortSignal): Promise<void> {
        const sent: Sent = { failure: Failure.notPrepared, asked: url };
        try {
            const stored = await this.stored.of(url), parts = await this.partsOf(request, stored, range);
            if (signal.aborted) return;
            const answers = await Promise.all(parts.filter(isGap).map((gap) => this.send(url, rangeOf(gap), signal, sent)));
            const expected = this.judge(request, url, stored, parts, answers);
            if (expected < 0) return; // the program has it aborted
            sent.failure = Failure.shortBody;
            if (parts.length === 1) parts[0]!.end = parts[0]!.at + expected;
            for (const part of parts) {
                const isWanted = part.bytes ? this.put(request, part.bytes) : await this.receive(request, part, answers.shift()!, stored, sent);
                if (!isWanted) return;
            }
            this.end(request);
        } catch (error) {
            if (signal.aborted) return;
            const isHidden = sent.failure === Failure.network && (await isThereButNotAllowed(sent.asked, signal));
            if (isHidden) this.fail(request, Failure.notAllowed, location.origin);
            else this.fail(request, sent.failure, navigator.onLine ? messageOf(error) : 'this machine is offline');
        }
    }

    /** What of the range is stored, in the version that was found to be its server's, and what is not. */
    private async partsOf(request: number, stored: StoredFile | undefined, range: string): Promise<Part[]> {
        const all = spanOf(range), end = Math.min(all.end, stored?.sizeBytes ?? 0);
        if (!stored || all.at >= end || !this.requests.has(request)) return [all];
        if (stored.wasKnown) this.program._stipple_read_is_stored(request);
        return stored.parts(all.at, end).catch(() => [all]);
    }

    private async send(url: string, range: string, signal: AbortSignal, sent: Sent): Promise<Response> {
        const prepared = await this.sending.prepared(url, range);
        sent.asked = prepared.url;
        signal.throwIfAborted();
        sent.failure = isMixedContent(sent.asked) ? Failure.mixedContent : Failure.network;
        if (sent.failure === Failure.mixedContent) throw new Error('not to be asked for');
        return fetch(sent.asked, { ...prepared.init, signal });
    }

    /**
     * How many bytes the answers bring, as the program judges them; below 0: none of them is wanted. Those to gaps stand for the whole range
     * if all are as they have to be; else the first that is not speaks.
     */
    private judge(request: number, url: string, stored: StoredFile | undefined, parts: Part[], answers: Response[]): number {
        const fields = answers.map(fieldsOf), gaps = parts.filter(isGap);
        if (stored && fields.some(({ etag }) => etag !== stored.etag)) this.stored.forget(url);
        if (!stored || gaps.length === parts.length) return this.acceptHeaders(request, answers[0]!.status, fields[0]!);
        const isRight = (gap: Part, { contentRange }: Fields): boolean => contentRange === contentRangeOf(gap, stored.sizeBytes);
        const contentRange = contentRangeOf({ at: parts[0]!.at, end: parts.at(-1)!.end }, stored.sizeBytes);
        const whole = { contentRange, etag: stored.etag, lastModified: '', retryAfter: '', contentLength: -1 };
        const odd = gaps.findIndex((gap, i) => answers[i]!.status !== 206 || fields[i]!.etag !== stored.etag || !isRight(gap, fields[i]!));
        if (odd < 0) return this.acceptHeaders(request, 206, whole);
        const told = isRight(gaps[odd]!, fields[odd]!) ? { ...fields[odd]!, contentRange } : fields[odd]!;
        if (this.acceptHeaders(request, answers[odd]!.status, told) >= 0)
            this.fail(request, Failure.network, 'it does not say any more which version it has');
        return -1;
    }

    /** Each piece of an answer goes to its place as it comes, so that the program knows how far it is. False: nobody wants it any more. */
    private async receive(request: number, gap: Part, response: Response, stored: StoredFile | undefined, sent: Sent): Promise<boolean> {
        const size = gap.end - gap.at, isToStay = stored !== undefined && fieldsOf(response).etag === stored.etag;
        const copy = new Uint8Array(isToStay ? size : 0), reader = response.body?.getReader();
        let here = 0;
        for (;;) {
            const { done, value } = (await reader?.read()) ?? { done: true, value: undefined };
            if (done) break;
            if (here + value.length > size) {
                sent.failure = Failure.longBody;
                throw new Error('too many bytes');
            }
            if (!this.put(request, value)) return false;
            if (isToStay) copy.set(value, here);
            here += value.length;
        }
        if (here < size) throw new Error('too few bytes');
        if (isToStay) void stored.keep(gap.at, copy);
        return true;
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

/** How far a read has come, and the address that was asked in the end. */
interface Sent {
    failure: Failure;
    asked: string;
}

function messageOf(error: unknown): string {
    return error instanceof Error ? error.message : String(error);
}
