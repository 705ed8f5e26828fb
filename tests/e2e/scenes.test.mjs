// Scenes: what was set up is saved, and is the same again in a new browser, from a file and from a link; what is wrong in one is
// said, changes nothing and runs no script.
import assert from 'node:assert/strict';
import { readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';

import { keepScreenshot, launch, openPage, readPixels, settle, settleWithPoints } from './support/browser.mjs';
import { readPng } from './support/picture.mjs';
import { makeTown, scratchFolder, serve } from './support/program.mjs';

const size = { width: 800, height: 560 };
let browser, folder, server;

before(async () => {
    folder = await scratchFolder();
    const clouds = [await makeTown(folder.path), await makeTown(folder.path, { points: 20_000, seed: 2, name: 'village' })];
    server = await serve(...clouds);
    browser = await launch();
});

after(async () => {
    await browser?.close();
    await server?.stop();
    await folder?.cleanUp();
});

async function openTown() {
    const opened = await openPage(browser, size);
    await opened.page.goto(server.address);
    await settleWithPoints(opened.page);
    return opened;
}

async function saved(page) {
    const [download] = await Promise.all([
        page.waitForEvent('download'),
        page.getByRole('button', { name: 'Save' }).click(),
    ]);
    return JSON.parse(await readFile(await download.path(), 'utf8'));
}

async function load(page, scene) {
    const path = join(folder.path, 'scene.json');
    await writeFile(path, typeof scene === 'string' ? scene : JSON.stringify(scene));
    await page.locator('stipple-scene input[type=file]').setInputFiles(path);
}

const state = (page) =>
    page.evaluate(() => ({
        camera: window.stipple.camera(),
        measurements: window.stipple.measurements().map(({ kind, name, hidden, points, answer }) => ({
            kind, name, hidden, answer,
            places: points.map(({ integers, position, point }) => ({ integers, position, node: point.node })),
        })),
    }));

/** A scene that uses everything: two clouds, one of them hidden, looks, limits, a filter, a clip box, measurements. */
async function setUp(page) {
    await page.getByRole('button', { name: 'village' }).click();
    await page.waitForFunction(() => window.stipple?.counters().settled);
    await page.waitForTimeout(500);
    await page.getByRole('checkbox', { name: 'Show village' }).uncheck();
    const { min, max } = await page.evaluate(() => {
        const { target } = window.stipple.camera();
        return { min: target, max: target };
    });
    await page.evaluate(
        ([centre]) => {
            window.stipple.setStyle({
                colourMode: 'mix',
                mix: [{ colourMode: 'rgb' }, { colourMode: 'elevation', weight: 0.5 }],
                sizePixels: 4,
                shape: 'square',
                edl: { strength: 0.7 },
                hiddenClasses: [5],
                filters: [{ attribute: 'Return Number', min: null, max: 3 }],
                clipBoxes: [{ mode: 'hideOutside', centre, halfSize: [90, 90, 90] }],
                clipRegions: [
                    {
                        mode: 'hideInside',
                        region: { polygon: [[-9, -9], [8, -7], [0, 0], [9, 11]].map(([x, y]) => [centre[0] + x, centre[1] + y]), heights: [null, 400] },
                    },
                ],
                background: [40, 50, 60],
            });
            window.stipple.setLimits({ pointBudget: 120000 });
        },
        [min, max],
    );
    await settle(page);
    await page.getByRole('radio', { name: 'Move: Earth' }).check({ force: true });
    for (const [tool, places] of [['Distance', 2], ['Area', 3], ['Point', 1]]) {
        await page.getByRole('button', { name: tool, exact: true }).click();
        for (let i = 0; i < places; i++) {
            await page.locator('canvas').click({ position: { x: 430 + 70 * i, y: 250 + 45 * (i % 2) } });
            await page.waitForFunction((n) => window.stipple.measurements().at(-1)?.points.length === n, i + 1);
        }
        await page.keyboard.press('Enter');
    }
    await page.getByLabel('Unit').selectOption({ label: 'Feet' });
    await page.getByRole('button', { name: 'Hide Area 1' }).click();
    await settle(page);
}

async function assertSame(page, before, pixels) {
    assert.deepEqual(await state(page), before);
    const { rgba } = await readPixels(page);
    assert.equal(Buffer.compare(rgba, pixels.rgba), 0, 'the picture is another');
    assert.equal(await page.getByRole('checkbox', { name: 'Show village' }).isChecked(), false);
    assert.equal(await page.getByRole('radio', { name: 'Move: Earth' }).isChecked(), true);
    assert.equal(await page.getByLabel('Unit').inputValue(), 'ft');
    assert.equal(await page.locator('stipple-measure-overlay g').count(), 2);
}

describe('scenes', () => {
    test('a scene is the same again in a new browser, from a file and from a link', async () => {
        const { page, complaints } = await openTown();
        await setUp(page);
        const before = await state(page), pixels = await readPixels(page), scene = await saved(page);
        assert.equal(before.measurements.length, 3);
        assert.equal(scene.clouds.length, 2);
        await page.getByRole('button', { name: 'Link' }).click();
        const link = await page.getByLabel('Link to this scene').inputValue();
        console.log(`  link: ${link.length} characters, file: ${JSON.stringify(scene).length} bytes`);
        await keepScreenshot(page, 'scene');
        assert.deepEqual(complaints, []);
        await page.close();

        const other = await launch();
        try {
            for (const way of ['file', 'link']) {
                const { page, complaints } = await openPage(other, size);
                await page.goto(way === 'link' ? link : server.address);
                await settleWithPoints(page);
                if (way === 'file') await load(page, scene);
                await page.waitForFunction(() => window.stipple.measurements().length === 3);
                await page.waitForTimeout(500);
                await settle(page);
                await assertSame(page, before, pixels);
                const again = await saved(page);
                assert.deepEqual(again, scene);
                assert.deepEqual(complaints, []);
                await page.close();
            }
        } finally {
            await other.close();
        }
    });

    test('what is wrong in a scene is said, and nothing changes', async () => {
        const { page } = await openTown();
        const scene = await saved(page), before = await state(page), pixels = await readPixels(page);
        const point = { integers: [1, 2, 3], position: [0, 0, 0], scale: [1, 1, 1], offset: [0, 0, 0] };
        const wrong = [
            ['{"stipple": "scene", "version": 1', /not JSON/],
            ['[]', /must be an object/],
            [{ type: 'FeatureCollection' }, /not a scene of Stipple/],
            [{ ...scene, version: 99 }, /version 99/],
            [{ ...scene, colour: 'red' }, /colour is not a field/],
            [{ ...scene, clouds: [{ address: 'javascript:alert(1)', name: 'x' }] }, /clouds\[0\]\.address/],
            [{ ...scene, clouds: [{ name: 'x' }] }, /clouds\[0\] must have an address/],
            [{ ...scene, camera: { position: ['a', 0, 0] } }, /position/],
            [{ ...scene, camera: { fovYDegrees: 500 } }, /fovYDegrees/],
            [{ ...scene, style: { sizePixels: -3 } }, /sizePixels/],
            [{ ...scene, style: { nonsense: 1 } }, /nonsense/],
            [{ ...scene, limits: { pointBudget: 'all' } }, /pointBudget/],
            [{ ...scene, measurements: [{ kind: 'weight', points: [point] }] }, /measurements\[0\]\.kind/],
            [{ ...scene, measurements: [{ kind: 'distance', points: [point] }] }, /too few/],
            [{ ...scene, measurements: [{ kind: 'point', points: [{ ...point, scale: [0, 1, 1] }] }] }, /points\[0\]\.scale/],
            [{ ...scene, measurements: [{ kind: 'point', points: [{ ...point, integers: [0.5, 1, 1] }] }] }, /integers/],
            [`{"stipple": "scene", "version": 1, "__proto__": {"polluted": true}}`, /__proto__/],
        ];
        for (const [text, message] of wrong) {
            await load(page, text);
            const notice = page.getByRole('alert').filter({ hasText: message });
            await notice.first().waitFor();
            await notice.first().getByRole('button', { name: 'Dismiss' }).click();
        }
        assert.equal(await page.evaluate(() => ({}).polluted), undefined);
        await settle(page);
        assert.deepEqual(await state(page), before);
        assert.equal(Buffer.compare((await readPixels(page)).rgba, pixels.rgba), 0);
        await page.close();
    });

    test('a scene from a stranger runs no script, and a damaged link is said', async () => {
        const { page, complaints } = await openTown();
        const scene = await saved(page);
        const script = '<img src=x onerror="window.hacked=1"><script>window.hacked=1</script>';
        const point = {
            integers: [1, 2, 3], position: [0, 0, 0], scale: [1, 1, 1], offset: [0, 0, 0], cloudName: script, crs: script,
            unit: script, unitMeters: 1,
        };
        const far = { ...point, integers: [5, 5, 5], position: [5, 5, 5] };
        await load(page, {
            ...scene,
            clouds: scene.clouds.map((cloud) => ({ ...cloud, name: script })),
            measurements: [{ kind: 'distance', name: script, points: [point, far] }],
        });
        await page.waitForFunction(() => window.stipple.measurements().length === 1);
        await page.waitForTimeout(500);
        assert.equal(await page.evaluate(() => window.hacked), undefined);
        assert.equal(await page.locator('[data-measurement] input').first().inputValue(), script);
        assert.equal(await page.locator('img').count(), 0);
        assert.deepEqual(complaints, []);

        for (const fragment of ['#scene=AAAA', '#scene=%%%', `#scene=${'A'.repeat(5000)}`]) {
            const { page: other } = await openPage(browser, size);
            await other.goto(server.address + fragment);
            await other.getByRole('alert').filter({ hasText: /cut or damaged|not JSON/ }).first().waitFor();
            await settleWithPoints(other); // the server's cloud is shown all the same
            await other.close();
        }
        await page.close();
    });

    test('a scene of a file that is not the server\'s says which to open; a picture is what is seen', async () => {
        const { page } = await openTown();
        const scene = await saved(page);
        await load(page, { ...scene, clouds: [...scene.clouds, { file: 'scan.stipple', name: 'scan', visible: true }] });
        await page.getByRole('alert').filter({ hasText: 'scan.stipple: open it' }).waitFor();
        await settle(page);
        const [download] = await Promise.all([
            page.waitForEvent('download'),
            page.getByRole('button', { name: 'Picture' }).click(),
        ]);
        const path = join(folder.path, 'picture.png');
        await download.saveAs(path);
        const picture = await readPng(path), pixels = await readPixels(page);
        assert.equal(picture.width, pixels.width);
        assert.equal(Buffer.compare(Buffer.from(picture.rgba), pixels.rgba), 0);
        await page.close();
    });
});
