// What the page and the PNG worker say to each other.

/** Each is answered by `done` or `failed`, after the bytes that it gave. `rgba`: rows from the top. */
export type ToPngWorker =
    | { kind: 'begin'; width: number; height: number }
    | { kind: 'rows'; rgba: Uint8Array<ArrayBuffer> }
    | { kind: 'finish' };

export type FromPngWorker =
    | { kind: 'bytes'; bytes: Uint8Array<ArrayBuffer> }
    | { kind: 'done' }
    | { kind: 'failed'; sentence: string };
