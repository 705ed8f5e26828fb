// The server under pressure; prints figures, and fails where bytes were lost or mixed, where a client was not
// answered that should have been, or where the server is busy without clients.
//   node pressure.mjs PROGRAM WORK_FOLDER [slow|end|change|descriptors|gone...]
// WORK_FOLDER holds large.stipple, a.stipple, b.stipple, cert.pem and key.pem (see scripts/pressure_server.sh).
import { execFileSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readFileSync, renameSync, statSync, truncateSync } from 'node:fs';
import { join } from 'node:path';
import {
    agent, ask, cpuSeconds, footprint, percentile, randomBelow, rangeHeader, sleep, startCrowd, startServer, until,
} from './support.mjs';

const [program, work, ...chosen] = process.argv.slice(2);
const large = join(work, 'large.stipple'), largeBytes = statSync(large).size, target = '/clouds/large.stipple';
const tlsOptions = ['--cert', join(work, 'cert.pem'), '--key', join(work, 'key.pem')];
const failures = [];
function check(holds, what) {
    if (!holds) failures.push(what);
}

async function end(server) {
    server.child.kill('SIGTERM');
    const [code] = await server.exit;
    check(code === 0, `the server ended with code ${code}: ${server.errors.slice(-500)}`);
}

/** 16 clients that ask for random 64 KiB every 20 ms, for `seconds`; milliseconds of each answer. */
async function normalClients(server, seconds) {
    const last = Date.now() + seconds * 1000;
    const times = [];
    await Promise.all(
        Array.from({ length: 16 }, async () => {
            const through = agent(1);
            while (Date.now() < last) {
                const begin = performance.now();
                const answer = await ask(server, target, { headers: rangeHeader(randomBelow(largeBytes - 65536), 65536), through });
                check(answer.status === 206 && answer.body.length === 65536, 'a normal client was not answered');
                times.push(performance.now() - begin);
                await sleep(20);
            }
            through.destroy();
        }),
    );
    return times;
}

async function slowAndHalfOpen() {
    const server = await startServer(program, [large]);
    const describe = (name, times) => {
        const late = percentile(times, 0.99), { mb, descriptors } = footprint(server.pid);
        console.log(`${name}: ${times.length} answers, median ${percentile(times, 0.5).toFixed(2)} ms, 99 % ${late.toFixed(2)} ms, ` +
            `${mb.toFixed(0)} MB, ${descriptors} descriptors`);
        return late;
    };
    await normalClients(server, 2);
    const before = describe('before', await normalClients(server, 10));
    const slow = await startCrowd(server, 'slow', 1000, target, largeBytes);
    const half = await startCrowd(server, 'half', 1000, target, largeBytes);
    await sleep(1000);
    const during = describe('with 1000 slow readers and 1000 half-open connections', await normalClients(server, 15));
    console.log(`slow readers: ${slow.last}; half-open, cut and come again: ${half.last}`);
    check(slow.last.startsWith('1000 open, 0 cut'), `slow readers that read fast enough were cut: ${slow.last}`);
    check(Number(/, (\d+) cut/.exec(half.last)?.[1]) >= 1000, `half-open connections were not cut at their time: ${half.last}`);
    check(during < Math.max(10 * before, 100), `the 99 % of normal clients went from ${before} to ${during} ms`);
    await slow.kill();
    await half.kill();
    await sleep(500);
    describe('after', await normalClients(server, 5));
    await end(server);
}

/** Downloads that run when the signal comes must reach their end, with the right bytes. */
async function endUnderLoad() {
    const file = readFileSync(join(work, 'a.stipple'));
    const server = await startServer(program, [join(work, 'a.stipple'), '--grace', '60']);
    const size = 8 << 20;
    let begun = 0, complete = 0, notBegun = 0, lost = 0, wrong = 0, atSignal = Infinity, endedAfter = 0;
    const clients = Array.from({ length: 32 }, async (_, i) => {
        const through = agent(1);
        while (atSignal === Infinity) {
            const first = randomBelow(file.length - size), parts = [];
            const answer = await ask(server, '/clouds/a.stipple', {
                headers: rangeHeader(first, size),
                through,
                onBody: (response) =>
                    response.on('data', (part) => {
                        parts.push(part);
                        if (i % 4 > 0) return;
                        response.pause(); // a quarter of them read slowly
                        setTimeout(() => response.resume(), 20);
                    }),
            });
            if (answer.status === undefined) {
                ++notBegun;
                break;
            }
            ++begun;
            const body = Buffer.concat(parts);
            lost += size - body.length;
            wrong += !body.equals(file.subarray(first, first + body.length));
            complete += answer.isComplete;
            endedAfter += atSignal !== Infinity;
        }
        through.destroy();
    });
    await sleep(3000);
    atSignal = begun;
    server.child.kill('SIGTERM');
    await Promise.all(clients);
    const [code] = await server.exit;
    console.log(`SIGTERM under load: ${begun} answers of 8 MiB begun (${endedAfter} ended after the signal), ${complete} complete, ` +
        `${lost} bytes lost, ${wrong} with wrong bytes, ${notBegun} connections closed before an answer began, exit code ${code}`);
    check(lost === 0 && wrong === 0 && complete === begun && code === 0, 'the end lost bytes');
    check(endedAfter > 0, 'no download ran when the signal came');
}

