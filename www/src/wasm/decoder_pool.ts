import decoderUrl from '@programs/stipple_decoder.wasm?url';

import { compiledOnce } from './compiled.ts';
import type { FromDecoder, ToDecoder } from './decoder_messages.ts';

interface Hand {
    worker: Worker;
    jobs: Set<number>;
    stopped?: string; // why it takes no more jobs
}

export interface DecoderAnswers {
    decoded(job: number, message: Uint8Array, arrays: Uint8Array[]): void;
    failed(job: number, detail: string): void;
}

/** Decoding workers. The program is fetched and compiled once and shared out; a job goes to the least busy. */
export class DecoderPool {
    private readonly hands: Hand[];

    constructor(private readonly answers: DecoderAnswers) {
        // One core is left to the page itself; more than four decode faster than a network delivers.
        const count = Math.min(4, Math.max(1, (navigator.hardwareConcurrency || 2) - 1));
        this.hands = Array.from({ length: count }, () => this.hire());
        void this.share();
    }

    describe(cloud: number, description: Uint8Array): void {
        for (const hand of this.hands)
            this.send(hand, { kind: 'describe', cloud, description: new Uint8Array(description) });
    }

    forget(cloud: number): void {
        for (const hand of this.hands) this.send(hand, { kind: 'forget', cloud });
    }

    /** The bytes are copied before this returns. */
    decode(job: number, message: Uint8Array, picture: Uint8Array, attributes: Uint8Array): void {
        const able = this.hands.filter((hand) => hand.stopped === undefined);
        if (able.length === 0) {
            const reason = this.hands[0]!.stopped!;
            queueMicrotask(() => this.answers.failed(job, reason));
            return;
        }
        const hand = able.reduce((least, next) => (next.jobs.size < least.jobs.size ? next : least));
        hand.jobs.add(job);
        const copies = [message, picture, attributes].map((part) => new Uint8Array(part));
        this.send(
            hand,
            { kind: 'decode', job, message: copies[0]!, picture: copies[1]!, attributes: copies[2]! },
            copies.map((copy) => copy.buffer),
        );
    }

    dispose(): void {
        this.hands.forEach((hand) => hand.worker.terminate());
    }

    private async share(): Promise<void> {
        try {
            const program = await compiledOnce(decoderUrl);
            this.hands.forEach((hand) => this.send(hand, { kind: 'program', program }));
        } catch (error) {
            this.hands.forEach((hand) => this.dismiss(hand, `the decoder did not load: ${String(error)}`));
        }
    }

    private hire(): Hand {
        const worker = new Worker(new URL('./decoder_worker.ts', import.meta.url), { type: 'module' });
        const hand: Hand = { worker, jobs: new Set() };
        worker.onmessage = (event: MessageEvent<FromDecoder>) => {
            const answer = event.data;
            hand.jobs.delete(answer.job);
            if (answer.kind === 'decoded') this.answers.decoded(answer.job, answer.message, answer.arrays);
            else this.answers.failed(answer.job, answer.detail);
        };
        worker.onerror = (event) => this.dismiss(hand, `a decoding worker stopped: ${event.message}`);
        return hand;
    }

    /** Every job that waits for this hand is answered with the reason, and every later one too. */
    private dismiss(hand: Hand, reason: string): void {
        hand.worker.terminate();
        hand.stopped = reason;
        hand.jobs.forEach((job) => this.answers.failed(job, reason));
        hand.jobs.clear();
    }

    private send(hand: Hand, message: ToDecoder, transfer: Transferable[] = []): void {
        hand.worker.postMessage(message, transfer);
    }
}
