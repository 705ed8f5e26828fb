// Pictures of any size, camera paths with playback and their pictures as files, and the JSON Schema of scenes.
import assert from 'node:assert/strict';
import { readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';

import Ajv from 'ajv/dist/2020.js';

import { keepScreenshot, launch, openPage, readPixels, settle, settleWithPoints } from './support/browser.mjs';
import { answerPicker, pickedFile, waitForPicked } from './support/files.mjs';
import { readPng } from './support/picture.mjs';
import { makeTown, scratchFolder, serve } from './support/program.mjs';
import { storedEntries } from './support/zip.mjs';

const size = { width: 700, height: 525 };
let browser, folder, server;

before(async () => {
    folder = await scratchFolder();
    server = await serve(await makeTown(folder.path, { points: 30_000 }));
    browser = await launch();
});
after(async () => {
    await browser?.close();
    await server?.stop();
    await folder?.cleanUp();
});

async function openTown(viewport = size) {
    const opened = await openPage(browser, viewport);
    await opened.page.goto(server.address);
    await settleWithPoints(opened.page);
    return opened;
}
const button = (page, name) => page.getByRole('button', { name, exact: true });
const cameraOf = (page) => page.evaluate(() => window.stipple.camera());
const style = (page, change) => page.evaluate((to) => window.stipple.setStyle(to), change);

async function downloaded(page, act) {
    const [download] = await Promise.all([page.waitForEvent('download'), act()]);
    return readFile(await download.path());
}
async function pixelsOf(png) {
    const path = join(folder.path, 'picture.png');
    await writeFile(path, png);
    return readPng(path);
}
async function pictureOf(page) {
    return pixelsOf(await downloaded(page, () => button(page, 'Picture').click()));
}
async function wantSize(page, width, height) {
    await page.getByLabel('Width of the picture').fill(String(width));
    await page.getByLabel('Height of the picture').fill(String(height));
    await page.getByLabel('Height of the picture').press('Tab');
}

describe('pictures', () => {
    test('larger than the page are what a page of that size shows, point by point', async () => {
        const { page, complaints } = await openTown();
        await style(page, { sizePixels: 2, shape: 'square' });
        await settle(page);
        const before = await readPixels(page), looks = await page.evaluate(() => window.stipple.style());
        const [width, height] = [1120, 840];
        await wantSize(page, width, height);
        const picture = await pictureOf(page);
        assert.deepEqual([picture.width, picture.height], [width, height]);

        const { page: large } = await openTown({ width, height });
        const factor = height / size.height;
        await large.evaluate((camera) => window.stipple.setCamera(camera), await cameraOf(page));
        await style(large, {
            sizePixels: 2 * factor,
            shape: 'square',
            minSizePixels: looks.minSizePixels * factor,
            maxSizePixels: looks.maxSizePixels * factor,
            edl: { radiusPixels: looks.edl.radiusPixels * factor },
        });
        await settle(large);
        const expected = await readPixels(large);
        assert.equal(Buffer.compare(picture.rgba, expected.rgba), 0);
        await large.close();

        // The page has its own picture again.
        await settle(page);
        assert.equal(Buffer.compare((await readPixels(page)).rgba, before.rgba), 0);
        assert.deepEqual(await page.evaluate(() => window.stipple.style()), looks);
        for (const [w, h] of [[65_001, 10], [0, 5]]) {
            await wantSize(page, w, h);
            await button(page, 'Picture').click();
            await page.getByRole('alert').filter({ hasText: 'at most 65,000 a side' }).first().waitFor();
            await page.getByRole('button', { name: 'Dismiss' }).first().click();
        }
        assert.deepEqual(complaints, []);
        await page.close();
    });
});

/** As if the graphics system drew no more than that at once. */
const limitPieces = (page, side) =>
    page.evaluate((most) => {
        const get = (window.realParameter ??= WebGL2RenderingContext.prototype.getParameter);
        WebGL2RenderingContext.prototype.getParameter = function (name) {
            return name === this.MAX_TEXTURE_SIZE ? most : get.call(this, name);
        };
    }, side);
/** As if the canvas held no more columns than that, whatever it is asked for. */
const limitCanvas = (page, columns) =>
    page.evaluate((most) => {
        const own = (window.realWidth ??= Object.getOwnPropertyDescriptor(WebGL2RenderingContext.prototype, 'drawingBufferWidth'));
        Object.defineProperty(WebGL2RenderingContext.prototype, 'drawingBufferWidth', {
            ...own,
            get() {
                return Math.min(most, own.get.call(this));
            },
        });
    }, columns);
const isPng = (file) => file.subarray(-8, -4).toString('latin1') === 'IEND';
const notice = (page, text) => page.getByRole('alert').filter({ hasText: text }).first();

describe('pictures larger than the graphics system draws at once', () => {
    let page, complaints;
    before(async () => {
        ({ page, complaints } = await openTown());
        await wantSize(page, 500, 375);
    });
    after(() => page.close());

    test('are, point by point, those drawn in one piece', async () => {
        const base = { sizePixels: 4, shape: 'circle', detail: { mode: 'discrete' }, splats: { enabled: false } };
        const looks = [
            {},
            { splats: { enabled: true } },
            { delayedExpansion: 'on', shape: 'square', edl: { radiusPixels: 6 } },
            { sizeMode: 'adaptive', shape: 'paraboloid', detail: { mode: 'continuous' } },
        ];
        for (const look of looks) {
            await style(page, { ...base, ...look });
            await settle(page);
            const before = await readPixels(page);
            await limitPieces(page, 4096);
            const whole = await pictureOf(page);
            await limitCanvas(page, 499);
            assert.equal(Buffer.compare((await pictureOf(page)).rgba, whole.rgba), 0, 'the canvas is too small');
            await limitCanvas(page, 1e9);
            await limitPieces(page, 200);
            const parts = await pictureOf(page);
            assert.deepEqual([parts.width, parts.height], [500, 375]);
            assert.equal(Buffer.compare(parts.rgba, whole.rgba), 0, JSON.stringify(look));
            await settle(page);
            assert.equal(Buffer.compare((await readPixels(page)).rgba, before.rgba), 0);
        }
        assert.deepEqual(complaints, []);
    });

    test('go to the disk as they come; given up or failed, they leave nothing, and the page says so', async () => {
        const expected = await pictureOf(page);
        await answerPicker(page);
        await button(page, 'Picture').click();
        const kept = await pixelsOf(await waitForPicked(page, 'picture.png', isPng));
        assert.equal(Buffer.compare(kept.rgba, expected.rgba), 0);

        await page.evaluate(async () => (await navigator.storage.getDirectory()).removeEntry('picture.png'));
        await answerPicker(page, 20_000);
        await button(page, 'Picture').click();
        await notice(page, 'The disk is full. Nothing of it was kept.').waitFor();
        assert.equal(await pickedFile(page, 'picture.png'), null);

        await answerPicker(page);
        await wantSize(page, 6000, 4500);
        await button(page, 'Picture').click();
        await page.getByRole('button', { name: /^Give up \(/ }).click();
        await notice(page, 'picture.png was given up').waitFor();
        assert.equal(await pickedFile(page, 'picture.png'), null);
        await button(page, 'Picture').waitFor();
        await wantSize(page, 500, 375);
        assert.equal(Buffer.compare((await pictureAgain()).rgba, expected.rgba), 0);
        assert.deepEqual(complaints, []);
    });

    async function pictureAgain() {
        await button(page, 'Picture').click();
        return pixelsOf(await waitForPicked(page, 'picture.png', isPng));
    }
});

describe('camera paths', () => {
    async function setUp(page) {
        await button(page, 'Add this view').click();
        for (const view of ['Front', 'Side']) {
            await button(page, view).click();
            await settle(page);
            await button(page, 'Add this view').click();
        }
        await page.getByLabel('Seconds to View 2').fill('0.4');
        await page.getByLabel('Seconds to View 2').press('Tab');
        await page.getByLabel('Seconds to View 3').fill('0.6');
        await page.getByLabel('Seconds to View 3').press('Tab');
    }
    const saved = async (page) => JSON.parse(await downloaded(page, () => button(page, 'Save').click()));

    test('play from view to view, are saved, and are the same in a new browser', async () => {
        const { page, complaints } = await openTown();
        await setUp(page);
        const { cameraPath } = await saved(page);
        assert.deepEqual(cameraPath.map(({ seconds }) => seconds), [2, 0.4, 0.6]);
        const time = page.getByRole('slider', { name: 'Time', exact: true });
        for (const [seconds, index] of [[0, 0], [0.4, 1], [1, 2]]) {
            await time.fill(String(seconds));
            assert.deepEqual(await cameraOf(page), cameraPath[index].camera);
        }
        await time.fill('0');
        await page.evaluate(() => {
            window.seen = [];
            const look = () => {
                window.seen.push(window.stipple.camera().position);
                requestAnimationFrame(look);
            };
            look();
        });
        await button(page, 'Play').click();
        await button(page, 'Play').waitFor(); // it has ended
        assert.deepEqual(await cameraOf(page), cameraPath[2].camera);
        const seen = await page.evaluate(() => window.seen);
        const different = new Set(seen.map(String));
        assert.ok(different.size >= 3, `${different.size} positions`);
        for (const axis of [0, 1, 2]) {
            const values = cameraPath.map(({ camera }) => camera.position[axis]);
            for (const position of seen)
                assert.ok(position[axis] >= Math.min(...values) && position[axis] <= Math.max(...values));
        }
        await keepScreenshot(page, 'film');

        const scene = await saved(page), path = join(folder.path, 'scene.json');
        await writeFile(path, JSON.stringify(scene));
        const other = await launch();
        try {
            const { page: again } = await openPage(other, size);
            await again.goto(server.address);
            await settleWithPoints(again);
            await again.locator('stipple-scene input[type=file]').setInputFiles(path);
            await again.locator('[data-keyframe="2"]').waitFor();
            await settle(again);
            assert.deepEqual(await saved(again), scene);
            await again.getByRole('slider', { name: 'Time', exact: true }).fill('0.2');
            await time.fill('0.2');
            assert.deepEqual(await cameraOf(again), await cameraOf(page));
        } finally {
            await other.close();
        }
        assert.deepEqual(complaints, []);
        await page.close();
    });

    test('are written as pictures, each with all that it shows', async () => {
        const { page, complaints } = await openTown();
        await style(page, { sizePixels: 3, shape: 'square' });
        await setUp(page);
        const { cameraPath } = await saved(page);
        await wantSize(page, 320, 240);
        await page.getByLabel('Pictures a second').fill('5');
        await page.getByLabel('Pictures a second').press('Tab');
        const before = await cameraOf(page);
        const zip = await downloaded(page, () => button(page, 'Write the pictures').click());
        const frames = storedEntries(zip);
        assert.deepEqual([...frames.keys()], Array.from({ length: 6 }, (_, i) => `frame_0000${i}.png`));
        assert.deepEqual(await cameraOf(page), before);
        for (const [name, index] of [['frame_00000.png', 0], ['frame_00002.png', 1], ['frame_00005.png', 2]]) {
            const frame = await pixelsOf(frames.get(name));
            assert.deepEqual([frame.width, frame.height], [320, 240]);
            await page.evaluate((camera) => window.stipple.setCamera(camera), cameraPath[index].camera);
            await settle(page);
            const picture = await pictureOf(page);
            assert.equal(Buffer.compare(frame.rgba, picture.rgba), 0, `${name} is not what the view shows`);
        }

        // The same on the disk, also of frames in parts.
        for (const side of [4096, 100]) {
            await limitPieces(page, side);
            await answerPicker(page);
            await button(page, 'Write the pictures').click();
            const kept = storedEntries(await waitForPicked(page, 'frames.zip', (file) => file.subarray(-22, -18).toString('latin1') === 'PK\x05\x06'));
            assert.deepEqual([...kept.keys()], [...frames.keys()]);
            for (const [name, frame] of kept)
                assert.equal(Buffer.compare((await pixelsOf(frame)).rgba, (await pixelsOf(frames.get(name))).rgba), 0, name);
            await page.evaluate(async () => (await navigator.storage.getDirectory()).removeEntry('frames.zip'));
        }
        assert.deepEqual(complaints, []);
        await page.close();
    });

    test('are shown with their own sides while they are written', async () => {
        const { page } = await openTown();
        await style(page, { sizePixels: 3, shape: 'square', background: [255, 0, 0] });
        await setUp(page);
        await wantSize(page, 200, 600);
        await page.getByLabel('Pictures a second').fill('60');
        await page.getByLabel('Pictures a second').press('Tab');
        /** From the first column of the page that shows the picture's background to the last. */
        const redColumns = async () => {
            const path = join(folder.path, 'page.png');
            await page.screenshot({ path, caret: 'initial' });
            const { width, rgba } = await readPng(path);
            let [first, last] = [width, 0];
            for (let i = 0; i < rgba.length / 4; i++) {
                if (rgba[4 * i] < 250 || rgba[4 * i + 1] > 5 || rgba[4 * i + 2] > 5) continue;
                first = Math.min(first, i % width);
                last = Math.max(last, i % width);
            }
            return last + 1 - first;
        };
        const { width, height } = await page.locator('canvas').first().boundingBox(), before = await redColumns();
        assert.ok(before > width / 2, `${before} of ${width} pixels`);
        await button(page, 'Write the pictures').click();
        await page.getByRole('button', { name: /^Give up/ }).waitFor();
        const narrow = await redColumns();
        assert.ok(narrow > 0 && narrow <= height / 3 + 1, `${narrow} of ${width} pixels`);
        await page.getByRole('button', { name: /^Give up/ }).click();
        await button(page, 'Write the pictures').waitFor();
        assert.equal(await redColumns(), before);
        await page.close();
    });
});

describe('the JSON Schema of scenes', () => {
    let validate, scene;
    before(async () => {
        const schema = await (await fetch(new URL('scene.schema.json', server.address))).json();
        validate = new Ajv({ strict: true, strictRequired: false, strictTypes: false, allErrors: true }).compile(schema);
        const { page } = await openTown();
        await button(page, 'Add this view').click();
        await style(page, {
            colourMode: 'mix', mix: [{ colourMode: 'rgb' }, { colourMode: 'elevation', weight: 0.5 }], hiddenClasses: [5],
            filters: [{ attribute: 'Return Number', min: null, max: 3 }], edl: { strength: 0.7 }, elevationRange: [1, 2],
            clipBoxes: [{ mode: 'highlight', centre: [1, 2, 3], halfSize: [4, 5, 6] }], background: [1, 2, 3],
            clipRegions: [
                { mode: 'hideInside', region: { polygon: [[0, 0], [9, 0], [0, 9]], holes: [[[1, 1], [2, 1], [1, 2]]], heights: [null, 4] } },
                { mode: 'highlight', region: { line: [[0, 0], [9, 0]], width: 2 } },
                { mode: 'hideInside', region: { prism: { eye: null, forward: [0, 0, -1], corners: [[0, 0, 9], [4, 0, 9], [0, 4, 9]] } } },
            ],
        });
        await button(page, 'Distance').click();
        for (const [i, x] of [430, 500].entries()) {
            await page.locator('canvas').click({ position: { x, y: 290 }, force: true });
            await page.waitForFunction((n) => window.stipple.measurements().at(-1)?.points.length === n, i + 1);
        }
        await page.keyboard.press('Enter');
        scene = JSON.parse(await downloaded(page, () => button(page, 'Save').click()));
        await page.close();
    });

    test('is published beside the page, and saved scenes are valid', () => {
        assert.ok(validate(scene), JSON.stringify(validate.errors));
        assert.equal(scene.measurements.length, 1);
        assert.equal(scene.cameraPath.length, 1);
        assert.ok(validate({ stipple: 'scene', version: 1 }));
    });

    test('refuses what the page refuses, but for what a schema can\'t say', async () => {
        const point = { integers: [1, 2, 3], position: [0, 0, 0], scale: [1, 1, 1], offset: [0, 0, 0] };
        const annotation = { id: 1, position: [0, 0, 0] };
        const camera = { position: [0, 0, 5] };
        const refused = [
            [],
            { type: 'FeatureCollection' },
            { ...scene, version: 99 },
            { ...scene, colour: 'red' },
            { ...scene, clouds: [{ address: 'javascript:alert(1)', name: 'x' }] },
            { ...scene, clouds: [{ address: 'data:text/html,x', name: 'x' }] },
            { ...scene, clouds: [{ name: 'x' }] },
            { ...scene, clouds: [{ address: 'a', file: 'b' }] },
            { ...scene, camera: { position: ['a', 0, 0] } },
            { ...scene, camera: { fovYDegrees: 500 } },
            { ...scene, style: { sizePixels: -3 } },
            { ...scene, style: { nonsense: 1 } },
            { ...scene, style: { colourMode: 'attribute' } },
            { ...scene, style: { filters: [{ min: 1 }] } },
            { ...scene, style: { hiddenClasses: [256] } },
            { ...scene, style: { clipBoxes: [{ halfSize: [-1, 1, 1] }] } },
            { ...scene, style: { clipRegions: [{ mode: 'hideInside' }] } },
            { ...scene, style: { clipRegions: [{ region: {} }] } },
            { ...scene, style: { clipRegions: [{ region: { polygon: [[0, 0], [1, 1]] } }] } },
            { ...scene, style: { clipRegions: [{ region: { line: [[0, 0], [1, 1]] } }] } },
            { ...scene, style: { clipRegions: [{ region: { holes: [[[0, 0], [1, 1], [1, 0]]] } }] } },
            { ...scene, style: { clipRegions: [{ region: { prism: { corners: [[0, 0], [1, 1], [1, 0]] } } }] } },
            { ...scene, style: { edl: { neighbours: 5 } } },
            { ...scene, limits: { pointBudget: 'all' } },
            { ...scene, limits: { pointBudget: 0 } },
            { ...scene, measurements: [{ kind: 'weight', points: [point] }] },
            { ...scene, measurements: [{ kind: 'distance', points: [point] }] },
            { ...scene, measurements: [{ kind: 'height', points: [point, point, point] }] },
            { ...scene, measurements: [{ kind: 'point', points: [{ ...point, scale: [0, 1, 1] }] }] },
            { ...scene, measurements: [{ kind: 'point', points: [{ ...point, integers: [0.5, 1, 1] }] }] },
            { ...scene, annotations: [{ ...annotation, id: 0 }] },
            { ...scene, annotations: [{ ...annotation, position: [1, 2] }] },
            { ...scene, annotations: [{ ...annotation, text: 7 }] },
            { ...scene, cameraPath: [{ camera, seconds: 0 }] },
            { ...scene, cameraPath: [{ camera: { position: [1] }, seconds: 1 }] },
            { ...scene, cameraPath: 'around' },
            { ...scene, profile: 'through the church' },
            { ...scene, profile: { line: [[0, 0, 0]] } },
            { ...scene, profile: { line: [[0, 0, 0], [1, 2]] } },
            { ...scene, profile: { line: [[0, 0, 0], [1, 2, 3]], width: 0 } },
            { ...scene, profile: { line: [[0, 0, 0], [1, 2, 3]], exaggeration: 1000 } },
            { ...scene, profile: { line: [[0, 0, 0], [1, 2, 3]], colour: 'red' } },
            { ...scene, legend: 'yes' },
        ];
        // What the page refuses beyond the schema; its description lists it.
        const beyond = [
            { ...scene, style: { filters: [{ attribute: 'Intensity', min: 2, max: 1 }] } },
            { ...scene, style: { elevationRange: [2, 1] } },
            { ...scene, style: { clipBoxes: [{ axes: [[1, 0, 0], [1, 0, 0], [0, 0, 1]] }] } },
            { ...scene, style: { clipRegions: [{ region: { heights: [2, 1] } }] } },
            { ...scene, annotations: [annotation, annotation] },
            { ...scene, annotations: [{ ...annotation, parent: 9 }] },
            { ...scene, cameraPath: [{ camera, seconds: 1 }, { camera: { ...camera, projection: 'orthographic' }, seconds: 1 }] },
        ];
        for (const wrong of refused) assert.ok(!validate(wrong), `the schema lets ${JSON.stringify(wrong).slice(-200)} pass`);
        for (const wrong of beyond) assert.ok(validate(wrong), `the schema refuses it by now: ${JSON.stringify(validate.errors)}`);

        const { page } = await openTown();
        const unchanged = await downloaded(page, () => button(page, 'Save').click());
        for (const wrong of [...refused, ...beyond]) {
            const path = join(folder.path, 'wrong.json');
            await writeFile(path, JSON.stringify(wrong));
            await page.locator('stipple-scene input[type=file]').setInputFiles(path);
            await page.getByRole('alert').first().waitFor();
            while ((await page.getByRole('alert').count()) > 0) await page.getByRole('button', { name: 'Dismiss' }).first().click();
        }
        assert.equal(String(await downloaded(page, () => button(page, 'Save').click())), String(unchanged));
        await page.close();
    });
});
