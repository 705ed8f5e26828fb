import { Zip, ZipPassThrough } from 'fflate';

import { intoFile, newFile } from '../files/output_file.ts';
import type { Model } from '../model.ts';
import type { FrameExport } from '../navigation/film.ts';
import { Problem } from '../texts/message.ts';
import { withPng, withSize } from './pictures.ts';

/** What an archive without ZIP64 can tell (APPNOTE 4.4.1.4), less its directory. */
const mostBytes = 0xffffffff - (8 << 20);

export interface FilmListener {
    signal: AbortSignal;
    /** So many pictures are written. */
    done(frames: number): void;
}

/** The pictures of the model's camera path, `of` of them, as PNGs in an archive, which grows on the disk where the browser has that. */
export async function writeFrames(model: Model, options: FrameExport & { of: number }, { signal, done }: FilmListener): Promise<void> {
    const before = model.camera.read();
    await intoFile(model, 'frames.zip', newFile, async (file) => {
        try {
            let written: Promise<void> = Promise.resolve(), bytes = 0;
            const zip = new Zip((error, chunk) => {
                if (error) throw error;
                bytes += chunk.length;
                if (bytes > mostBytes) throw new Problem('film.tooLarge');
                written = written.then(() => file.write(new Uint8Array(chunk)));
            });
            const isWhole = await withPng((png) =>
                withSize(model, options, async (picture) => {
                    for (let i = 0; i < options.of; i++) {
                        model.camera.placeOnTrack(i / options.framesPerSecond);
                        const entry = new ZipPassThrough(`frame_${String(i).padStart(5, '0')}.png`); // PNG is deflated already
                        zip.add(entry);
                        const take = (piece: Uint8Array<ArrayBuffer>): Promise<void> => {
                            entry.push(piece);
                            return written;
                        };
                        if (!(await picture.write(png, take, { signal }))) return false;
                        entry.push(new Uint8Array(0), true);
                        await written;
                        done(i + 1);
                    }
                    return true;
                }),
            );
            if (isWhole) zip.end();
            await written;
            return isWhole;
        } finally {
            if (!model.isDisposed) model.camera.change(before);
        }
    });
}
