// <stipple-viewer> as an npm package: packed, installed in a folder of its own, opened from a plain static host under a
// strict policy; several on a page; what it tells and can be asked; that it gives back what it was lent.
import assert from 'node:assert/strict';
import { writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { keepScreenshot, launch, openPage } from './support/browser.mjs';
import { installPackage, run } from './support/embedding.mjs';

const root = fileURLToPath(new URL('../..', import.meta.url));
let browser, site;

before(async () => {
    await run(join(root, 'scripts/build_package.sh'), { cwd: root });
    site = await installPackage();
    browser = await launch();
});
after(async () => {
    await browser?.close();
    await site?.close();
});

async function open(name = 'index.html', size = { width: 900, height: 420 }) {
    const opened = await openPage(browser, size);
    const strangers = [];
    opened.page.on('request', (request) => {
        if (!request.url().startsWith(site.address)) strangers.push(request.url());
    });
    await opened.page.goto(site.address + name);
    return { ...opened, strangers };
}
const settled = (page, id) =>
    page.evaluate(async (name) => {
        const viewer = document.getElementById(name);
        await viewer.whenReady();
        for (;;) {
            await viewer.settled();
            if (viewer.getClouds().every((cloud) => cloud.stage === 'ready')) return viewer.settled();
            await new Promise((resolve) => setTimeout(resolve, 50));
        }
    }, id);

describe('two viewers on a page', () => {
    test('each shows its cloud, under the strict policy, and asks no other host; keys go to the one with the focus', async () => {
        const { page, complaints, strangers } = await open();
        await settled(page, 'a');
        await settled(page, 'b');
        await keepScreenshot(page, 'embedded');
        const state = () => page.evaluate(() => ['a', 'b'].map((id) => document.getElementById(id).getCamera().position));
        const clouds = await page.evaluate(() => ['a', 'b'].map((id) => document.getElementById(id).getClouds().map(({ pointCount }) => pointCount)));
        assert.deepEqual(clouds, [[60_000], [30_000]]);
        assert.equal(await page.evaluate(() => document.getElementById('b').getLimits().pointBudget), 20_000);
        const start = await state();
        await page.locator('#a canvas').press('ArrowLeft');
        const one = await state();
        assert.notDeepEqual(one[0], start[0]);
        assert.deepEqual(one[1], start[1]);
        await page.locator('#b canvas').first().press('ArrowLeft');
        const both = await state();
        assert.deepEqual(both[0], one[0]);
        assert.notDeepEqual(both[1], one[1]);
        // Only the one that has the attribute has controls, and it speaks its language in its theme.
        assert.equal(await page.locator('#a').getByRole('region').count(), 0);
        await page.locator('#b').getByText('Bedienung').waitFor();
        const back = (id) => page.evaluate((name) => getComputedStyle(document.getElementById(name)).backgroundColor, id);
        assert.notEqual(await back('b'), 'rgb(24, 26, 30)');
        assert.deepEqual([complaints, strangers], [[], []]);
        await page.close();
    });

    test('it tells what happens and does what it is asked', async () => {
        const { page, complaints } = await open();
        await settled(page, 'a');
        await page.evaluate(() => {
            const viewer = document.getElementById('a');
            window.told = {};
            for (const name of ['ready', 'camera-change', 'cloud-change', 'pick', 'problem', 'measurement-change', 'context-lost'])
                viewer.addEventListener(name, (event) => (window.told[name] = event.detail));
            viewer.setStyle({ sizePixels: 6 });
        });
        await settled(page, 'a');
        const told = (name) => page.waitForFunction((what) => window.told[what], name).then((handle) => handle.jsonValue());
        await page.locator('#a canvas').click({ position: { x: 210, y: 170 } });
        const { point } = await told('pick');
        const box = await page.locator('#a').boundingBox();
        const again = await page.evaluate(() => document.getElementById('a').pick(210, 170));
        assert.deepEqual(point.position, again.position);
        assert.ok(box.width === 420);

        const { wrong, scene, picture, sized } = await page.evaluate(async () => {
            const viewer = document.getElementById('a');
            const failure = (act) => {
                try {
                    act();
                } catch (error) {
                    return error.message;
                }
            };
            const wrong = [
                failure(() => viewer.setCamera({ fovYDegrees: 500 })),
                failure(() => viewer.setScene('{"stipple": "scene", "version": 99}')),
                failure(() => viewer.setStyle({ sizePixels: -1 })),
            ];
            const [cloud] = viewer.getClouds();
            await viewer.flyTo({ cloud: cloud.id });
            const scene = viewer.getScene();
            const picture = await viewer.screenshot();
            const bitmap = await createImageBitmap(picture);
            const large = await viewer.screenshot({ width: 600, progress: (share) => (window.share = share) }), pieces = [];
            await viewer.writeScreenshot(new WritableStream({ write: (bytes) => void pieces.push(bytes) }), { width: 600 });
            const streamed = await new Blob(pieces).arrayBuffer(), kept = await large.arrayBuffer();
            const enlarged = await createImageBitmap(large);
            wrong.push(
                await viewer.screenshot({ width: 65_001 }).catch((error) => error.message),
                await viewer.screenshot({ width: 600, signal: AbortSignal.abort(new Error('enough')) }).catch((error) => error.message),
                window.share === 1 && new Uint8Array(streamed).every((byte, i) => byte === new Uint8Array(kept)[i]),
            );
            return { wrong, scene, picture: picture.type, sized: [bitmap.width, bitmap.height, enlarged.width, enlarged.height] };
        });
        assert.match(wrong[0], /fovYDegrees/);
        assert.match(wrong[1], /version 99/);
        assert.match(wrong[2], /sizePixels/);
        assert.equal(picture, 'image/png');
        assert.match(wrong[3], /at most 65,000 a side/);
        assert.deepEqual(wrong.slice(4), ['enough', true]);
        assert.deepEqual(sized, [420, 300, 600, 429]);
        assert.ok((await told('camera-change')).camera.position.every(Number.isFinite));

        // The scene in the other viewer: the same clouds, camera and looks. Then another cloud by attribute.
        const other = await page.evaluate((it) => {
            const viewer = document.getElementById('b');
            viewer.setScene(it);
            return viewer.getScene();
        }, scene);
        assert.deepEqual({ ...other, limits: {} }, { ...scene, limits: {} });
        await page.evaluate(() => (document.getElementById('a').setAttribute('src', 'other.stipple absent.stipple')));
        assert.match((await told('problem')).sentence, /absent\.stipple/);
        const names = await page.evaluate(() => document.getElementById('a').getClouds().map(({ name }) => name));
        assert.deepEqual(names, ['other.stipple', 'absent.stipple']);
        await page.evaluate(() => document.getElementById('b').setAttribute('lang', 'ja'));
        await page.locator('#b').getByText('設定', { exact: true }).waitFor();
        assert.deepEqual(complaints.filter((text) => !/404/.test(text)), []);
        await page.close();
    });

    test('disposed of or removed, it gives back workers, context and requests, and starts anew; memory stays flat', async () => {
        const { page, complaints } = await open('empty.html');
        const round = () =>
            page.evaluate(async () => {
                const row = document.querySelector('.row');
                const viewers = ['town.stipple', 'other.stipple'].map((src) => {
                    const viewer = document.createElement('stipple-viewer');
                    viewer.setAttribute('src', src);
                    viewer.toggleAttribute('controls', src === 'other.stipple');
                    row.append(viewer);
                    return viewer;
                });
                await Promise.all(viewers.map((viewer) => viewer.whenReady()));
                const drawn = (viewer) =>
                    new Promise((resolve) => viewer.addEventListener('camera-change', resolve, { once: true }));
                await Promise.all(viewers.map(drawn));
                await Promise.all(viewers.map((viewer) => viewer.settled()));
                const contexts = viewers.map((viewer) => viewer.shadowRoot.querySelector('canvas').getContext('webgl2'));
                viewers[0].dispose();
                viewers[1].remove();
                await new Promise((resolve) => setTimeout(resolve, 100));
                const left = viewers.map((viewer) => viewer.shadowRoot.childNodes.length);
                return { lost: contexts.map((context) => context.isContextLost()), left, asked: await viewers[0].whenReady().catch((error) => error.message), ended: (row.replaceChildren(), true) };
            });
        const session = await page.context().newCDPSession(page);
        const heap = async () => {
            await session.send('HeapProfiler.collectGarbage');
            return (await session.send('Runtime.getHeapUsage')).usedSize;
        };
        const sizes = [];
        for (let i = 0; i < 5; i++) {
            const { lost, left, asked } = await round();
            assert.deepEqual([lost, left], [[true, true], [0, 0]]);
            assert.match(asked, /not in a document|disposed/);
            for (let i = 0; i < 50 && page.workers().length > 0; i++) await page.waitForTimeout(100); // is told a little later
            assert.equal(page.workers().length, 0);
            sizes.push(await heap());
        }
        console.log(`  heap after each round: ${sizes.map((size) => `${(size / 1e6).toFixed(2)} MB`).join(', ')}`);
        assert.ok(sizes.at(-1) < sizes[1] + 1.5e6, 'the heap grows');
        // Moved within the page it goes on; disposed of and put back it starts anew.
        const again = await page.evaluate(async () => {
            const row = document.querySelector('.row'), viewer = document.createElement('stipple-viewer');
            row.append(viewer);
            await viewer.whenReady();
            const canvas = viewer.shadowRoot.querySelector('canvas');
            document.body.append(viewer);
            await new Promise((resolve) => setTimeout(resolve, 20));
            const isSame = viewer.shadowRoot.querySelector('canvas') === canvas;
            viewer.dispose();
            row.append(viewer);
            await viewer.whenReady();
            return [isSame, viewer.shadowRoot.querySelector('canvas') !== canvas];
        });
        assert.deepEqual(again, [true, true]);
        assert.deepEqual(complaints, []);
        await page.close();
    });
});

test('its types hold: what is right compiles, what is wrong does not', async () => {
    const source = `import { StippleViewer, type Camera } from 'stipple-viewer';
const viewer: StippleViewer = document.createElement('stipple-viewer');
viewer.addEventListener('camera-change', (event) => { const camera: Camera = event.detail.camera; void camera; });
viewer.addEventListener('pick', ({ detail }) => detail.point?.position.map((value) => value.toFixed(2)));
viewer.addEventListener('click', (event) => event.clientX);
const id: number = viewer.addCloud('a.stipple');
void viewer.flyTo({ cloud: id }).then(() => viewer.screenshot()).then((blob) => blob.size);
viewer.setStyle({ edl: { strength: 0.5 } });
// @ts-expect-error: there is no such event detail
viewer.addEventListener('pick', ({ detail }) => detail.pointt);
// @ts-expect-error: a number of points is no camera
viewer.setCamera({ position: 3 });
// @ts-expect-error: the model is not public
StippleViewer.modelOf(viewer);
`;
    await writeFile(join(site.folder, 'use.ts'), source);
    const options = ['--noEmit', '--strict', '--module', 'nodenext', '--target', 'es2022', '--lib', 'es2022,dom', '--types', ''];
    await run(join(root, 'www/node_modules/.bin/tsc'), [...options, 'use.ts'], { cwd: site.folder }).catch((error) => assert.fail(error.stdout));
});
