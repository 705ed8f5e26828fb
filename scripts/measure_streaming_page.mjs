// What the page takes to show a cloud, in headless Chromium (software GL) against `stipple serve`. No test: times depend
// on the machine, so say what else it did. Prints JSON. Needs build/release, www/dist and the packages of tests/e2e.
//
//   node scripts/measure_streaming_page.mjs open FILE.stipple [--runs 3]
//       1280 × 720, a budget of a million: first points and settled since the navigation began, requests and bytes
//       (of the cloud; of everything), then frames a second while the camera orbits
//   node scripts/measure_streaming_page.mjs tasks FILE.stipple
//       the same with a trace: the main thread's longest task while it streams, and which frames over 50 ms are its
//       doing: those whose tasks take 50 ms beside the calls of WebGL, in which it waits for the (software) GPU
//   node scripts/measure_streaming_page.mjs fly [--minutes 20] [--clouds 50] [--cache 16]
//       random flight over small towns, with budgets that go up and down, and so many MiB for decoded nodes, for
//       compressed ones and for the GPU: memory by the minute
//   node scripts/measure_streaming_page.mjs reopen FILE.stipple [--times 200]
//       opens and closes the cloud, waiting for its picture: memory every tenth time
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { parseArgs } from 'node:util';

import { counters, launch, openPage, settleWithPoints } from '../tests/e2e/support/browser.mjs';
import { makeTown, serve } from '../tests/e2e/support/program.mjs';

const { values: options, positionals } = parseArgs({
    allowPositionals: true,
    options: {
        runs: { type: 'string', default: '3' },
        minutes: { type: 'string', default: '20' },
        clouds: { type: 'string', default: '50' },
        times: { type: 'string', default: '200' },
        cache: { type: 'string', default: '16' },
    },
});
const [kind, file] = positionals;
const size = { width: 1280, height: 720 };
const autzen = { position: [636400, 850000, 1400], target: [637300, 851200, 430] };
const mebibytes = (bytes) => Number((bytes / (1 << 20)).toFixed(2));
const seconds = (milliseconds) => Number((milliseconds / 1000).toFixed(2));

/** The page with one cloud and, where the cloud is autzen's, its camera. */
async function openFile(browser, address, prepare = async () => {}) {
    const { page, complaints } = await openPage(browser, size);
    page.setDefaultTimeout(180_000);
    await page.addInitScript((camera) => {
        window.marks = {};
        const look = () => {
            requestAnimationFrame(look);
            const page = window.stipple;
            if (!page) return;
            if (!window.marks.ready) {
                window.marks.ready = performance.now();
                page.setLimits({ pointBudget: 1_000_000 });
                if (camera) page.setCamera(camera);
            }
            const { frame, settled } = page.counters();
            if (frame.pointsDrawn > 0) window.marks.first ??= performance.now();
            if (frame.pointsDrawn > 0 && settled) window.marks.settled ??= performance.now();
        };
        look();
    }, /autzen/.test(file) ? autzen : null);
    const traffic = await countTraffic(page);
    await prepare(page);
    await page.goto(address);
    await page.waitForFunction(() => window.marks.settled);
    return { page, complaints, traffic };
}

async function countTraffic(page) {
    const traffic = { requests: 0, bytes: 0 };
    const session = await page.context().newCDPSession(page);
    await session.send('Network.enable');
    session.on('Network.requestWillBeSent', () => traffic.requests++);
    session.on('Network.loadingFinished', ({ encodedDataLength }) => (traffic.bytes += encodedDataLength));
    return traffic;
}

async function framesPerSecond(page) {
    return page.evaluate(async () => {
        const page = window.stipple;
        const { position, target } = page.camera();
        const start = performance.now();
        const before = page.counters().session.framesDrawn;
        for (let angle = 0; performance.now() - start < 6000; angle += 0.01) {
            const [x, y] = [position[0] - target[0], position[1] - target[1]];
            const [c, s] = [Math.cos(angle), Math.sin(angle)];
            page.setCamera({ position: [target[0] + x * c - y * s, target[1] + x * s + y * c, position[2]] });
            await new Promise((resolve) => requestAnimationFrame(resolve));
        }
        return (page.counters().session.framesDrawn - before) / ((performance.now() - start) / 1000);
    });
}

async function measureOpen(browser) {
    const server = await serve(resolve(file));
    const runs = [];
    for (let run = 0; run < Number(options.runs); run++) {
        const { page, complaints, traffic } = await openFile(browser, server.address);
        const { frame, session } = await counters(page);
        const marks = await page.evaluate(() => window.marks);
        runs.push({
            ready: seconds(marks.ready), firstPoints: seconds(marks.first), settled: seconds(marks.settled),
            cloudRequests: session.requests, cloudMebibytes: mebibytes(session.bytesReceived),
            allRequests: traffic.requests, allMebibytes: mebibytes(traffic.bytes),
            pointsDrawn: frame.pointsDrawn, framesPerSecond: Number((await framesPerSecond(page)).toFixed(2)), complaints,
        });
        await page.close();
    }
    await server.stop();
    return { runs };
}

