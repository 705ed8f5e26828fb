// A scene that uses everything: saved, shown in a new browser from a file and from a link, saved again. It is the same to the letter, and
// so is each picture: the canvas, what lies over it, the profile and the map.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';

import { keepScreenshot, launch, openPage, readPixels, settle } from './support/browser.mjs';
import { makeTown, scratchFolder, serve } from './support/program.mjs';
import { randomFrom } from './support/tool_driver.mjs';

const size = { width: 1280, height: 720 };
let browser, folder, server, scene, link, expected;

before(async () => {
    folder = await scratchFolder();
    const clouds = [await makeTown(folder.path, { points: 60_000 })];
    for (const [name, seed] of [['village', 2], ['wood', 3]]) clouds.push(await makeTown(folder.path, { points: 20_000, seed, name }));
    server = await serve(...clouds);
    browser = await launch();
});
after(async () => {
    await browser?.close();
    await server?.stop();
    await folder?.cleanUp();
});

const button = (page, name) => page.getByRole('button', { name, exact: true });
const camera = (page) => page.evaluate(() => window.stipple.camera());

/** [tool, number of points] */
const tools = [['Distance', 3], ['Height', 2], ['Area', 4], ['Angle', 3], ['Circle', 3], ['Azimuth', 2], ['Point', 1], ['Volume', 3], ['Volume', 3]];

/** Four places around the middle of the picture where there are points. */
function ringOf(page) {
    return page.evaluate(async () => {
        const found = [];
        for (const [sx, sy] of [[-1, -1], [1, -1], [1, 1], [-1, 1]])
            for (let d = 110; d > 10; d -= 10) {
                const at = [innerWidth / 2 + 40 + sx * d, innerHeight / 2 - 60 + sy * 0.6 * d];
                if (!(await window.stipple.pick(...at, 4))) continue;
                found.push(at);
                break;
            }
        return found;
    });
}

async function measureAll(page) {
    const ring = await ringOf(page);
    assert.equal(ring.length, 4);
    let done = 0, clicks = 0; // never twice at one place, which would be a double click
    for (const [tool, count] of tools) {
        await button(page, tool).click();
        for (let i = 0; i < count; i++) await page.mouse.click(...ring[clicks++ % 4]);
        await page.keyboard.press('Enter');
        await page.waitForFunction(([n, points]) => window.stipple.measurements()[n]?.points.length === points, [done++, count]);
    }
    await page.getByLabel('Unit').selectOption({ label: 'Feet' });
    await page.locator('[data-measurement=volume] select').last().selectOption({ label: 'A level plane' });
    await button(page, 'Hide Area 1').click();
    await volumesAreThere(page);
}
const volumesAreThere = (page) =>
    page.waitForFunction(() => window.stipple.measurements().filter(({ kind, answer, share }) => kind === 'volume' && answer && share === undefined).length === 2);

/** Three: with a view and a text, one of another up to a distance, one of another and hidden. */
async function annotate(page) {
    const view = await camera(page), { target } = view;
    return [
        { id: 1, parent: 0, title: 'Church', text: '# Nave\n\nBuilt **1250** <script>window.hacked = 1</script>', position: target, camera: view, hidden: false, maxDistance: 0 },
        { id: 2, parent: 1, title: 'Tower', text: '', position: target.map((v, i) => v + [10, 5, 8][i]), hidden: false, maxDistance: 1e6 },
        { id: 7, parent: 1, title: 'Crypt', text: '', position: target.map((v, i) => v - [10, 5, 8][i]), hidden: true, maxDistance: 0 },
    ];
}

