// A host of one file that answers ranges as hosts do, and goes wrong as a test says.
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { setTimeout as pause } from 'node:timers/promises';

const pieceBytes = 16_384;

/**
 * Serves the file at `path` under /cloud.stipple to every origin. `fault`, asked for each GET with its number (from 1), range
 * [first, last] and request, may answer with
 *
 *   status, headers   instead of the part (undefined fields are left out)
 *   whole             200 and so many bytes
 *   cutAt, flipAt     the body ends before this byte of the file; this byte of the file is another one
 *   hides             names of headers that are not shown to other origins
 *   isPrivate         no header that lets another origin read
 *
 * `isGone`: connections break without an answer. `rate`: bytes a second of each answer; 0: as fast as it goes. `asked` has every GET, `bytesSent` all of bodies,
 * `cutOff` counts answers that the client did not wait for.
 */
export async function faultyServer(path) {
    const host = { file: await readFile(path), etag: '"1"', fault: undefined, rate: 0 };
    host.restart = () => Object.assign(host, { asked: [], bytesSent: 0, cutOff: 0, fault: undefined, isGone: false, rate: 0, etag: '"1"' });
    host.restart();
    const server = createServer((request, response) => void answer(host, request, response));
    await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
    host.address = `http://127.0.0.1:${server.address().port}/cloud.stipple`;
    host.close = async () => {
        server.closeAllConnections();
        await new Promise((resolve) => server.close(resolve));
    };
    return host;
}

async function answer(host, request, response) {
    if (host.isGone) return void request.socket.destroy();
    const origin = request.headers.origin ?? '*';
    if (request.method !== 'GET') {
        response.writeHead(204, request.method === 'OPTIONS' ? allowed(origin) : {}).end();
        return;
    }
    const range = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? '')?.slice(1).map(Number);
    const record = { at: performance.now(), url: request.url, range, headers: request.headers };
    host.asked.push(record);
    const fault = host.fault?.({ ...record, number: host.asked.length }) ?? {};

    const size = host.file.length;
    const [first, last] = [range[0], Math.min(range[1], size - 1)];
    const headers = {
        ...(fault.isPrivate ? {} : allowed(origin)),
        'access-control-expose-headers': ['Content-Range', 'ETag', 'Retry-After', 'Last-Modified']
            .filter((name) => !(fault.hides ?? []).includes(name))
            .join(', '),
        etag: host.etag,
        ...fault.headers,
    };
    for (const name of Object.keys(headers)) if (headers[name] === undefined) delete headers[name];
    if (fault.status) return void response.writeHead(fault.status, headers).end();
    const length = fault.whole ?? last + 1 - first;
    if (!fault.whole) headers['content-range'] = `bytes ${first}-${last}/${size}`;
    response.writeHead(fault.whole ? 200 : 206, { ...headers, 'content-length': length });
    const body = fault.whole ? Buffer.alloc(Math.min(length, 1 << 20)) : Buffer.from(host.file.subarray(first, last + 1));
    if (fault.flipAt >= first && fault.flipAt <= last) body[fault.flipAt - first] ^= 0xff;
    const isCut = fault.cutAt >= first && fault.cutAt <= last;
    await send(host, response, body, isCut ? fault.cutAt - first : length);
    if (isCut) {
        await pause(50); // what was written is on its way
        request.socket.destroy();
    }
}

/** `length` bytes of `body`, over and over. */
async function send(host, response, body, length) {
    const most = host.rate > 0 ? Math.min(pieceBytes, Math.ceil(host.rate / 50)) : pieceBytes; // steady, also over a tenth of a second
    for (let at = 0; at < length; ) {
        const from = at % body.length;
        const piece = body.subarray(from, Math.min(from + most, body.length, from + length - at));
        if (host.rate > 0) await pause((1000 * piece.length) / host.rate);
        if (response.destroyed) {
            host.cutOff++;
            return;
        }
        const goesOn = response.write(piece);
        at += piece.length;
        host.bytesSent += piece.length;
        if (!goesOn) await drainedOrClosed(response);
    }
    if (!response.destroyed && length >= body.length) response.end(); // a cut one stays open
}

function drainedOrClosed(response) {
    return new Promise((resolve) => {
        const done = () => {
            response.off('drain', done).off('close', done);
            resolve();
        };
        response.on('drain', done).on('close', done);
    });
}

function allowed(origin) {
    return {
        'access-control-allow-origin': origin,
        'access-control-allow-credentials': 'true',
        'access-control-allow-headers': 'Authorization, Range, X-Visitor',
    };
}

/** Bytes that were asked for more than once. */
export function bytesAskedTwice(asked) {
    const ranges = asked.map(({ range }) => range).sort((a, b) => a[0] - b[0]);
    let end = 0;
    let twice = 0;
    for (const [first, last] of ranges) {
        twice += Math.max(0, Math.min(end, last + 1) - first);
        end = Math.max(end, last + 1);
    }
    return twice;
}
