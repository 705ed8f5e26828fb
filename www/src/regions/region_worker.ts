// The region worker: runs client/web/region_exports.cpp on the nodes that it is sent, one work in its life.
import createRegion from '@programs/stipple_region.mjs';

import { Said } from '../texts/said.ts';
import { Heap } from '../wasm/heap.ts';
import type { Address, ProgramOptions, RegionProgram } from '../wasm/program.ts';
import type { RegionAnswer, RegionScan } from '../wasm/values.ts';
import type { FromRegionWorker, Patch, ToRegionWorker } from './region_messages.ts';

const scope = self as unknown as {
    onmessage: ((event: MessageEvent<ToRegionWorker>) => void) | null;
    postMessage(message: FromRegionWorker, transfer?: Transferable[]): void;
};

let program: RegionProgram, heap: Heap;

/** What a call answers; throws the sentence of its error. */
function answerOf<T>(at: Address): T | undefined {
    const { answer, error } = JSON.parse(heap.text(at)) as { answer?: T; error?: string };
    if (error !== undefined) throw new Said(error);
    return answer;
}

function takePiece(): Uint8Array<ArrayBuffer> | undefined {
    const size = program._stipple_region_piece();
    return size > 0 ? heap.copy(program._stipple_region_bytes(), size) : undefined;
}

async function open(message: ToRegionWorker & { kind: 'open' }): Promise<void> {
    program = await new Promise<RegionProgram>((resolve, reject) => {
        const options: ProgramOptions = {
            instantiateWasm: (imports, receive) => {
                WebAssembly.instantiate(message.program, imports).then(receive, reject);
                return {};
            },
        };
        createRegion(options).then((made) => resolve(made as RegionProgram), reject);
    });
    heap = new Heap(program);
    const request = new TextEncoder().encode(`${JSON.stringify(message.request)}\0`);
    const scan = heap.lend([message.metadata, request], (metadata, text) =>
        answerOf<RegionScan>(program._stipple_region_open(metadata!, message.metadata.length, text!)),
    );
    scope.postMessage({ kind: 'opened', scan: scan! });
}

function take(message: ToRegionWorker & { kind: 'node' }): void {
    heap.lend([message.message, message.bytes], (at, bytes) =>
        answerOf(program._stipple_region_node(at!, message.message.length, bytes!, message.bytes.length)),
    );
    const points = program._stipple_region_points(), piece = takePiece();
    scope.postMessage({ kind: 'took', points, ...(piece && { piece }) }, piece ? [piece.buffer] : []);
}

function finish(): void {
    const answer = answerOf<RegionAnswer>(program._stipple_region_finish())!;
    const piece = takePiece(), patches: Patch[] = [];
    for (let at = program._stipple_region_patch(); at >= 0; at = program._stipple_region_patch())
        patches.push({ offset: at, bytes: heap.copy(program._stipple_region_bytes(), program._stipple_region_bytes_size()) });
    scope.postMessage({ kind: 'finished', answer, ...(piece && { piece }), patches }, piece ? [piece.buffer] : []);
}

async function handle(message: ToRegionWorker): Promise<void> {
    try {
        if (message.kind === 'open') await open(message);
        else if (message.kind === 'node') take(message);
        else finish();
    } catch (error) {
        scope.postMessage({ kind: 'failed', said: error instanceof Said ? error.said : error instanceof Error ? error.message : String(error) });
    }
}

scope.onmessage = (event) => void handle(event.data);
