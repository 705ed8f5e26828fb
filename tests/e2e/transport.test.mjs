// What goes wrong between the page and a cloud's server: the message on screen, what to do, and the state after.
import assert from 'node:assert/strict';
import { after, before, beforeEach, describe, test } from 'node:test';

import { counters, keepScreenshot, launch, openPage, readPixels, settle, settleWithPoints } from './support/browser.mjs';
import { bytesAskedTwice, faultyServer } from './support/faulty_server.mjs';
import { makeTown, scratchFolder, serve } from './support/program.mjs';

const size = { width: 640, height: 400 };
let browser, folder, server, host;

before(async () => {
    folder = await scratchFolder();
    const town = await makeTown(folder.path);
    server = await serve(town);
    host = await faultyServer(town);
    browser = await launch();
});
after(async () => {
    await browser?.close();
    await host?.close();
    await server?.stop();
    await folder?.cleanUp();
});
beforeEach(() => host.restart());

/** The page, with the host's file. `prepare` is done with the page before the cloud is opened. */
async function openCloud({ prepare, budget } = {}) {
    const opened = await openPage(browser, size);
    await opened.page.goto(`${server.address}?cloud=`);
    await opened.page.waitForFunction(() => window.stipple !== undefined);
    if (budget) await opened.page.evaluate((pointBudget) => window.stipple.setLimits({ pointBudget }), budget);
    await prepare?.(opened.page);
    await opened.page.evaluate((address) => window.stipple.open(address, 'Town'), host.address);
    return opened;
}

/** With a few of its points, most of the file unread. */
async function openPart() {
    const opened = await openCloud({ budget: 5000 });
    await settleWithPoints(opened.page);
    return { ...opened, camera: await cameraOf(opened.page) };
}
const wantAll = (page) => page.evaluate(() => window.stipple.setLimits({ pointBudget: 1_000_000 }));
const cameraOf = (page) => page.evaluate(() => window.stipple.camera());

/** The text of the one problem of that kind. */
async function problem(page, kind, says) {
    const box = page.locator(`[data-problem=${kind}]`, { hasText: says });
    await box.waitFor();
    assert.equal(await box.getAttribute('role'), kind === 'stopped' ? 'alert' : 'status');
    return box.textContent();
}
const noProblem = (page) => page.locator('[data-problem]').waitFor({ state: 'detached' });

/** By keyboard; then the whole cloud is there and nothing is wrong. */
async function retryAndSee(page) {
    await page.getByRole('button', { name: 'Retry Town' }).press('Enter');
    await noProblem(page);
    const { frame } = await settleWithPoints(page);
    assert.ok(frame.complete);
    return frame;
}

