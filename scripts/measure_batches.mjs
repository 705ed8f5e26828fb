#!/usr/bin/env node
// Measures what batches of nodes are worth to a client that is far away: the same nodes, fetched by single requests and in
// batches, over a proxy that delays every byte by half the round trip and a new connection by a whole one. All ways fetch
// the strata of the same nodes over as many kept-alive connections as a browser opens; bytes are compared. Ways take turns;
// the table has medians over the rounds.
//   node scripts/measure_batches.mjs CLOUD.stipple [--nodes 300] [--latency 50] [--connections 6] [--rounds 5]
import { spawn } from 'node:child_process';
import http from 'node:http';
import net from 'node:net';
import { basename, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

const { values, positionals } = parseArgs({
    allowPositionals: true,
    options: {
        nodes: { type: 'string', default: '300' },
        latency: { type: 'string', default: '50' },
        connections: { type: 'string', default: '6' },
        rounds: { type: 'string', default: '5' },
    },
});
const options = Object.fromEntries(Object.entries(values).map(([name, text]) => [name, Number(text)]));
if (positionals.length !== 1 || Object.values(options).some((value) => !(value >= 1))) {
    console.error('usage: node scripts/measure_batches.mjs CLOUD.stipple [--nodes N] [--latency MS] [--connections N] [--rounds N]');
    process.exit(2);
}
const cloud = positionals[0];
const id = basename(cloud, '.stipple');
const program =
    process.env.STIPPLE_PROGRAM ?? join(fileURLToPath(new URL('..', import.meta.url)), 'build/release/client/headless/stipple');

function serve() {
    const server = spawn(program, ['serve', cloud, '--port', '0'], { stdio: ['ignore', 'pipe', 'inherit'] });
    return new Promise((resolve, reject) => {
        server.once('error', reject);
        server.once('exit', (code) => reject(new Error(`the server ended with ${code}`)));
        let said = '';
        server.stdout.on('data', (bytes) => {
            const found = (said += bytes).match(/http:\/\/[\d.]+:(\d+)/);
            if (found) resolve({ server, port: Number(found[1]) });
        });
    });
}

/** Passes bytes on after a while, in their order. */
function delayed(from, to, milliseconds) {
    from.on('data', (bytes) => setTimeout(() => to.writable && to.write(bytes), milliseconds));
    from.on('end', () => setTimeout(() => to.end(), milliseconds));
    from.on('error', () => to.destroy());
}

function proxyTo(port) {
    const half = options.latency / 2;
    const proxy = net.createServer({ noDelay: true, pauseOnConnect: true }, (client) => {
        const upstream = net.connect({ port, noDelay: true });
        // The handshake takes a round trip before the first byte leaves.
        setTimeout(() => {
            delayed(client, upstream, half);
            client.resume();
        }, options.latency);
        delayed(upstream, client, half);
    });
    return new Promise((resolve) => proxy.listen(0, '127.0.0.1', () => resolve(proxy)));
}

function get(agent, port, path, headers = {}) {
    return new Promise((resolve, reject) => {
        const request = http.get({ port, path, headers, agent }, (answer) => {
            const parts = [];
            answer.on('data', (bytes) => parts.push(bytes));
            answer.on('end', () => resolve({ status: answer.statusCode, type: answer.headers['content-type'], body: Buffer.concat(parts) }));
            answer.on('error', reject);
        });
        request.on('error', reject);
    });
}

async function firstNodes(port) {
    const nodes = [];
    const chunks = ['0-0-0-0'];
    while (chunks.length > 0 && nodes.length < options.nodes) {
        const { body } = await get(undefined, port, `/api/v1/clouds/${id}/hierarchy/${chunks.shift()}`);
        for (const node of JSON.parse(body).nodes) {
            if (nodes.some((other) => other.key === node.key)) continue;
            nodes.push(node);
            if (node.childChunk) chunks.push(node.key);
        }
    }
    return nodes
        .filter((node) => node.pointCount > 0)
        .slice(0, options.nodes)
        .map((node) => ({ ...node, bytes: node.strataBytes.reduce((sum, size) => sum + size, 0) }));
}

function groupsOf(nodes, size) {
    const groups = [];
    for (let i = 0; i < nodes.length; i += size) groups.push(nodes.slice(i, i + size));
    return groups;
}

/** Payload of a row of frames (server/api/batch_endpoint.hpp). */
function framedBytes(body) {
    let sum = 0;
    for (let at = 0; at < body.length; ) {
        if (body.readUInt32LE(at) !== 200) throw new Error('a node of the batch is not there');
        const size = Number(body.readBigUInt64LE(at + 24));
        sum += size;
        at += 32 + size;
    }
    return sum;
}

/** Bytes of the nodes that the parts of a multipart answer hold; parts may hold several that are near each other. */
function partsBytes({ type, body }, group) {
    const boundary = type.match(/^multipart\/byteranges; boundary=(.+)$/)[1];
    const parts = [];
    for (let at = body.indexOf(`--${boundary}\r\n`); at >= 0; ) {
        const headEnd = body.indexOf('\r\n\r\n', at) + 4;
        const [, first, last] = body.subarray(at, headEnd).toString().match(/Content-Range: bytes (\d+)-(\d+)/).map(Number);
        parts.push([first, last]);
        at = body.indexOf(`--${boundary}\r\n`, headEnd + last - first + 1);
    }
    return group
        .filter((node) => parts.some(([first, last]) => first <= node.offset && node.offset + node.bytes - 1 <= last))
        .reduce((sum, node) => sum + node.bytes, 0);
}

const expected = (answer, status) => {
    if (answer.status !== status) throw new Error(`status ${answer.status}: ${answer.body.subarray(0, 300)}`);
    return answer;
};
const rangeOf = (node) => `${node.offset}-${node.offset + node.bytes - 1}`;

// name, nodes a request, and a request that gives the number of bytes of nodes that came.
const ways = [
    ['single ranges', 1, async (ask, [node]) =>
        expected(await ask(`/clouds/${id}.stipple`, { range: `bytes=${rangeOf(node)}` }), 206).body.length],
    ['single nodes', 1, async (ask, [node]) =>
        expected(await ask(`/api/v1/clouds/${id}/nodes/${node.key}?attributes=none`), 200).body.length],
    ['32 ranges each', 32, async (ask, group) =>
        partsBytes(expected(await ask(`/clouds/${id}.stipple`, { range: `bytes=${group.map(rangeOf).join(', ')}` }), 206), group)],
    ...[8, 32, 128].map((size) => [`batches of ${size}`, size, async (ask, group) =>
        framedBytes(expected(await ask(`/api/v1/clouds/${id}/nodes?attributes=none&keys=${group.map((node) => node.key).join(',')}`), 200).body)]),
];

async function fetchAll(port, nodes, size, request) {
    const agent = new http.Agent({ keepAlive: true, maxSockets: options.connections });
    const ask = (path, headers) => get(agent, port, path, headers);
    const begin = performance.now();
    const sizes = await Promise.all(groupsOf(nodes, size).map((group) => request(ask, group)));
    const milliseconds = performance.now() - begin;
    agent.destroy();
    return { milliseconds, bytes: sizes.reduce((sum, bytes) => sum + bytes, 0) };
}

const median = (list) => list.toSorted((a, b) => a - b)[Math.floor(list.length / 2)];

const { server, port } = await serve();
const proxy = await proxyTo(port);
try {
    const nodes = await firstNodes(port);
    const bytes = nodes.reduce((sum, node) => sum + node.bytes, 0);
    const times = new Map(ways.map(([name]) => [name, []]));
    for (let round = 0; round < options.rounds; ++round)
        for (const [name, size, request] of ways) {
            const fetched = await fetchAll(proxy.address().port, nodes, size, request);
            if (fetched.bytes !== bytes) throw new Error(`${name}: ${fetched.bytes} bytes came instead of ${bytes}`);
            times.get(name).push(fetched.milliseconds);
        }
    console.log(`${nodes.length} nodes, ${bytes} bytes, ${options.latency} ms round trip, ${options.connections} connections, ${options.rounds} rounds`);
    const single = times.get('single ranges');
    for (const [name, size] of ways) {
        const ratios = times.get(name).map((time, round) => single[round] / time);
        console.log(
            `${name.padEnd(16)} ${String(Math.ceil(nodes.length / size)).padStart(4)} requests ${median(times.get(name)).toFixed(0).padStart(6)} ms` +
                `   single ranges take ${median(ratios).toFixed(2)} times as long (${Math.min(...ratios).toFixed(2)} to ${Math.max(...ratios).toFixed(2)})`,
        );
    }
} finally {
    proxy.close();
    server.removeAllListeners('exit');
    server.kill('SIGTERM');
}
process.exit(0);
