import type { Address, Program } from './program.ts';

const encoder = new TextEncoder();
const decoder = new TextDecoder();

/**
 * The one place that touches a program's memory. Growing it detaches every view of it, so none is kept here:
 * each call takes the present one, after anything that may allocate.
 */
export class Heap {
    constructor(private readonly program: Program) {}

    /** Lends copies of `parts` to `use`, as address and size each; freed when it returns. */
    lend<T>(parts: Uint8Array[], use: (...at: Address[]) => T): T {
        const addresses = parts.map((part) => this.allocate(Math.max(1, part.length)));
        parts.forEach((part, index) => this.put(addresses[index]!, part));
        try {
            return use(...addresses);
        } finally {
            addresses.forEach((at) => this.program._free(at));
        }
    }

    /** The same for texts, as NUL-terminated UTF-8. */
    lendTexts<T>(texts: string[], use: (...at: Address[]) => T): T {
        return this.lend(
            texts.map((text) => encoder.encode(`${text}\0`)),
            use,
        );
    }

    put(at: Address, bytes: Uint8Array): void {
        this.program.HEAPU8.set(bytes, at);
    }

    /** A copy with a buffer of its own, fit to be transferred. */
    copy(at: Address, size: number): Uint8Array<ArrayBuffer> {
        return new Uint8Array(this.program.HEAPU8.subarray(at, at + size));
    }

    /** The NUL-terminated text at `at`. */
    text(at: Address): string {
        const memory = this.program.HEAPU8;
        return decoder.decode(memory.subarray(at, memory.indexOf(0, at)));
    }

    private allocate(size: number): Address {
        const at = this.program._malloc(size);
        if (at === 0) throw new Error(`out of memory: ${size} bytes are not to be had`);
        return at;
    }
}