/** Counts the time in calls of WebGL, which in software wait for the drawing, by the clock of performance.now(). */
function watchGl() {
    window.glCalls = [];
    const prototype = WebGL2RenderingContext.prototype;
    for (const name of Object.getOwnPropertyNames(prototype)) {
        const { value: call } = Object.getOwnPropertyDescriptor(prototype, name);
        if (typeof call !== 'function') continue;
        prototype[name] = function (...given) {
            const start = performance.now();
            try {
                return call.apply(this, given);
            } finally {
                const took = performance.now() - start;
                if (took > 0.2) window.glCalls.push([start, took]);
            }
        };
    }
    window.frameStarts = [];
    const next = () => requestAnimationFrame(() => (window.frameStarts.push(performance.now()), next()));
    next();
}

async function measureTasks(browser) {
    const server = await serve(resolve(file));
    const tracer = await browser.newBrowserCDPSession();
    const events = [];
    tracer.on('Tracing.dataCollected', ({ value }) => events.push(...value));
    const { page } = await openFile(browser, server.address, async (page) => {
        await page.addInitScript(watchGl);
        await tracer.send('Tracing.start', {
            traceConfig: { includedCategories: ['toplevel', 'devtools.timeline', 'blink.user_timing', '__metadata'] },
        });
    });
    const watched = await page.evaluate(() => {
        performance.mark('stipple-zero');
        const zero = performance.getEntriesByName('stipple-zero')[0].startTime;
        return { zero, glCalls: window.glCalls, frameStarts: window.frameStarts, marks: window.marks };
    });
    const ended = new Promise((done) => tracer.once('Tracing.tracingComplete', done));
    await tracer.send('Tracing.end');
    await ended;
    await server.stop();

    const mark = events.find(({ name }) => name === 'stipple-zero');
    const toPage = (microseconds) => (microseconds - mark.ts) / 1000 + watched.zero;
    const ofMain = events.filter(({ ph, pid, tid }) => ph === 'X' && pid === mark.pid && tid === mark.tid);
    const taskName = ['RunTask', 'ThreadControllerImpl::RunTask'].find((wanted) => ofMain.some(({ name }) => name === wanted));
    const tasks = ofMain
        .filter(({ name }) => name === taskName)
        .map(({ ts, dur }) => ({ start: toPage(ts), took: dur / 1000 }))
        .filter(({ start }) => start > watched.marks.ready && start < watched.marks.settled);
    const inGl = (from, to) =>
        watched.glCalls.reduce((sum, [start, took]) => sum + Math.max(0, Math.min(to, start + took) - Math.max(from, start)), 0);
    const own = (from, to) => {
        const busy = tasks.reduce(
            (sum, { start, took }) => sum + Math.max(0, Math.min(to, start + took) - Math.max(from, start)), 0);
        return busy - inGl(from, to);
    };
    const longest = [...tasks].sort((a, b) => b.took - a.took).slice(0, 5).map(({ start, took }) => ({
        at: seconds(start), milliseconds: Math.round(took), ofThatInGl: Math.round(inGl(start, start + took)),
    }));
    const longestOwn = Math.max(...tasks.map(({ start, took }) => took - inGl(start, start + took)));
    const frames = watched.frameStarts
        .slice(1)
        .map((start, i) => ({ from: watched.frameStarts[i], to: start }))
        .filter(({ from }) => from > watched.marks.ready && from < watched.marks.settled);
    const late = frames.filter(({ from, to }) => to - from > 50);
    const ownDoing = late.filter(({ from, to }) => own(from, to) > 50);
    return {
        tasks: tasks.length, longest, longestBesideGlMilliseconds: Math.round(longestOwn), frames: frames.length,
        framesOver50: late.length, framesOver50ByMainThread: ownDoing.length,
        share: frames.length ? Number((ownDoing.length / frames.length).toFixed(3)) : 0,
    };
}

async function memoryOf(page, session) {
    await session.send('HeapProfiler.collectGarbage');
    const { usedSize } = await session.send('Runtime.getHeapUsage');
    const { gpuBytes, heapBytes, session: counted } = await counters(page);
    return {
        jsHeap: mebibytes(usedSize), wasm: mebibytes(heapBytes), gpu: mebibytes(gpuBytes),
        decoded: mebibytes(counted.cacheBytes), compressed: mebibytes(counted.compressedBytes),
    };
}

