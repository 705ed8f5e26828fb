// The appearance panel: counts of what is in view against every point of the file, handles by mouse, touch and keyboard, the
// legend, filters, a range that follows the view.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { readFile } from 'node:fs/promises';
import { after, before, describe, test } from 'node:test';

import { counters, keepScreenshot, settle, unless } from './support/browser.mjs';
import { stipple } from './support/program.mjs';
import { cross, dot, minus, norm, openTownPage } from './support/town_page.mjs';

let page, complaints, folder, close, points;

before(async () => {
    ({ page, complaints, folder, close } = await openTownPage({ width: 900, height: 640 }));
    const csv = join(folder, 'town.csv');
    await stipple('export', join(folder, 'town.stipple'), '-o', csv);
    points = parseCsv(await readFile(csv, 'utf8'));
});
after(() => close?.());

/** Columns by name, as numbers. */
function parseCsv(text) {
    const [head, ...rows] = text.trim().split(/\r?\n/);
    const names = head.split(',').map((name) => name.replaceAll('"', '').toLowerCase());
    const read = (row) => Object.fromEntries(row.split(',').map((value, at) => [names[at], Number(value)]));
    // Heights as the cloud's grid has them: a product of its step, not the nearest double of the decimals.
    return rows.map(read).map((point) => ({ ...point, z: Math.round(point.z * 1000) * 0.001 }));
}

/** Pinhole arithmetic of its own, with the points in the picture. */
async function inView() {
    const camera = await page.evaluate(() => window.stipple.camera());
    const { width, height } = await page.locator('canvas').evaluate((canvas) => ({ width: canvas.width, height: canvas.height }));
    const scaled = (v, s) => v.map((x) => x * s);
    const forward = scaled(minus(camera.target, camera.position), 1 / norm(minus(camera.target, camera.position)));
    const side = cross(forward, camera.up), right = scaled(side, 1 / norm(side)), up = cross(right, forward);
    const slope = Math.tan((camera.fovYDegrees * Math.PI) / 360);
    return points.filter(({ x, y, z }) => {
        const from = minus([x, y, z], camera.position), depth = dot(from, forward);
        return depth > 0 && Math.abs(dot(from, up)) < depth * slope && Math.abs(dot(from, right)) < (depth * slope * width) / height;
    });
}

const field = (label) => page.locator(`[data-histogram="${label}"]`);
const bars = (label) => field(label).locator('rect').evaluateAll((all) => all.map((bar) => Number(bar.dataset.count)));
const handle = (label, end) => page.getByRole('slider', { name: `${label}: ${end}` });
const valueOf = async (slider) => Number(await slider.getAttribute('aria-valuenow'));
const styleOf = () => page.evaluate(() => window.stipple.style());

/** Everything is drawn, and as many points are counted as are in view. */
async function countedAs(label, expected) {
    await page.waitForFunction(
        ([name, count]) => {
            const find = (root) => {
                for (const element of root.querySelectorAll('*')) {
                    if (element.dataset?.histogram === name) return element;
                    const inside = element.shadowRoot && find(element.shadowRoot);
                    if (inside) return inside;
                }
            };
            return Number(find(document)?.dataset.points) === count;
        },
        [label, expected],
    );
}

async function lookInside() {
    await page.evaluate(() => {
        window.stipple.setLimits({ minNodePixels: 1 });
        const { position, target } = window.stipple.camera();
        const near = position.map((value, axis) => target[axis] + 0.45 * (value - target[axis]));
        window.stipple.setCamera({ position: near });
    });
    const { frame } = await settle(page);
    return frame;
}

