// What the page and the region worker say to each other.

import type { RegionAnswer, RegionRequest, RegionScan } from '../wasm/values.ts';

export type ToRegionWorker =
    /** `metadata`: as in the cloud's file. `streams`: what is made is wanted as it comes, not as one file at the end. */
    | { kind: 'open'; program: WebAssembly.Module; metadata: Uint8Array<ArrayBuffer>; request: RegionRequest; streams: boolean }
    | { kind: 'node'; message: Uint8Array<ArrayBuffer>; bytes: Uint8Array<ArrayBuffer> }
    | { kind: 'finish' };

export type FromRegionWorker =
    | { kind: 'opened'; scan: RegionScan }
    /** `points`: that were in the region so far. */
    | { kind: 'took'; points: number; piece?: Uint8Array<ArrayBuffer> }
    | { kind: 'finished'; answer: RegionAnswer; file?: Blob }
    | { kind: 'failed'; sentence: string };