async function setUp(page) {
    for (const name of ['village', 'wood']) {
        await page.getByRole('button', { name: new RegExp(`^${name} `) }).click();
        await page.getByRole('checkbox', { name: `Show ${name}` }).waitFor();
        await settle(page);
    }
    await page.getByRole('checkbox', { name: 'Show wood' }).uncheck();
    await button(page, 'town').click(); // flies there
    await page.waitForTimeout(1200);
    await page.evaluate(() => window.stipple.setStyle({ sizePixels: 5, shape: 'square' }));
    await settle(page);
    await measureAll(page);
    await button(page, 'Profile').click();
    await page.getByText(/points, complete/).waitFor();
    await page.getByLabel('Width of the profile').fill('9.5');
    await page.getByLabel('Width of the profile').press('Tab');
    await page.getByLabel('Exaggeration of heights').fill('2');
    await page.getByLabel('Exaggeration of heights').press('Tab');
    for (const key of ['Shift+ArrowLeft', 'ArrowDown', '+']) {
        await button(page, 'Add this view').click();
        await page.locator('canvas').first().press(key);
    }
    await button(page, 'Map').click();
    await page.getByRole('radio', { name: 'Move: Fly' }).check({ force: true });
    await page.evaluate(() => {
        const { target } = window.stipple.camera(), turned = Math.SQRT1_2;
        const axes = [[turned, turned, 0], [-turned, turned, 0], [0, 0, 1]];
        const at = (x, y) => [target[0] + x, target[1] + y];
        const ring = ([x, y], r) => [[x - r, y - r], [x + r, y - r], [x + r / 2, y], [x + r, y + r], [x - r, y + r]];
        window.stipple.setStyle({
            colourMode: 'mix',
            mix: [{ colourMode: 'rgb' }, { colourMode: 'elevation', weight: 0.5 }, { colourMode: 'attribute', attribute: 'Intensity', weight: 0.2 }],
            gradient: 'turbo',
            elevationRange: [0, 40],
            sizeMode: 'adaptive',
            sizeSpacings: 1.5,
            maxSizePixels: 12,
            shape: 'paraboloid',
            splats: { enabled: true },
            edl: { strength: 0.7, radiusPixels: 2 },
            hiddenClasses: [5],
            filters: [{ attribute: 'Return Number', min: null, max: 3 }, { attribute: 'Intensity', min: 1, max: null }],
            clipBoxes: [
                { mode: 'hideOutside', centre: target, halfSize: [120, 120, 90] },
                { mode: 'hideInside', centre: target.map((v, i) => v + [30, 20, 0][i]), halfSize: [8, 12, 40], axes },
                { mode: 'highlight', centre: target.map((v, i) => v - [30, 20, 0][i]), halfSize: [15, 15, 40] },
            ],
            clipRegions: [
                { mode: 'hideOutside', region: { polygon: ring(at(150, 0), 60), holes: [ring(at(150, 0), 20)], heights: [null, target[2] + 200] } },
                { mode: 'hideInside', region: { prism: { eye: null, forward: [0.1, 0, -1], corners: ring(at(-60, -60), 15).map((corner) => [...corner, target[2]]) } } },
                { mode: 'highlight', region: { line: [at(-80, 60), at(0, 80), at(80, 60)], width: 12, heights: [target[2] - 100, null] } },
            ],
            highlight: [255, 0, 200],
            background: [40, 50, 60],
        });
        window.stipple.setLimits({ pointBudget: 90_000, minNodePixels: 40 });
    });
    await settle(page);
}

async function saved(page) {
    const [download] = await Promise.all([page.waitForEvent('download'), button(page, 'Save').click()]);
    return JSON.parse(await readFile(await download.path(), 'utf8'));
}
async function load(page, what) {
    const path = join(folder.path, 'scene.json');
    await writeFile(path, JSON.stringify(what));
    await page.locator('stipple-scene input[type=file]').setInputFiles(path);
}

/** All that is seen of a scene, once it is all there. */
async function seen(page) {
    await volumesAreThere(page);
    await page.getByText(/points, complete/).waitFor();
    await page.locator('stipple-map[data-camera]').waitFor();
    await page.waitForTimeout(700); // what is covered is looked at when the camera has rested, and nothing is drawn by that
    await settle(page);
    const drawnFrames = async () => (await page.evaluate(() => window.stipple.counters())).session.framesDrawn;
    for (let before = -1; before !== (await drawnFrames()); await page.waitForTimeout(500)) before = await drawnFrames();
    const hash = (bytes) => createHash('sha256').update(bytes).digest('hex');
    const withoutMarks = (text) => text.replace(/<!--.*?-->/gs, ''); // the browser's run has its own
    const overlays = {};
    for (const name of ['measure', 'clip', 'annotation'])
        overlays[name] = withoutMarks(await page.locator(`stipple-${name}-overlay`).evaluate((element) => element.shadowRoot.innerHTML));
    const drawn = (selector) => page.locator(selector).evaluateAll((list) => list.map((canvas) => canvas.toDataURL()));
    const axes = withoutMarks(await page.locator('stipple-profile svg').innerHTML());
    return {
        picture: hash((await readPixels(page)).rgba),
        overlays,
        profile: hash(String(await drawn('stipple-profile canvas'))),
        axes,
        map: hash(String(await drawn('stipple-map canvas'))),
        points: await page.locator('stipple-profile [role=status]').first().getAttribute('data-points'),
        answers: (await page.evaluate(() => window.stipple.measurements())).map(({ kind, name, answer }) => ({ kind, name, answer })),
    };
}

/** Sums of a volume come in the order in which its points came. */
function assertSame(found, wanted) {
    const { answers, ...rest } = found, { answers: right, ...others } = wanted;
    assert.deepEqual(rest, others);
    assert.equal(answers.length, right.length);
    answers.forEach(({ answer, ...item }, i) => {
        assert.deepEqual(item, { kind: right[i].kind, name: right[i].name });
        if (item.kind !== 'volume') return assert.deepEqual(answer, right[i].answer);
        for (const [field, value] of Object.entries(right[i].answer))
            assert.ok(value === answer[field] || Math.abs(answer[field] / value - 1) < 1e-9, `${field}: ${answer[field]} and ${value}`);
    });
}