describe('hosts that are set up wrongly', () => {
    test('one that answers 200 to a range is left at once, with how to mend it', async () => {
        const whole = 256 << 20;
        host.fault = () => ({ whole });
        const { page } = await openCloud();
        const text = await problem(page, 'stopped', 'ignores Range and sends the whole file');
        assert.match(text, /stipple serve.*byte ranges/);
        await keepScreenshot(page, 'no-ranges');
        assert.equal(host.asked.length, 1);
        await page.waitForTimeout(300);
        assert.equal(host.cutOff, 1);
        assert.ok(host.bytesSent < whole / 16, `${host.bytesSent} bytes were sent`);
        const sent = host.bytesSent;
        await page.waitForTimeout(300);
        assert.equal(host.bytesSent, sent);
        host.fault = undefined;
        await retryAndSee(page);
        await page.close();
    });

    test('one that does not allow the page to read is told apart from one that is away', async () => {
        host.fault = () => ({ isPrivate: true });
        const { page } = await openCloud();
        const text = await problem(page, 'stopped', 'does not allow this page to read the file');
        assert.ok(text.includes(`Access-Control-Allow-Origin: ${new URL(server.address).origin}`), text);
        assert.equal(host.asked.length, 1);
        host.fault = undefined;
        await retryAndSee(page);
        await page.close();
    });

    test('one that hides Content-Range', async () => {
        host.fault = () => ({ hides: ['Content-Range'] });
        const { page } = await openCloud();
        const text = await problem(page, 'stopped', 'a part of the file without saying which');
        assert.match(text, /Access-Control-Expose-Headers: Content-Range, ETag/);
        assert.equal(host.asked.length, 1);
        host.fault = undefined;
        await retryAndSee(page);
        await page.close();
    });

    test('an http address on an https page is not even asked for', async () => {
        const { page } = await openPage(browser, size);
        const asked = [];
        page.on('request', (request) => asked.push(request.url()));
        await page.route('https://maps.example/**', async (route) => {
            const { pathname, search } = new URL(route.request().url());
            const answer = await fetch(new URL(pathname + search, server.address));
            const headers = { 'content-type': answer.headers.get('content-type') ?? '' };
            await route.fulfill({ status: answer.status, headers, body: Buffer.from(await answer.arrayBuffer()) });
        });
        await page.goto('https://maps.example/?cloud=http://clouds.example/town.stipple');
        const text = await problem(page, 'stopped', 'came over https may not read from an http address');
        assert.match(text, /give the cloud by https/i);
        assert.deepEqual(asked.filter((url) => url.startsWith('http://clouds.example')), []);
        await page.close();
    });

    test('one that names no version, or a weak one, is noted', async () => {
        host.fault = () => ({ headers: { etag: undefined } });
        const { page } = await openCloud();
        await page.getByText('no ETag and no Last-Modified').waitFor();
        await settleWithPoints(page);
        await page.getByRole('button', { name: 'Close Town' }).click();
        host.fault = undefined;
        host.etag = 'W/"1"';
        await page.evaluate((address) => window.stipple.open(address, 'Town'), host.address);
        await page.getByText('by a weak ETag only').waitFor();
        await settleWithPoints(page);
        await page.close();
    });
});

describe('files that change or are damaged', () => {
    for (const [kind, before, later] of [
        ['ETag', { etag: '"1"' }, { etag: '"2"' }],
        ['weak ETag', { etag: 'W/"1"' }, { etag: 'W/"2"' }],
        [
            'date, without an ETag',
            { etag: undefined, 'last-modified': 'Mon, 06 Jul 2026 10:00:00 GMT' },
            { etag: undefined, 'last-modified': 'Mon, 06 Jul 2026 10:00:01 GMT' },
        ],
    ])
        test(`one with another ${kind} is loaded again, once; the camera stays`, async () => {
            host.fault = () => ({ headers: before });
            const { page, camera } = await openPart();
            host.fault = () => ({ headers: later });
            await wantAll(page);
            await page.getByText('Town was replaced on its server').waitFor();
            const { frame, session } = await settleWithPoints(page);
            assert.ok(frame.complete);
            assert.equal(session.cloudsReloaded, 1);
            assert.deepEqual(await cameraOf(page), camera);
            assert.equal(await page.locator('[data-problem]').count(), 0);
            await page.close();
        });

    test('one that changes all the time is given up, until somebody asks for it', async () => {
        const { page, camera } = await openPart();
        host.fault = ({ number }) => ({ headers: { etag: `"${number}"` } });
        await wantAll(page);
        await problem(page, 'stopped', 'replaced while it was being read');
        host.fault = undefined;
        await retryAndSee(page);
        assert.deepEqual(await cameraOf(page), camera);
        await page.close();
    });

    for (const [what, fault] of [
        ['a damaged block', 'flipAt'],
        ['a block that is cut off', 'cutAt'],
    ])
        test(`${what} is asked for once more, then its node is missing and the rest shown`, async () => {
            let at; // where the third request begins: a block that the picture needs
            const isHit = ({ range: [first, last] }) => first <= at && at <= last;
            host.fault = ({ number, range }) => {
                if (number === 3) at = range[0] + 16;
                return { [fault]: at };
            };
            const { page } = await openCloud();
            const text = await problem(page, 'incomplete', /\d+ nodes? (is|are) missing; the rest is shown/);
            const part = await settleWithPoints(page);
            assert.equal(host.asked.filter(isHit).length, 2);
            await keepScreenshot(page, `missing-${fault}`);
            host.fault = undefined;
            const all = await retryAndSee(page);
            assert.equal(host.asked.filter(isHit).length, 3);
            assert.ok(all.nodesDrawn > part.frame.nodesDrawn, text);
            await page.close();
        });
});

