/** One life of a viewer, from its start until it is disposed of. */
export class Run {
    /** Resolves when it runs; rejects if it can't, or is stopped first. */
    readonly ready: Promise<void>;
    /** The server's list has come, or failed to. */
    listed: Promise<void> = Promise.resolve();
    private readonly stopping = new AbortController();
    private settle!: { resolve: () => void; reject: (reason: Error) => void };

    constructor() {
        this.ready = new Promise((resolve, reject) => (this.settle = { resolve, reject }));
        this.ready.catch(() => {}); // also told by the event 'problem'
    }

    /** Aborted when it stops. */
    get signal(): AbortSignal {
        return this.stopping.signal;
    }
    get isStopped(): boolean {
        return this.stopping.signal.aborted;
    }

    begin(): void {
        this.settle.resolve();
    }
    fail(reason: Error): void {
        this.settle.reject(reason);
    }
    stop(): void {
        this.stopping.abort();
        this.settle.reject(new Error('the viewer was disposed of before it was ready'));
    }
}