/** Two versions in turns by rename, then cuts in place: an answer is of one version, whole or a beginning. */
async function changingFiles() {
    const served = join(work, 'changing.stipple');
    const versions = ['a.stipple', 'b.stipple'].map((name) => readFileSync(join(work, name)));
    copyFileSync(join(work, 'a.stipple'), served);
    const server = await startServer(program, [served]);
    const counts = { whole: 0, cut: 0, refused: 0, mixed: 0, ofA: 0, ofB: 0 };
    let isOver = false;
    const clients = Array.from({ length: 16 }, async (_, i) => {
        const through = agent(1);
        while (!isOver) {
            const size = i % 2 ? 65536 : 4 << 20;
            const first = 4096 + randomBelow(versions[0].length - size - 4096); // their headers are alike
            const answer = await ask(server, '/clouds/changing.stipple', { headers: rangeHeader(first, size), through });
            if (answer.status !== 206) {
                ++counts.refused;
                continue;
            }
            const is = versions.map((bytes) => bytes.subarray(first, first + answer.body.length).equals(answer.body));
            if (answer.isComplete && answer.body.length === size && (is[0] || is[1])) ++counts.whole;
            else if (!answer.isComplete && (is[0] || is[1])) ++counts.cut;
            else ++counts.mixed;
            counts.ofA += is[0] && !is[1];
            counts.ofB += is[1] && !is[0];
        }
        through.destroy();
    });
    let renames = 0, cuts = 0;
    for (const last = Date.now() + 8000; Date.now() < last; ++renames) {
        copyFileSync(join(work, renames % 2 ? 'a.stipple' : 'b.stipple'), served + '.new');
        renameSync(served + '.new', served);
        await sleep(10);
    }
    check(counts.ofA > 0 && counts.ofB > 0, 'not both versions were seen');
    console.log(`replaced ${renames} times by rename: ${JSON.stringify(counts)}`);
    check(counts.mixed === 0 && counts.cut === 0, 'a replaced file was mixed or cut');
    for (const last = Date.now() + 8000; Date.now() < last; ++cuts) {
        truncateSync(served, randomBelow(versions[0].length));
        await sleep(15);
        copyFileSync(join(work, cuts % 2 ? 'a.stipple' : 'b.stipple'), served + '.new');
        renameSync(served + '.new', served);
        await sleep(15);
    }
    isOver = true;
    await Promise.all(clients);
    console.log(`and cut in place ${cuts} times: ${JSON.stringify(counts)}`);
    check(counts.mixed === 0, 'an answer had bytes of two versions');
    check(counts.cut + counts.refused > 0, 'no cut was seen');
    await end(server);
}

