// What the page and a decoding worker say to each other.

export type ToDecoder =
    | { kind: 'program'; program: WebAssembly.Module }
    | { kind: 'describe'; cloud: number; description: Uint8Array<ArrayBuffer> }
    | { kind: 'forget'; cloud: number }
    | {
          kind: 'decode';
          job: number;
          message: Uint8Array<ArrayBuffer>;
          picture: Uint8Array<ArrayBuffer>;
          attributes: Uint8Array<ArrayBuffer>;
      };

export type FromDecoder =
    /** `arrays`: those of client/web/decode_messages.hpp, in its order; buffers are transferred. */
    | { kind: 'decoded'; job: number; message: Uint8Array<ArrayBuffer>; arrays: Uint8Array<ArrayBuffer>[] }
    | { kind: 'failed'; job: number; detail: string };

export const nodeArrayCount = 4;