describe('servers that refuse, and networks that fail', () => {
    test('who may not read is asked for a token, which goes with every request', async () => {
        const isGranted = ({ headers }) => headers.authorization === 'Bearer right';
        host.fault = (asked) => (isGranted(asked) ? {} : { status: 401 });
        const { page } = await openCloud();
        await problem(page, 'stopped', 'wants to know who asks (status 401)');
        await keepScreenshot(page, 'token');
        assert.equal(host.asked.length, 1);
        const give = async (token) => {
            await page.getByLabel('Token for Town').fill(token);
            await page.getByLabel('Token for Town').press('Enter');
        };
        await give('wrong');
        await page.getByText('The token that was given is not accepted').waitFor();
        await give('right');
        await noProblem(page);
        assert.ok((await settleWithPoints(page)).frame.complete);
        assert.equal(host.asked.filter(isGranted).length, host.asked.length - 2);
        await page.close();
    });

    test('access that ends while one looks keeps what is here', async () => {
        const { page, camera } = await openPart();
        host.fault = () => ({ status: 403 });
        await wantAll(page);
        await problem(page, 'stopped', 'refuses access (status 403)');
        assert.ok((await counters(page)).frame.pointsDrawn > 0);
        host.fault = undefined;
        await retryAndSee(page);
        assert.deepEqual(await cameraOf(page), camera);
        await page.close();
    });

    test('a machine that is offline goes on by itself when it is back', async () => {
        const { page, camera } = await openPart();
        await page.context().setOffline(true);
        await wantAll(page);
        await problem(page, 'retrying', 'this machine is offline');
        await problem(page, 'stopped', 'this machine is offline');
        assert.ok((await counters(page)).frame.pointsDrawn > 0);
        await page.context().setOffline(false);
        await noProblem(page);
        assert.ok((await settleWithPoints(page)).frame.complete);
        assert.deepEqual(await cameraOf(page), camera);
        await page.close();
    });

    test('a server that is gone for a moment is asked again by itself', async () => {
        host.isGone = true;
        const { page } = await openCloud();
        const text = await problem(page, 'retrying', "can't be reached");
        assert.match(text, /is tried again in \d s|is being tried again/);
        host.isGone = false;
        await noProblem(page);
        assert.ok((await settleWithPoints(page)).frame.complete);
        await page.close();
    });

    const inThreeSeconds = () => new Date(Date.now() + 3000).toUTCString(); // whole ones: 2 s at least
    for (const [status, retryAfter, how] of [[429, () => '2', 'seconds'], [503, inThreeSeconds, 'a date']])
        test(`a server that answers ${status} is left alone for as long as it asks, by ${how}`, async () => {
            host.fault = ({ number }) => (number === 1 ? { status, headers: { 'retry-after': retryAfter() } } : {});
            const { page } = await openCloud();
            const text = await problem(page, 'retrying', `status ${status}`);
            assert.match(text, /tried again in [123] s/);
            await noProblem(page);
            assert.ok((await settleWithPoints(page)).frame.complete);
            assert.ok(host.asked[1].at - host.asked[0].at >= 1990);
            await page.close();
        });
});

