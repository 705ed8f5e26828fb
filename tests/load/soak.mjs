// Mixed load for a while, then quiet, again and again: an hour's worth of what a server meets, squeezed. At each
// quiet moment descriptors, memory and processor time are looked at; they must not grow.
//   node soak.mjs PROGRAM WORK_FOLDER SECONDS [sanitized]
// Three servers: plain, https, and a front of the plain one. WORK_FOLDER as for pressure.mjs, and scan.stipple,
// a cloud with points. `sanitized`: memory is only shown, since sanitizers keep what was freed for a while; their
// reports, and leaks at the end, fail the run.
import { copyFileSync, mkdirSync, readFileSync, renameSync } from 'node:fs';
import { join } from 'node:path';
import { agent, ask, cpuSeconds, footprint, percentile, randomBelow, rangeHeader, sleep, startCrowd, startServer, until } from './support.mjs';

const [program, work, secondsText, sanitized] = process.argv.slice(2);
const seconds = Number(secondsText), rounds = 20, roundSeconds = seconds / rounds;
// Criteria, of the quiet moments after the first quarter (when caches and pools are full):
const mostDescriptorGrowth = 0; // beyond the most of the second quarter
const mostGrowthMb = 8, mostGrowth = 0.05; // memory: the last quarter's median over the second quarter's
const mostIdleShare = 0.03; // of a core, without clients

const clouds = join(work, 'soak');
mkdirSync(clouds, { recursive: true });
copyFileSync(join(work, 'scan.stipple'), join(clouds, 'scan.stipple'));
const versions = ['a.stipple', 'b.stipple'].map((name) => readFileSync(join(work, name)));
copyFileSync(join(work, 'a.stipple'), join(clouds, 'changing.stipple'));

const environment = {
    ASAN_OPTIONS: 'quarantine_size_mb=16:exitcode=77',
    TSAN_OPTIONS: 'exitcode=77:halt_on_error=0',
};
const common = [clouds, '--metrics', 'local', '--jobs-per-client', '64'];
const plain = await startServer(program, common, environment);
const secure = await startServer(program, [...common, '--cert', join(work, 'cert.pem'), '--key', join(work, 'key.pem')], environment);
const front = await startServer(program, [
    `http://127.0.0.1:${plain.port}/clouds/scan.stipple`, `http://127.0.0.1:${plain.port}/clouds/changing.stipple`,
    '--upstream-fresh', '0.2', '--upstream-cache', '24M', '--metrics', 'local',
], environment);
const servers = { plain, secure, front };

const failures = new Set();
const counts = {};
function count(what) {
    counts[what] = (counts[what] ?? 0) + 1;
}
let isQuiet = false;

/** Answers must be whole and have an expected status; whoever asks says what else holds. */
async function get(server, path, name, { statuses = [200], headers = {}, through } = {}) {
    const answer = await ask(server, path, { headers, through });
    if (!statuses.includes(answer.status) || !answer.isComplete)
        failures.add(`${name}: status ${answer.status}, ${answer.isComplete ? 'whole' : 'cut'} ${answer.error ?? ''} ${answer.status >= 400 ? answer.body : ''}`.slice(0, 300));
    count(`${name} ${answer.status}`);
    return answer;
}

const metadata = JSON.parse((await ask(plain, '/api/v1/clouds/scan')).body);
const [min, max] = [metadata.bounds.min, metadata.bounds.max];
const between = (axis) => min[axis] + Math.random() * (max[axis] - min[axis]);
function box() {
    const x = between(0), y = between(1), side = (max[0] - min[0]) / 20;
    return [x, y, x + side, y + side].map((value) => value.toFixed(3)).join(',');
}
const anyServer = () => Object.values(servers)[randomBelow(3)];