describe('the appearance panel', () => {
    test('the histogram of heights is that of the file, point by point', async () => {
        await lookInside();
        await page.getByLabel('Colour by').selectOption('elevation');
        await settle(page);
        await field('Colours').scrollIntoViewIfNeeded();
        const seen = await inView();
        assert.ok(seen.length > 20_000 && seen.length < points.length, `${seen.length} of ${points.length}`);
        await countedAs('Colours', seen.length);
        const counts = await bars('Colours');
        const heights = seen.map(({ z }) => z), least = Math.min(...heights), most = Math.max(...heights);
        const expected = new Array(counts.length).fill(0);
        for (const z of heights)
            expected[Math.min(counts.length - 1, Math.floor(((z - least) / (most - least)) * counts.length))]++;
        assert.deepEqual(counts, expected);
    });

    test('handles set the range: mouse, touch and keyboard', { skip: unless('touch') }, async () => {
        const least = handle('Colours', 'least'), most = handle('Colours', 'greatest');
        // What the field spans now.
        const span = async () => [Number(await least.getAttribute('aria-valuemin')), Number(await most.getAttribute('aria-valuemax'))];
        const at = ([low, high], part) => low + part * (high - low);
        const range = async () => (await styleOf()).elevationRange;
        const box = await field('Colours').boundingBox(), from = await least.boundingBox();
        const whole = await span();
        await page.mouse.move(from.x + from.width / 2, from.y + 20);
        await page.mouse.down();
        await page.mouse.move(box.x + box.width * 0.25, from.y + 20, { steps: 4 });
        await page.mouse.up();
        const [dragged] = await range();
        assert.ok(Math.abs(dragged - at(whole, 0.25)) < 0.005 * (whole[1] - whole[0]), `${dragged} in ${whole}`);

        await most.focus();
        await page.keyboard.press('Home'); // no further than the other handle
        assert.ok((await range())[1] - dragged < 1e-3);
        await page.keyboard.press('End');
        const ended = await span();
        await page.keyboard.press('ArrowLeft');
        const [, stepped] = await range();
        assert.ok(Math.abs(stepped - at(ended, 0.99)) < 1e-6, `${stepped} in ${ended}`);
        await page.keyboard.press('PageDown');
        assert.ok((await range())[1] < stepped);
        assert.equal(await valueOf(most), (await range())[1]);

        // A finger, as the browser's own protocol has it.
        const client = await page.context().newCDPSession(page);
        const finger = await most.boundingBox(), y = finger.y + 20, touched = await span();
        const touch = (type, x) =>
            client.send('Input.dispatchTouchEvent', { type, touchPoints: type === 'touchEnd' ? [] : [{ x, y }] });
        await touch('touchStart', finger.x + finger.width / 2);
        await touch('touchMove', box.x + box.width * 0.6);
        await touch('touchEnd');
        const [, moved] = await range();
        assert.ok(Math.abs(moved - at(touched, 0.6)) < 0.01 * (touched[1] - touched[0]), `${moved} in ${touched}`);

        await most.focus();
        await page.keyboard.press('Delete');
        assert.equal(await range(), null);
    });

    test('classes say how many of their points are in view', async () => {
        await page.getByLabel('Colour by').selectOption('classification');
        await settle(page);
        const seen = await inView(), expected = {};
        for (const { classification } of seen) expected[classification] = (expected[classification] ?? 0) + 1;
        await page.getByLabel('Class 2: Ground').scrollIntoViewIfNeeded();
        await page.locator(`[data-class="2"][data-in-view="${expected[2]}"]`).waitFor();
        const shown = await page
            .locator('[data-class]')
            .evaluateAll((all) => Object.fromEntries(all.map(({ dataset }) => [dataset.class, Number(dataset.inView)])));
        for (const [name, count] of Object.entries(shown)) assert.equal(count, expected[name] ?? 0, `class ${name}`);
        // A hidden class says still how many it has.
        await page.getByLabel('Class 2: Ground').uncheck();
        await settle(page);
        await page.waitForTimeout(500);
        assert.equal(await page.locator('[data-class="2"]').getAttribute('data-in-view'), String(expected[2]));
        await keepScreenshot(page, 'class_counts');
        await page.getByLabel('Class 2: Ground').check();
        await settle(page);
    });

    test('a filter counts what the others leave, fetches what it counts, and hides what lies outside', async () => {
        await page.getByLabel('Colour by').selectOption('elevation');
        await page.getByLabel('Show by').selectOption('Intensity');
        await settle(page);
        const label = 'Intensity shown';
        await field(label).scrollIntoViewIfNeeded();
        const seen = await inView();
        await countedAs(label, seen.length);
        const least = handle(label, 'least'), [low] = [await valueOf(least)];
        assert.equal(low, Math.min(...seen.map(({ intensity }) => intensity)));
        await least.focus();
        for (let i = 0; i < 3; i++) await page.keyboard.press('PageUp');
        await settle(page);
        const bound = (await styleOf()).filters[0].min;
        assert.ok(bound > low && Number.isInteger(bound));
        // Its own field still counts all; that of the heights what is left.
        await countedAs(label, seen.length);
        await field('Colours').scrollIntoViewIfNeeded();
        await countedAs('Colours', seen.filter(({ intensity }) => intensity >= bound).length);
        assert.ok((await counters(page)).frame.pointsHidden > 0);
        await keepScreenshot(page, 'appearance');
        await page.getByLabel('Show by').selectOption('');
        await settle(page);
    });

    test('a range follows what is in view, until it is set by hand', async () => {
        await page.getByLabel('Colour by').selectOption('intensity');
        await page.getByLabel('Of what is in view').check();
        const expected = async () => {
            const values = (await inView()).map(({ intensity }) => intensity);
            const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
            const deviation = Math.sqrt(values.reduce((sum, value) => sum + (value - mean) ** 2, 0) / values.length);
            return [Math.max(values.reduce((a, b) => Math.min(a, b)), mean - 2 * deviation), Math.min(values.reduce((a, b) => Math.max(a, b)), mean + 2 * deviation)];
        };
        const follows = async () => {
            const wanted = await expected();
            await page.waitForFunction(
                ([a, b]) => {
                    const range = window.stipple.style().intensityRange;
                    return range && Math.abs(range[0] - a) < 1e-6 * (1 + b) && Math.abs(range[1] - b) < 1e-6 * (1 + b);
                },
                wanted,
            );
            return wanted;
        };
        await settle(page);
        const before = await follows();
        await page.evaluate(() => {
            const { position, target } = window.stipple.camera();
            window.stipple.setCamera({ position: position.map((value, axis) => target[axis] + 0.7 * (value - target[axis])) });
        });
        await settle(page);
        assert.notDeepEqual(await follows(), before);
        await handle('Colours', 'least').focus();
        await page.keyboard.press('ArrowRight');
        assert.equal(await page.getByLabel('Of what is in view').isChecked(), false);
        await page.keyboard.press('Delete');
    });

    test('the legend has the values of the drawn range and can be put away', async () => {
        await page.getByLabel('Colour by').selectOption('elevation');
        await page.getByLabel('Range: least').fill('10');
        await page.getByLabel('Range: greatest').fill('30');
        await page.getByLabel('Range: greatest').press('Enter');
        await settle(page);
        const legend = page.locator('stipple-legend');
        await legend.locator('[data-tick="15"]').waitFor();
        const ticks = await legend.locator('[data-tick]').evaluateAll((all) =>
            all.map((tick) => [Number(tick.dataset.tick), Number.parseFloat(tick.style.left)]),
        );
        for (const [value, percent] of ticks) assert.ok(Math.abs(percent - (value - 10) * 5) < 1e-6);
        await page.getByLabel('Legend').uncheck();
        assert.equal(await legend.isVisible(), false);
        await page.getByLabel('Legend').check();
        assert.equal(await legend.isVisible(), true);
        assert.deepEqual(complaints, []);
    });

    test('quality presets set limits and style; only what applies is offered', async () => {
        assert.equal(await page.getByLabel('Quality: Even').isChecked(), false); // the limits were set by hand
        await page.getByLabel('Quality: Fast').check({ force: true });
        const style = await styleOf();
        assert.equal(style.edl.enabled, false);
        await page.getByLabel('Quality: Best').check({ force: true });
        assert.equal((await styleOf()).splats.enabled, true);
        assert.match(await page.getByLabel('Budget').getAttribute('aria-valuetext'), /20M/);
        const offered = await page.getByLabel('Colour by').locator('option').allTextContents();
        const attributes = Object.keys(points[0]);
        assert.equal(offered.includes('GPS time'), attributes.some((name) => /gps.?time/.test(name)));
        assert.equal(await page.getByLabel('Shape: Disc').count(), 0); // this town has no normals
        await page.getByLabel('Quality: Even').check({ force: true });
        assert.equal((await styleOf()).splats.enabled, false);
    });
});
