// What the load scripts share: the server as a program, clients, and numbers.
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { readFileSync, readdirSync } from 'node:fs';
import http from 'node:http';
import https from 'node:https';
import { fileURLToPath } from 'node:url';

export const sleep = (ms) => new Promise((done) => setTimeout(done, ms));

/**
 * `stipple serve` on a free port; everything it writes to standard error is kept in `errors`. `program`: its path, or a
 * command that becomes it.
 */
export async function startServer(program, args, environment = {}) {
    const [command, ...before] = [program].flat();
    const child = spawn(command, [...before, 'serve', '--port', '0', '--json', ...args], {
        stdio: ['ignore', 'pipe', 'pipe'],
        env: { ...process.env, ...environment },
    });
    process.on('exit', () => child.kill('SIGKILL'));
    const server = { child, errors: '', pid: child.pid, scheme: args.includes('--cert') ? 'https' : 'http' };
    child.stderr.on('data', (text) => (server.errors += text));
    let line = '';
    for await (const text of child.stdout) {
        line += text;
        if (line.includes('\n')) break;
    }
    if (!line) throw new Error(`the server did not start: ${server.errors}`);
    server.port = JSON.parse(line).port;
    server.exit = once(child, 'exit');
    return server;
}

/** A crowd of connections (crowd.mjs), once all of them are there. `last` is its last line; `kill()` ends it as kill -9 does. */
export async function startCrowd(server, kind, count, target, bytes) {
    const file = fileURLToPath(new URL('crowd.mjs', import.meta.url));
    const child = spawn(process.execPath, [file, server.port, server.scheme, kind, count, target, bytes], { stdio: ['ignore', 'pipe', 'inherit'] });
    process.on('exit', () => child.kill('SIGKILL'));
    const crowd = { child, last: '' };
    crowd.kill = async () => {
        const exit = once(child, 'exit');
        child.kill('SIGKILL');
        await exit;
    };
    await new Promise((done, fail) => {
        const late = setTimeout(() => fail(new Error(`not all ${count} connections (${kind}) were let in: ${crowd.last}`)), 60000);
        child.stdout.on('data', (text) => {
            crowd.last = text.toString().trim().split('\n').at(-1);
            if (!text.toString().includes('ready')) return;
            clearTimeout(late);
            done();
        });
    });
    return crowd;
}

/** Seconds of processor time that a process has used. */
export function cpuSeconds(pid) {
    const fields = readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ')[1].split(' ');
    return (Number(fields[11]) + Number(fields[12])) / 100; // sysconf(_SC_CLK_TCK)
}

/** Waits until `holds()`, for `seconds` at most; whether it came to hold. */
export async function until(holds, seconds) {
    for (const end = Date.now() + seconds * 1000; !holds(); await sleep(50)) if (Date.now() > end) return false;
    return true;
}

/** Megabytes resident, and descriptors open. */
export function footprint(pid) {
    const resident = /VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, 'utf8'));
    return { mb: resident[1] / 1024, descriptors: readdirSync(`/proc/${pid}/fd`).length };
}

export function percentile(values, share) {
    const sorted = Float64Array.from(values).sort();
    return sorted[Math.min(sorted.length - 1, Math.floor(sorted.length * share))];
}

export const agent = (sockets, scheme = 'http') =>
    new (scheme === 'https' ? https : http).Agent({ keepAlive: true, maxSockets: sockets });

/**
 * One request to a server. Answers {status, headers, body, isComplete}; without `status` if the connection ended
 * before an answer began. `onBody` gets the response instead of its body being read.
 */
export function ask(server, path, { headers = {}, method = 'GET', through, localAddress, onBody } = {}) {
    return new Promise((done) => {
        const options = { host: '127.0.0.1', port: server.port, path, method, headers, agent: through, localAddress, rejectUnauthorized: false };
        const request = (server.scheme === 'https' ? https : http).request(options);
        request.on('error', (error) => done({ error: error.code }));
        request.on('response', (response) => {
            const parts = [];
            const answer = (isComplete) =>
                done({ status: response.statusCode, headers: response.headers, body: Buffer.concat(parts), isComplete });
            response.on('error', () => answer(false));
            response.on('close', () => answer(response.complete));
            if (onBody) onBody(response, request);
            else response.on('data', (part) => parts.push(part));
        });
        request.end();
    });
}

export const rangeHeader = (first, size) => ({ Range: `bytes=${first}-${first + size - 1}` });
export const randomBelow = (limit) => Math.floor(Math.random() * limit);
