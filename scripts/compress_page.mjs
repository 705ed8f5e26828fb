// Puts coded copies beside the files of a built page, for servers that send them by Accept-Encoding: FILE.br,
// FILE.zst and FILE.gz, each where it is worth its place. `stipple serve` does, and so do nginx (gzip_static,
// brotli_static) and Caddy (precompressed).
//   node scripts/compress_page.mjs FOLDER
import { execFile } from 'node:child_process';
import { readdir, readFile, stat, unlink, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { promisify } from 'node:util';
import { brotliCompress, constants, gzip } from 'node:zlib';

const compressible = /\.(css|html|js|json|map|mjs|svg|txt|wasm|webmanifest)$/;
const smallest = 256; // bytes; below, a copy saves no packet

const codings = {
    async br(file, bytes) {
        const options = { params: { [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length } }; // quality 11
        await writeFile(`${file}.br`, await promisify(brotliCompress)(bytes, options));
    },
    async gz(file, bytes) {
        await writeFile(`${file}.gz`, await promisify(gzip)(bytes, { level: 9 }));
    },
    // Level 19: the highest whose window is no larger than the 8 MiB that browsers accept (RFC 9659).
    async zst(file) {
        await promisify(execFile)('zstd', ['-19', '--quiet', '--force', '--no-check', file, '-o', `${file}.zst`]);
    },
};

async function compress(file) {
    const bytes = await readFile(file);
    const sizes = [];
    for (const [suffix, write] of Object.entries(codings)) {
        const copy = `${file}.${suffix}`;
        await write(file, bytes);
        const { size } = await stat(copy);
        if (size > bytes.length * 0.95) await unlink(copy);
        else sizes.push(`${suffix} ${size}`);
    }
    return `${file}: ${bytes.length} bytes; ${sizes.join(', ') || 'no copy is smaller'}`;
}

const folder = process.argv[2];
const names = await readdir(folder, { recursive: true });
const files = [];
for (const name of names.sort()) {
    const file = join(folder, name);
    if (compressible.test(name) && (await stat(file)).size >= smallest) files.push(file);
}
const lines = await Promise.all(files.map(compress));
console.log(lines.join('\n'));