/** No descriptors left (EMFILE): for files, then for connections. Nobody gets a wrong answer, and nothing spins. */
async function noDescriptors() {
    const folder = join(work, 'many');
    mkdirSync(folder, { recursive: true });
    for (let i = 0; i < 200; ++i) copyFileSync(join(work, 'small.stipple'), join(folder, `c${i}.stipple`));
    const small = readFileSync(join(work, 'small.stipple'));
    const server = await startServer(['prlimit', '--nofile=256:256', program], [folder]);
    const through = Array.from({ length: 150 }, () => agent(1));
    const counts = { right: 0, refused: 0, wrong: 0 };
    for (let round = 0; round < 3; ++round)
        await Promise.all(
            through.map(async (own, i) => {
                const answer = await ask(server, `/clouds/c${(i + 67 * round) % 200}.stipple`, { through: own });
                if (answer.status === 200 && answer.isComplete && answer.body.equals(small)) ++counts.right;
                else if (answer.status === 503 && answer.headers['retry-after']) ++counts.refused;
                else ++counts.wrong;
            }),
        );
    console.log(`200 clouds, 150 connections, 256 descriptors: ${JSON.stringify(counts)}`);
    check(counts.wrong === 0 && counts.right > 0, 'for lack of descriptors, answers were wrong');

    const limit = (soft) => execFileSync('prlimit', ['--pid', server.pid, `--nofile=${soft}:256`]);
    limit(5); // those below are in use for good
    let answered = 0;
    const waiting = Array.from({ length: 20 }, () => ask(server, '/clouds/c0.stipple').finally(() => ++answered));
    const share = await idleCost(server, 3);
    const held = await ask(server, '/healthz', { through: through[0] });
    const early = answered;
    limit(256);
    const begin = performance.now();
    const answers = await Promise.all(waiting);
    const late = performance.now() - begin;
    console.log(`no descriptor for 20 new clients: ${(share * 100).toFixed(1)} % of a core while they wait; ` +
        `all answered ${late.toFixed(0)} ms after there were some`);
    check(early === 0, 'new clients were let in without descriptors: the limit does not hold');
    check(share <= 0.05, `without descriptors the server uses ${share * 100} % of a core`);
    check(held.status === 200, 'a client that is connected was not answered while there were no descriptors');
    check(answers.every((answer) => answer.status === 200 && answer.body.equals(small)), 'waiting clients were not answered');
    check(late < 2000, `waiting clients were answered only after ${late} ms`);
    for (const own of through) own.destroy();
    await end(server);
}

/** What a server does when nobody asks it for anything: nothing. */
async function idleCost(server, seconds) {
    const before = cpuSeconds(server.pid);
    await sleep(seconds * 1000);
    return (cpuSeconds(server.pid) - before) / seconds;
}

/** Clients that are killed (kill -9) in every state that a connection can be in, again and again. */
async function killedClients() {
    for (const options of [[], tlsOptions]) {
        const server = await startServer(program, [large, ...options]);
        await ask(server, target, { headers: rangeHeader(0, 10) });
        await sleep(300);
        const { descriptors } = footprint(server.pid);
        const kinds = ['busy', 'unread', 'closed', 'slow', 'half', ...(options.length > 0 ? ['handshake'] : [])];
        for (const kind of [...kinds, 'busy', 'unread', 'busy']) {
            const count = server.scheme === 'https' ? 300 : 1000;
            const begun = cpuSeconds(server.pid);
            const crowd = await startCrowd(server, kind, count, target, largeBytes);
            await sleep(kind === 'busy' ? 2000 : 500);
            const used = cpuSeconds(server.pid) - begun;
            const unread = kind === 'unread' ? await idleCost(server, 2) : 0;
            await crowd.kill();
            const isFree = await until(() => footprint(server.pid).descriptors <= descriptors, 5);
            await sleep(200);
            const share = await idleCost(server, 2);
            console.log(`${server.scheme}, ${count} ${kind}, killed: ${used.toFixed(2)} s of processor before, ${(share * 100).toFixed(1)} % after` +
                (kind === 'unread' ? `, ${(unread * 100).toFixed(1)} % while they read nothing` : '') + `, ${footprint(server.pid).descriptors} descriptors`);
            check(used > 0, 'the measure of processor time measures nothing');
            check(share <= 0.02, `without clients (${kind}, ${server.scheme}) the server uses ${share * 100} % of a core`);
            check(unread <= 0.05, `with clients that read nothing the server uses ${unread * 100} % of a core`);
            check(isFree, `connections of killed clients stay open (${kind}, ${server.scheme})`);
        }
        await end(server);
    }
}

const parts = { slow: slowAndHalfOpen, end: endUnderLoad, change: changingFiles, descriptors: noDescriptors, gone: killedClients };
for (const name of chosen)
    if (!(name in parts)) {
        console.error(`there is no part "${name}"; there are ${Object.keys(parts).join(', ')}`);
        process.exit(2);
    }
for (const [name, run] of Object.entries(parts)) if (chosen.length === 0 || chosen.includes(name)) await run();
for (const failure of new Set(failures)) console.error(`FAILED: ${failure}`);
process.exit(failures.length > 0 ? 1 : 0);