const kinds = {
    async changing(through, server) {
        const size = randomBelow(2) ? 65536 : 2 << 20, first = 4096 + randomBelow(versions[0].length - size - 4096);
        // The front may have to give up an answer that it has begun when its upstream changes.
        const answer = await ask(server, '/clouds/changing.stipple', { headers: rangeHeader(first, size), through });
        count(`range ${answer.status}${answer.isComplete ? '' : ' cut'}`);
        if (answer.status === 503 || answer.status === undefined) return;
        if (answer.status !== 206 || (!answer.isComplete && server !== front)) failures.add(`range: status ${answer.status}`);
        else if (!versions.some((bytes) => bytes.subarray(first, first + answer.body.length).equals(answer.body))) failures.add('an answer had bytes of two versions');
        else if (answer.isComplete && answer.body.length !== size) failures.add('a range was short');
    },
    async several(through, server) {
        await get(server, '/clouds/scan.stipple', 'ranges', { statuses: [206], headers: { Range: 'bytes=0-99,2000-2999,-10' }, through });
    },
    async page(through, server) {
        await get(server, '/', 'page', { through, headers: { 'Accept-Encoding': 'br' } });
    },
    async list(through, server) {
        await get(server, '/api/v1/clouds', 'list', { through });
        await get(server, '/api/v1/clouds/scan', 'cloud', { through });
    },
    async points(through, server) {
        const format = ['csv', 'las', 'laz', 'ply'][randomBelow(4)];
        await get(server, `/api/v1/clouds/scan/points?format=${format}&box=${box()}`, `points ${format}`, { through, statuses: [200, 503] });
    },
    async profile(through, server) {
        const line = [between(0), between(1), between(0), between(1)].map((value) => value.toFixed(3));
        await get(server, `/api/v1/clouds/scan/profile?format=csv&line=${line[0]},${line[1]};${line[2]},${line[3]}&width=1`, 'profile', { through, statuses: [200, 503] });
    },
    async nodes(through, server) {
        const answer = await get(server, '/api/v1/clouds/scan/hierarchy/0-0-0-0', 'hierarchy', { through });
        if (answer.status !== 200) return;
        const { nodes } = JSON.parse(answer.body), { key } = nodes[randomBelow(nodes.length)];
        await get(server, `/api/v1/clouds/scan/nodes/${key}`, 'node', { through });
        await get(server, `/api/v1/clouds/scan/nodes/${key}?format=csv`, 'node csv', { through });
    },
    async image(through, server) {
        await get(server, `/api/v1/clouds/scan/image?width=160&height=120&budget=50000&view=${['iso', 'top', 'front'][randomBelow(3)]}`, 'image', { through, statuses: [200, 429, 503] });
        await sleep(500);
    },
    async leaves(_, server) {
        // Asks for much and is gone in the middle of it.
        const path = randomBelow(2) ? '/clouds/changing.stipple' : '/api/v1/clouds/scan/points?format=csv';
        await ask(server, path, { onBody: (response) => setTimeout(() => response.destroy(), randomBelow(100)) });
        count('client left');
    },
};

async function client(kind) {
    const own = Object.fromEntries(Object.entries(servers).map(([name, { scheme }]) => [name, agent(1, scheme)]));
    for (;;) {
        if (isQuiet) {
            for (const through of Object.values(own)) through.destroy();
            return;
        }
        const server = anyServer(), name = Object.keys(servers).find((key) => servers[key] === server);
        await kinds[kind](own[name], server);
        await sleep(randomBelow(20));
    }
}

let turns = 0;
async function disturb() {
    for (; !isQuiet; await sleep(400)) {
        copyFileSync(join(work, turns++ % 2 ? 'a.stipple' : 'b.stipple'), join(clouds, '.new'));
        renameSync(join(clouds, '.new'), join(clouds, 'changing.stipple'));
        if (turns % 5 === 0) for (const { child } of Object.values(servers)) child.kill('SIGHUP');
        count('file replaced');
    }
}

async function crowds() {
    for (const kind of ['busy', 'slow', 'half', 'unread']) {
        if (isQuiet) return;
        const crowd = await startCrowd(randomBelow(2) ? plain : secure, kind, 60, '/clouds/changing.stipple', 66 << 20);
        await sleep(Math.min(2000, roundSeconds * 100));
        await crowd.kill();
        count(`crowd ${kind} killed`);
    }
}