describe('requests', () => {
    test('the embedding page prepares them: address, headers, credentials', async () => {
        host.fault = ({ url, headers }) =>
            url === '/cloud.stipple?signature=7' && headers['x-visitor'] === 'me' && headers.cookie === 'who=me'
                ? {}
                : { status: 403 };
        const { page } = await openCloud({
            prepare: async (page) => {
                await page.context().addCookies([{ name: 'who', value: 'me', url: host.address, sameSite: 'Lax' }]);
                await page.evaluate(() => {
                    window.prepared = [];
                    window.stipple.prepareRequest = async (url, range) => {
                        window.prepared.push([url, range]);
                        await new Promise((resolve) => setTimeout(resolve, 5));
                        return { url: `${url}?signature=7`, headers: { 'X-Visitor': 'me' }, credentials: 'include' };
                    };
                });
            },
        });
        assert.ok((await settleWithPoints(page)).frame.complete);
        const prepared = await page.evaluate(() => window.prepared);
        assert.equal(prepared.length, host.asked.length);
        assert.ok(prepared.every(([url, range]) => url === host.address && /^bytes=\d+-\d+$/.test(range)));
        await page.close();
    });

    test('a hook that fails is named', async () => {
        const { page } = await openCloud({
            prepare: (page) =>
                page.evaluate(() => {
                    window.stipple.prepareRequest = () => Promise.reject(new Error('no signature today'));
                }),
        });
        await problem(page, 'retrying', 'no signature today');
        assert.equal(host.asked.length, 0);
        await page.evaluate(() => (window.stipple.prepareRequest = undefined));
        await noProblem(page);
        assert.ok((await settleWithPoints(page)).frame.complete);
        await page.close();
    });

    test('what is taken back is not sent any more, and nothing is read twice', async () => {
        const { page } = await openPart();
        assert.equal(bytesAskedTwice(host.asked), 0);
        host.rate = 10_000; // of each answer
        const [asked, sent] = [host.asked.length, host.bytesSent];
        await wantAll(page);
        while (host.bytesSent < sent + 20_000) await page.waitForTimeout(20);
        assert.ok(host.asked.length > asked);
        await page.getByRole('button', { name: 'Close Town' }).click();
        await page.waitForTimeout(300); // what was in pipes when the connections closed, a piece of each
        const stopped = host.bytesSent;
        await page.waitForTimeout(700);
        assert.equal(host.bytesSent, stopped);
        assert.ok(host.cutOff > 0);
        const wanted = host.asked.slice(asked).reduce((sum, { range }) => sum + range[1] + 1 - range[0], 0);
        assert.ok(stopped - sent < wanted * 0.8, `${stopped - sent} of ${wanted} bytes were sent`);
        const { session } = await counters(page);
        assert.ok(session.requestsCancelled > 0);
        assert.ok(session.bytesWasted > 5_000, `${session.bytesWasted} bytes`);
        await page.close();
    });

    /** What the browser has stored of clouds, once it does not grow any more. */
    async function storedBytes(page) {
        const read = () =>
            page.evaluate(async () => {
                const done = (request) => new Promise((resolve) => (request.onsuccess = () => resolve(request.result)));
                const database = await done(indexedDB.open('stipple-ranges', 1));
                const files = await done(database.transaction('files').objectStore('files').getAll());
                database.close();
                return files.reduce((sum, { storedBytes }) => sum + storedBytes, 0);
            });
        for (let before = -1; ; ) {
            const now = await read();
            if (now === before) return now;
            before = now;
            await page.waitForTimeout(150);
        }
    }

    test('what came stays for the next visit where that is asked for, which asks for the version alone', async () => {
        const context = await browser.newContext({ viewport: size });
        const visit = async (query, etag = '"1"') => {
            host.restart();
            host.etag = etag;
            const page = await context.newPage();
            await page.goto(`${server.address}?cloud=&${query}`);
            await page.waitForFunction(() => window.stipple !== undefined);
            await page.evaluate((address) => window.stipple.open(address, 'Town'), host.address);
            const { frame } = await settleWithPoints(page);
            assert.ok(frame.complete);
            const stored = query === '' ? 0 : await storedBytes(page);
            await page.close();
            const data = host.asked.filter(({ range }) => range[1] > 0).length;
            return { points: frame.pointsDrawn, stored, data, all: host.asked.length };
        };

        const without = await visit('');
        assert.equal(without.all, without.data);
        const first = await visit('store=64');
        assert.ok(first.data > 1);
        assert.equal(first.all, first.data + 1);
        assert.ok(first.stored > 100_000, `${first.stored} bytes are stored`);
        const second = await visit('store=64');
        assert.deepEqual(host.asked.map(({ range }) => range), [[0, 0]]);
        assert.equal(second.points, first.points);
        const changed = await visit('store=64', '"2"');
        assert.ok(changed.data > 1);
        assert.ok(changed.stored <= first.stored * 1.1, 'the old version is still there');
        const weak = await visit('store=64', 'W/"3"'); // names no bytes
        assert.ok(weak.data > 1);
        await context.close();
    });

    test('of what is here in part only the gaps are fetched: another camera, more points, no byte twice', async () => {
        const context = await browser.newContext({ viewport: size });
        const asked = [];
        const visit = async (query, spacingPixels, turns) => {
            host.restart();
            const page = await context.newPage();
            await page.goto(`${server.address}?cloud=&${query}`);
            await page.waitForFunction(() => window.stipple !== undefined);
            // Nodes come in parts: coarse ones first, the rest of the same nodes when points are to be closer.
            await page.evaluate((detail) => window.stipple.setStyle({ detail }), { mode: 'continuous', spacingPixels });
            await page.evaluate((address) => window.stipple.open(address, 'Town'), host.address);
            await settleWithPoints(page);
            if (turns) await page.getByRole('button', { name: 'Top' }).click();
            if (turns) await page.waitForTimeout(1500); // it flies there
            const { session } = await settleWithPoints(page), { rgba } = await readPixels(page);
            if (query !== '') await storedBytes(page);
            await page.close();
            return { session, rgba, data: host.asked.filter(({ range }) => range[1] > 0), sent: host.bytesSent };
        };
        asked.push(...(await visit('store=64', 3, false)).data);
        const more = await visit('store=64', 1, true);
        assert.ok(more.data.length > 0);
        asked.push(...more.data);
        assert.equal(bytesAskedTwice(asked), 0);
        const fresh = await visit('', 1, true);
        assert.ok(more.rgba.equals(fresh.rgba), 'another picture');
        assert.ok(more.sent < fresh.sent, `${more.sent} of ${fresh.sent} bytes`);
        assert.ok(more.session.bytesReceived > more.sent, `${more.session.bytesReceived} and ${more.sent} bytes`);
        await context.close();
    });

    test('a file that was replaced between two visits is not mixed with what is stored of it', async () => {
        const context = await browser.newContext({ viewport: size });
        const page = await context.newPage();
        await page.goto(`${server.address}?cloud=&store=64`);
        await page.waitForFunction(() => window.stipple !== undefined);
        await page.evaluate((wanted) => window.stipple.setLimits(wanted), { pointBudget: 20_000 });
        await page.evaluate((address) => window.stipple.open(address, 'Town'), host.address);
        await settleWithPoints(page);
        await storedBytes(page);
        await page.close();
        let isReplaced = false; // right after its version was asked for
        host.fault = ({ range }) => ({ headers: (isReplaced ||= range[1] > 0) ? { etag: '"2"' } : {} });
        const again = await context.newPage();
        await again.goto(`${server.address}?cloud=&store=64`);
        await again.waitForFunction(() => window.stipple !== undefined);
        await again.evaluate((address) => window.stipple.open(address, 'Town'), host.address);
        await again.getByText('Town was replaced on its server').waitFor();
        assert.ok((await settleWithPoints(again)).frame.complete);
        await context.close();
    });

    test('what is stored stays within its bytes', async () => {
        const context = await browser.newContext({ viewport: size });
        const page = await context.newPage();
        await page.goto(`${server.address}?cloud=&store=0.2`);
        await page.waitForFunction(() => window.stipple !== undefined);
        await page.evaluate((address) => window.stipple.open(address, 'Town'), host.address);
        assert.ok((await settleWithPoints(page)).frame.complete);
        const stored = await storedBytes(page);
        assert.ok(stored > 0 && stored <= 0.2 * 2 ** 20, `${stored} bytes`);
        await context.close();
    });

    test('what is on its way counts when the network is measured', async () => {
        host.rate = 100_000; // of each answer, of which six come at a time
        const { page } = await openCloud();
        await settleWithPoints(page);
        const { session } = await counters(page);
        assert.ok(session.networkBytesPerSecond > 50_000, `${session.networkBytesPerSecond}`);
        assert.ok(session.networkBytesPerSecond < 700_000, `${session.networkBytesPerSecond}`);
        assert.equal(session.bytesFetchedTwice, 0);
        await page.close();
    });
});
