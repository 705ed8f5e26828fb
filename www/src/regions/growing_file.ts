/** A file in pieces, whose beginning is written last. */
export class GrowingFile {
    private readonly pieces: { offset: number; bytes: Uint8Array<ArrayBuffer> }[] = [];
    private size = 0;

    append(bytes: Uint8Array<ArrayBuffer>): void {
        this.pieces.push({ offset: this.size, bytes });
        this.size += bytes.length;
    }

    /** Bytes that are there. */
    overwrite(offset: number, bytes: Uint8Array): void {
        for (const piece of this.pieces) {
            const from = Math.max(offset, piece.offset);
            const to = Math.min(offset + bytes.length, piece.offset + piece.bytes.length);
            if (from < to) piece.bytes.set(bytes.subarray(from - offset, to - offset), from - piece.offset);
        }
    }

    blob(): Blob {
        return new Blob(this.pieces.map((piece) => piece.bytes));
    }
}
