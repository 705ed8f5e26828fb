// What the page and the region worker say to each other.

import type { RegionAnswer, RegionRequest, RegionScan } from '../wasm/values.ts';

export interface Patch {
    offset: number;
    bytes: Uint8Array<ArrayBuffer>;
}

export type ToRegionWorker =
    /** `metadata`: as in the cloud's file. */
    | { kind: 'open'; program: WebAssembly.Module; metadata: Uint8Array<ArrayBuffer>; request: RegionRequest }
    | { kind: 'node'; message: Uint8Array<ArrayBuffer>; bytes: Uint8Array<ArrayBuffer> }
    | { kind: 'finish' };

export type FromRegionWorker =
    | { kind: 'opened'; scan: RegionScan }
    /** `points`: that were in the region so far. */
    | { kind: 'took'; points: number; piece?: Uint8Array<ArrayBuffer> }
    /** `patches`: bytes in place of others that came, in their order. */
    | { kind: 'finished'; answer: RegionAnswer; piece?: Uint8Array<ArrayBuffer>; patches: Patch[] }
    | { kind: 'failed'; said: string };