const clientKinds = ['changing', 'changing', 'changing', 'several', 'page', 'list', 'points', 'points', 'profile', 'nodes', 'image', 'leaves', 'leaves'];
const mostIdle = sanitized ? 0.2 : mostIdleShare;
const samples = Object.fromEntries(Object.keys(servers).map((name) => [name, []]));
for (let round = 0; round < rounds; ++round) {
    isQuiet = false;
    const loads = [...clientKinds.map(client), disturb()];
    const late = sleep(roundSeconds * 850);
    await Promise.all([late, crowds()]);
    isQuiet = true;
    await Promise.all(loads);
    await sleep(Math.max(500, roundSeconds * 50)); // jobs of clients that left end
    // A sanitized server is ten times as slow to end what it had begun, so it may have a few looks; one that is busy for ever is
    // so at the last, too.
    const idleSeconds = Math.max(1, roundSeconds * 0.1);
    let idle;
    for (let look = 0; look < (sanitized ? 8 : 1) && (look === 0 || Math.max(...Object.values(idle)) > mostIdle); ++look) {
        const cpu = Object.fromEntries(Object.entries(servers).map(([name, { pid }]) => [name, cpuSeconds(pid)]));
        await sleep(idleSeconds * 1000);
        idle = Object.fromEntries(Object.entries(servers).map(([name, { pid }]) => [name, (cpuSeconds(pid) - cpu[name]) / idleSeconds]));
    }
    for (const [name, server] of Object.entries(servers)) {
        const sample = { ...footprint(server.pid), idle: idle[name] };
        samples[name].push(sample);
        console.log(`${round + 1}/${rounds} ${name}: ${sample.mb.toFixed(1)} MB, ${sample.descriptors} descriptors, ${(sample.idle * 100).toFixed(1)} % of a core without clients`);
    }
}

console.log(JSON.stringify(counts, null, 1));
for (const [name, list] of Object.entries(samples)) {
    const quarter = (from, to, what) => list.slice(rounds * from, rounds * to).map((sample) => sample[what]);
    const early = quarter(0.25, 0.5, 'mb'), late = quarter(0.75, 1, 'mb');
    const [before, after] = [percentile(early, 0.5), percentile(late, 0.5)];
    const most = Math.max(...quarter(0.25, 0.5, 'descriptors')), descriptors = Math.min(...quarter(0.75, 1, 'descriptors'));
    console.log(`${name}: memory ${before.toFixed(1)} MB early, ${after.toFixed(1)} MB late; descriptors ${most} early, ${descriptors} late`);
    if (!sanitized && after > before * (1 + mostGrowth) + mostGrowthMb) failures.add(`${name}: memory grew from ${before} to ${after} MB`);
    if (descriptors > most + mostDescriptorGrowth) failures.add(`${name}: descriptors grew from ${most} to ${descriptors}`);
    const busiest = Math.max(...list.map((sample) => sample.idle));
    if (busiest > mostIdle) failures.add(`${name}: ${(busiest * 100).toFixed(1)} % of a core without clients`);
}
for (const kind of ['range 206', 'ranges 206', 'page 200', 'points las 200', 'points laz 200', 'profile 200', 'node 200', 'image 200', 'client left', 'file replaced'])
    if (!(kind in counts)) failures.add(`there was no "${kind}": the load is not what it should be`);
for (const [name, server] of Object.entries(servers)) {
    server.child.kill('SIGTERM');
    const ended = await until(() => server.child.exitCode !== null || server.child.signalCode !== null, 60);
    if (!ended) server.child.kill('SIGKILL');
    if (server.child.exitCode !== 0) failures.add(`${name} ended with ${server.child.exitCode ?? server.child.signalCode}`);
    if (/Sanitizer|runtime error:/.test(server.errors)) failures.add(`${name}: ${server.errors.slice(0, 6000)}`);
}
for (const failure of failures) console.error(`FAILED: ${failure}`);
process.exit(failures.size > 0 ? 1 : 0);