describe('a scene that uses everything', () => {
    test('is set up, and shown from its file', async () => {
        const { page, complaints } = await openPage(browser, size);
        await page.goto(server.address);
        await settle(page);
        await setUp(page);
        const first = await saved(page);
        scene = { ...first, annotations: await annotate(page) };
        await load(page, scene); // what it shows already stays open
        await page.waitForFunction(() => window.stipple.annotations().length === 3);
        expected = await seen(page);
        assert.deepEqual(await saved(page), scene);
        await button(page, 'Link').click();
        link = await page.getByLabel('Link to this scene').inputValue();
        console.log(`  link: ${link.length} characters, file: ${JSON.stringify(scene).length} bytes`);
        // Everything is in it.
        assert.equal(scene.clouds.length, 3);
        assert.deepEqual(new Set(scene.measurements.map(({ kind }) => kind)).size, 8);
        assert.deepEqual(scene.style.clipBoxes.map(({ mode }) => mode), ['hideOutside', 'hideInside', 'highlight']);
        assert.deepEqual(scene.style.clipRegions.map(({ region }) => ['polygon', 'prism', 'line'].find((kind) => kind in region)), ['polygon', 'prism', 'line']);
        assert.equal(scene.cameraPath.length, 3);
        assert.equal(scene.profile.width, 9.5);
        assert.equal(scene.profile.exaggeration, 2);
        assert.equal(scene.map, true);
        await keepScreenshot(page, 'everything');
        assert.deepEqual(complaints, []);
        await page.close();
    });

    for (const way of ['file', 'link'])
        test(`is the same in a new browser, from a ${way}`, async () => {
            const other = await launch();
            try {
                const { page, complaints } = await openPage(other, size);
                await page.goto(way === 'link' ? link : server.address);
                await settle(page);
                if (way === 'file') await load(page, scene);
                assertSame(await seen(page), expected);
                assert.deepEqual(await saved(page), scene);
                assert.equal(await page.evaluate(() => window.hacked), undefined);
                assert.deepEqual(complaints, []);
            } finally {
                await other.close();
            }
        });

    test('damaged anywhere, it is shown or refused by a sentence that names the place, and runs no script', async () => {
        const { page, complaints } = await openPage(browser, size);
        await page.goto(server.address);
        await settle(page);
        await page.evaluate((text) => document.querySelector('stipple-viewer').setScene(text), JSON.stringify(scene));
        await seen(page);
        const before = await saved(page);
        const answers = await page.evaluate((texts) => {
            const viewer = document.querySelector('stipple-viewer');
            return texts.map((text) => {
                const wasThere = JSON.stringify(viewer.getScene());
                try {
                    viewer.setScene(text);
                    return {};
                } catch (error) {
                    return { kind: error.constructor.name, message: error.message, isUnchanged: JSON.stringify(viewer.getScene()) === wasThere };
                }
            });
        }, damaged(scene, 250).map(({ text }) => text));
        const refused = answers.filter(({ message }) => message);
        console.log(`  ${refused.length} of ${answers.length} were refused, in ${new Set(refused.map(({ message }) => message)).size} ways`);
        assert.ok(refused.length > 100 && refused.length < answers.length);
        for (const { kind, message, isUnchanged } of refused) {
            assert.ok(kind === 'Error' || kind === 'Problem', `${kind}: ${message}`);
            assert.ok(message.length > 10 && !/undefined|NaN|\[object|Cannot read|is not a function/.test(message), message);
            assert.ok(isUnchanged, `changed by what was refused: ${message}`);
        }
        assert.equal(await page.evaluate(() => window.hacked), undefined);
        await page.evaluate((text) => document.querySelector('stipple-viewer').setScene(text), JSON.stringify(scene));
        assertSame(await seen(page), expected);
        assert.deepEqual(await saved(page), before);
        assert.deepEqual(complaints.filter((text) => !/404|Failed to load/.test(text)), []);
        await page.close();
    });
});

/** Copies in each of which one value, anywhere, is another, gone, or in the wrong place. */
function damaged(scene, count) {
    const random = randomFrom(11), places = [];
    const walk = (value, path) => {
        if (path.length > 0) places.push(path);
        if (value && typeof value === 'object') for (const [name, part] of Object.entries(value)) walk(part, [...path, name]);
    };
    walk(scene, []);
    const script = '<img src=x onerror="window.hacked=1">';
    const others = [null, true, 0, -1, 0.5, 1e308, '', script, 'javascript:window.hacked=1', [], {}, [1, 2, 3], [[]], { __proto__: null, constructor: 1 }];
    return Array.from({ length: count }, () => {
        const copy = structuredClone(scene), path = places[random(places.length)];
        const parent = path.slice(0, -1).reduce((at, name) => at[name], copy), name = path.at(-1);
        const kind = random(8), other = others[random(others.length)];
        if (kind === 0) delete parent[name];
        else if (kind === 1) parent[`${name}x`] = parent[name];
        else if (kind === 2 && Array.isArray(parent)) parent.push(parent[name], parent[name]);
        else parent[name] = other;
        return { path, text: JSON.stringify(copy) };
    });
}