async function measureFlight(browser) {
    const folder = await mkdtemp(join(tmpdir(), 'stipple-flight-'));
    try {
        for (let i = 0; i < Number(options.clouds); i++)
            await makeTown(folder, { points: 60_000, seed: i + 1, name: `town${i}` });
        const server = await serve(folder);
        const { page, complaints } = await openPage(browser, { width: 640, height: 480 });
        page.setDefaultTimeout(180_000);
        const session = await page.context().newCDPSession(page);
        await page.goto(`${server.address}?cloud=`);
        const list = [];
        for (let next = 'api/v1/clouds'; next; ) {
            const answer = await (await fetch(new URL(next, server.address))).json();
            list.push(...answer.clouds);
            next = answer.next;
        }
        await page.waitForFunction(() => window.stipple);
        const bytes = Number(options.cache) * (1 << 20);
        await page.evaluate((limits) => window.stipple.setLimits(limits), { cacheBytes: bytes, compressedBytes: bytes, gpuBytes: bytes });
        await page.evaluate((addresses) => addresses.forEach((at) => window.stipple.open(at)), list.map(({ address }) => address));
        await settleWithPoints(page);
        await page.evaluate(() => {
            let seed = 7;
            const random = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
            const bounds = window.stipple.clouds().map((cloud) => cloud.bounds);
            const min = [0, 1, 2].map((axis) => Math.min(...bounds.map((box) => box.min[axis])));
            const max = [0, 1, 2].map((axis) => Math.max(...bounds.map((box) => box.max[axis])));
            const place = (height) => min.map((least, axis) =>
                axis < 2 ? least + (max[axis] - least) * random() : max[2] + height * (max[0] - min[0]) * random());
            let [from, to, begun] = [window.stipple.camera(), window.stipple.camera(), 0];
            const step = (now) => {
                if (now - begun > 3000) {
                    [from, begun] = [window.stipple.camera(), now];
                    to = { position: place(0.5), target: place(0) };
                    if (random() < 0.2)
                        window.stipple.setLimits({ pointBudget: [100_000, 500_000, 2_000_000][Math.floor(3 * random())] });
                }
                const t = Math.min(1, (now - begun) / 2500);
                const mix = (a, b) => a.map((value, axis) => value + (b[axis] - value) * t);
                window.stipple.setCamera({ position: mix(from.position, to.position), target: mix(from.target, to.target) });
                requestAnimationFrame(step);
            };
            requestAnimationFrame(step);
        });
        const minutes = [];
        for (let minute = 0; minute <= Number(options.minutes); minute++) {
            minutes.push({ minute, ...(await memoryOf(page, session)) });
            console.error(JSON.stringify(minutes.at(-1)));
            if (minute < Number(options.minutes)) await new Promise((resolve) => setTimeout(resolve, 60_000));
        }
        const { session: counted } = await counters(page);
        await server.stop();
        return { clouds: list.length, minutes, counted, complaints };
    } finally {
        await rm(folder, { recursive: true, force: true });
    }
}

async function measureReopening(browser) {
    const server = await serve(resolve(file));
    const { page, complaints } = await openPage(browser, { width: 640, height: 480 });
    page.setDefaultTimeout(180_000);
    const session = await page.context().newCDPSession(page);
    await page.goto(`${server.address}?cloud=`);
    const [{ address }] = (await (await fetch(new URL('api/v1/clouds', server.address))).json()).clouds;
    await page.waitForFunction(() => window.stipple);
    await page.evaluate(() => window.stipple.setLimits({ pointBudget: 300_000 }));
    const memory = [];
    for (let time = 1; time <= Number(options.times); time++) {
        await page.evaluate((at) => window.stipple.open(at, 'Measured'), address);
        await settleWithPoints(page);
        await page.getByRole('button', { name: 'Close Measured' }).click();
        await page.evaluate(() => window.stipple.settled());
        if (time % 10 !== 0 && time !== 1) continue;
        memory.push({ time, ...(await memoryOf(page, session)) });
        console.error(JSON.stringify(memory.at(-1)));
    }
    await server.stop();
    return { memory, complaints };
}

const measures = { open: measureOpen, tasks: measureTasks, fly: measureFlight, reopen: measureReopening };
if (!measures[kind] || (!file && kind !== 'fly')) {
    console.error('usage: node scripts/measure_streaming_page.mjs open|tasks|reopen FILE.stipple, or fly (see its beginning)');
    process.exit(2);
}
const browser = await launch();
try {
    console.log(JSON.stringify({ measured: kind, file, ...(await measures[kind](browser)) }, null, 2));
} finally {
    await browser.close();
}
