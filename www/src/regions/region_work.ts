import regionUrl from '@programs/stipple_region.wasm?url';

import type { Model } from '../model.ts';
import { Problem } from '../texts/message.ts';
import { Said } from '../texts/said.ts';
import { compiledOnce } from '../wasm/compiled.ts';
import type { RegionAnswer, RegionRequest } from '../wasm/values.ts';
import type { Viewer } from '../wasm/viewer.ts';
import type { FromRegionWorker, ToRegionWorker } from './region_messages.ts';

/** So many nodes are with the worker at a time: one that it works on, one that waits. */
const nodesAhead = 2;
/** How often what has arrived is looked for. */
const lookPauseMs = 25;

export interface RegionProgress {
    /** 0..1, of the nodes known by now. */
    share: number;
    /** In the region, so far. */
    points: number;
}

export interface RegionListener {
    signal: AbortSignal;
    progress?(progress: RegionProgress): void;
    /** What is made, as it comes (client/region/point_taker.hpp); the work waits until it is taken. */
    piece?(bytes: Uint8Array<ArrayBuffer>): void | Promise<void>;
    /** At the end: bytes in place of others that came. */
    patch?(offset: number, bytes: Uint8Array<ArrayBuffer>): Promise<void>;
}

/**
 * One work on the points of a region of a cloud (client/region/region_work.hpp): the viewer reads the nodes, after all that the
 * picture wants; a worker makes something of their points. Throws the sentence of what failed; ends silently when aborted.
 */
export async function workOnRegion(
    model: Model,
    viewer: Viewer,
    cloud: number,
    request: RegionRequest,
    listener: RegionListener,
): Promise<RegionAnswer | undefined> {
    const isOver = (): boolean => listener.signal.aborted || model.isDisposed;
    await isOpen(model, cloud, listener.signal);
    const program = await compiledOnce(regionUrl);
    if (isOver()) return undefined;
    const worker = new RegionWorker();
    let scan: number | undefined;
    try {
        const opened = await worker.ask({
            kind: 'open',
            program,
            metadata: viewer.cloudMetadata(cloud),
            request,
        });
        if (opened.kind !== 'opened' || isOver()) return undefined;
        scan = viewer.scanRegion({ cloud, ...opened.scan });
        model.wake();
        let points = 0;
        for (;;) {
            if (isOver()) return undefined;
            for (const answer of worker.take()) {
                if (answer.kind !== 'took') continue;
                points = answer.points;
                if (answer.piece) await listener.piece?.(answer.piece);
            }
            const node = worker.waiting < nodesAhead ? viewer.takeRegionNode(scan) : undefined;
            if (node) {
                worker.send({ kind: 'node', ...node }, [node.message.buffer, node.bytes.buffer]);
                model.wake(); // there is room for the next
                continue;
            }
            const { complete, nodesDone, nodesToDo, error } = viewer.regionProgress(scan);
            if (error) throw new Said(error);
            listener.progress?.({ share: nodesDone / Math.max(1, nodesDone + nodesToDo), points });
            if (complete && worker.isIdle) break;
            if (document.hidden) viewer.frame(); // the browser calls for no frames now
            if (worker.waiting > 0 || !complete) await worker.answerOr(lookPauseMs);
        }
        const finished = await worker.ask({ kind: 'finish' });
        if (finished.kind !== 'finished' || isOver()) return undefined;
        if (finished.piece) await listener.piece?.(finished.piece);
        for (const { offset, bytes } of finished.patches) await listener.patch?.(offset, bytes);
        return finished.answer;
    } finally {
        worker.stop();
        if (scan !== undefined && !model.isDisposed) viewer.endRegionScan(scan);
        model.wake();
    }
}

/** Waits for a cloud that is being opened; throws for one that can't be. */
async function isOpen(model: Model, cloud: number, signal: AbortSignal): Promise<void> {
    while (!signal.aborted && !model.isDisposed) {
        const state = model.clouds.find(({ id }) => id === cloud);
        if (state?.stage === 'ready') return;
        if (state?.stage === 'waiting') model.opened.openNow(cloud);
        if (!state || state.stage === 'failed') throw new Problem('region.notOpen');
        await new Promise((resolve) => setTimeout(resolve, 100));
    }
}

/** The worker, and what it has answered. */
class RegionWorker {
    /** Messages without an answer. */
    waiting = 0;
    private readonly worker = new Worker(new URL('./region_worker.ts', import.meta.url), { type: 'module' });
    private readonly answers: FromRegionWorker[] = [];
    private wake = (): void => {};

    constructor() {
        this.worker.onmessage = (event: MessageEvent<FromRegionWorker>) => this.receive(event.data);
        this.worker.onerror = (event) => this.receive({ kind: 'failed', said: event.message || 'the region worker stopped' });
    }

    send(message: ToRegionWorker, transfer: Transferable[] = []): void {
        this.waiting++;
        this.worker.postMessage(message, transfer);
    }
    /** All that it was sent is answered, and the answers are taken. */
    get isIdle(): boolean {
        return this.waiting === 0 && this.answers.length === 0;
    }
    /** The answers since the last call; throws the sentence of a failure. */
    take(): FromRegionWorker[] {
        const answers = this.answers.splice(0);
        for (const answer of answers) if (answer.kind === 'failed') throw new Said(answer.said);
        return answers;
    }
    /** One message, and its answer; nothing else is waited for. */
    async ask(message: ToRegionWorker): Promise<FromRegionWorker> {
        this.send(message);
        for (;;) {
            const [answer] = this.take();
            if (answer) return answer;
            await this.answerOr(1000);
        }
    }
    /** Resolves when an answer came, or after a pause. */
    answerOr(pauseMs: number): Promise<void> {
        return new Promise((resolve) => {
            const timer = setTimeout(resolve, pauseMs);
            this.wake = () => {
                clearTimeout(timer);
                resolve();
            };
        });
    }
    stop(): void {
        this.worker.terminate();
    }

    private receive(answer: FromRegionWorker): void {
        this.waiting--;
        this.answers.push(answer);
        this.wake();
    }
}
