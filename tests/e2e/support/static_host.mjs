// A plain static host: files of a folder with byte ranges, and nothing that a file host would not do.
import { createReadStream } from 'node:fs';
import { stat } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';

const types = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm', '.svg': 'image/svg+xml' };

/** {address, close()}. `fields`: of every answer. */
export async function serveFolder(folder, fields = {}) {
    const server = createServer((request, response) => {
        answer(folder, request, response, fields).catch(() => response.writeHead(404, fields).end());
    });
    await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
    const close = () => {
        server.closeAllConnections();
        return new Promise((resolve) => server.close(resolve));
    };
    return { address: `http://127.0.0.1:${server.address().port}/`, close };
}

async function answer(folder, request, response, fields) {
    const path = join(folder, normalize(decodeURIComponent(new URL(request.url, 'http://x').pathname)));
    const { size, mtimeMs } = await stat(path);
    const all = { ...fields, 'content-type': types[extname(path)] ?? 'application/octet-stream', etag: `"${mtimeMs}"`, 'accept-ranges': 'bytes' };
    const [, first, last] = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range ?? '') ?? [];
    if (first === undefined) {
        response.writeHead(200, { ...all, 'content-length': size });
        createReadStream(path).pipe(response);
        return;
    }
    const start = Number(first), end = Math.min(size - 1, last === '' ? size - 1 : Number(last));
    response.writeHead(206, { ...all, 'content-length': end - start + 1, 'content-range': `bytes ${start}-${end}/${size}` });
    createReadStream(path, { start, end }).pipe(response);
}
