import type { FromPngWorker, ToPngWorker } from './png_messages.ts';

/** Where the bytes of a file go, in their order; the next wait until these are taken. */
export type TakeBytes = (bytes: Uint8Array<ArrayBuffer>) => Promise<void>;

/** PNGs, coded by a worker while further rows are drawn. One at a time; what goes wrong is thrown by the next call. */
export class PngStream {
    private readonly worker = new Worker(new URL('./png_worker.ts', import.meta.url), { type: 'module' });
    /** Messages without an answer. */
    private waiting = 0;
    private failure: Error | undefined;
    private written: Promise<void> = Promise.resolve();
    private wake = (): void => {};
    private take: TakeBytes = () => Promise.resolve();

    constructor() {
        this.worker.onmessage = (event: MessageEvent<FromPngWorker>) => this.receive(event.data);
        this.worker.onerror = (event) => this.receive({ kind: 'failed', sentence: event.message || 'the PNG worker stopped' });
    }

    begin(width: number, height: number, take: TakeBytes): void {
        this.take = take;
        this.send({ kind: 'begin', width, height });
    }
    /** The next rows, which are not the caller's any more. Resolves when there is room for others. */
    async append(rgba: Uint8Array<ArrayBuffer>): Promise<void> {
        await this.answered(1);
        this.send({ kind: 'rows', rgba }, [rgba.buffer]);
    }
    /** Resolves when all of its bytes are taken. */
    async finish(): Promise<void> {
        this.send({ kind: 'finish' });
        await this.answered(0);
    }
    stop(): void {
        this.worker.terminate();
    }

    private send(message: ToPngWorker, transfer: Transferable[] = []): void {
        this.waiting++;
        this.worker.postMessage(message, transfer);
    }

    private receive(answer: FromPngWorker): void {
        if (answer.kind === 'bytes') {
            this.written = this.written.then(() => this.take(answer.bytes));
            this.written.catch((error: unknown) => this.fail(error));
            return;
        }
        this.waiting--;
        if (answer.kind === 'failed') this.fail(new Error(answer.sentence));
        this.wake();
    }
    private fail(error: unknown): void {
        this.failure ??= error instanceof Error ? error : new Error(String(error));
        this.wake();
    }

    /** Waits until at most so many messages have no answer, and what came is taken. */
    private async answered(most: number): Promise<void> {
        while (this.waiting > most && !this.failure) await new Promise<void>((resolve) => (this.wake = resolve));
        if (!this.failure) await this.written;
        if (this.failure) throw this.failure;
    }
}
