// Profiles: cut along a line that was measured, complete, equal to the whole cloud's points tested one by one; its own picking,
// measuring and files.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, before, describe, test } from 'node:test';

import { keepScreenshot, unless } from './support/browser.mjs';
import { openTownPage } from './support/town_page.mjs';

let town, page, complaints, line;

before(async () => {
    town = await openTownPage({ width: 1100, height: 720 });
    ({ page, complaints } = town);
    await page.getByRole('button', { name: 'Distance' }).click();
    for (const [i, place] of [{ x: 430, y: 300 }, { x: 620, y: 310 }, { x: 700, y: 400 }].entries()) {
        await page.locator('canvas').first().click({ position: place });
        await page.waitForFunction((n) => window.stipple.measurements().at(-1)?.points.length === n, i + 1);
    }
    await page.keyboard.press('Enter');
    line = (await page.evaluate(() => window.stipple.measurements()))[0].points.map(({ position }) => position);
});

after(() => town?.close());

const panel = () => page.getByRole('complementary', { name: 'Profile' });
const shownPoints = async () => Number(await panel().locator('[data-points]').getAttribute('data-points'));
const complete = () => panel().getByRole('status').filter({ hasText: 'complete' }).waitFor();

async function rowsOf(address) {
    const [head, ...rows] = (await (await fetch(address)).text()).trim().split(/\r?\n/);
    const names = head.split(',');
    return rows.map((row) => Object.fromEntries(row.split(',').map((field, at) => [names[at], Number(field)])));
}

/** Within half the width of the first or the second segment, give or take `slack`; without the mitre between them. */
function within(p, width, slack) {
    return [0, 1].some((i) => {
        const [a, b] = [line[i], line[i + 1]];
        const dx = b[0] - a[0], dy = b[1] - a[1], length = Math.hypot(dx, dy);
        const station = ((p.X - a[0]) * dx + (p.Y - a[1]) * dy) / length;
        const offset = Math.abs((p.X - a[0]) * dy - (p.Y - a[1]) * dx) / length;
        return station >= -slack && station <= length + slack && offset <= width / 2 + slack;
    });
}

describe('profiles', () => {
    test('a profile fills in until it has all points of its corridor', async () => {
        await page.getByRole('button', { name: 'Profile' }).click();
        await complete();
        const width = Number(await page.getByLabel('Width of the profile').inputValue());
        const address = await panel().getByRole('link', { name: 'CSV' }).getAttribute('href');
        const rows = await rowsOf(address);
        assert.equal(await shownPoints(), rows.length);
        const all = await rowsOf(`${address.split('/profile?')[0]}/points?format=csv&attributes=none`);
        const inside = all.filter((p) => within(p, width, -1e-6));
        const text = (p) => `${p.X} ${p.Y} ${p.Z}`;
        const found = new Set(rows.map(text)), missing = inside.filter((p) => !found.has(text(p)));
        const corner = rows.filter((p) => !within(p, width, 1e-6));
        console.log(`  ${rows.length} points, of them ${corner.length} in the corner's mitre`);
        assert.equal(missing.length, 0);
        const turn = line[1];
        for (const p of corner) assert.ok(Math.hypot(p.X - turn[0], p.Y - turn[1]) <= 2 * width, JSON.stringify(p));
        assert.ok(rows.length > 100);
    });

    test('it is coloured by class, height, return and intensity; the picture highlights its corridor, or shows it alone', async () => {
        const choose = (label, option) => panel().getByLabel(label).selectOption({ label: option });
        /** The colours of its pixels, as 'r,g,b', and how high up each first comes. */
        const pixels = async () => {
            await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
            return panel().locator('canvas').evaluate((canvas) => {
                const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d'), found = {};
                copy.drawImage(canvas, 0, 0); // of its own: browsers warn of canvases that are read again and again
                const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
                for (let at = 0; at < data.length; at += 4)
                    if (data[at + 3] > 0) found[data.slice(at, at + 3).join()] ??= Math.floor(at / 4 / canvas.width);
                return found;
            });
        };
        const rows = await rowsOf(await panel().getByRole('link', { name: 'CSV' }).getAttribute('href'));
        const classes = (await page.evaluate(() => window.stipple.clouds()))[0].classes;
        await choose('Colour', 'Classification');
        const there = new Set(rows.map((row) => String(classes.find((one) => one.class === row.Classification).colour)));
        assert.deepEqual(new Set(Object.keys(await pixels())), there);
        await choose('Colour', 'Return number');
        const returns = new Set(rows.map((row) => row['Return Number']));
        assert.equal(Object.keys(await pixels()).length, returns.size);
        await choose('Colour', 'Intensity');
        assert.ok(Object.keys(await pixels()).length > 30);
        await choose('Colour', 'Elevation'); // the gradient's ends are the lowest and the highest points
        const heights = Object.entries(await pixels()).sort((a, b) => a[1] - b[1]);
        const [r, g, b] = heights[0][0].split(',').map(Number);
        assert.ok(r > 200 && g > 200 && b < 90, heights[0][0]); // viridis ends in yellow
        await choose('Colour', 'RGB');

        await page.evaluate(() => window.stipple.setLimits({ minNodePixels: 1, pointBudget: 1_000_000 }));
        const shown = async () => {
            await page.evaluate(() => window.stipple.settled());
            const { frame } = await page.evaluate(() => window.stipple.counters());
            return frame.pointsDrawn - frame.pointsHidden;
        };
        const all = await shown();
        await choose('In the picture', 'Highlight');
        assert.equal(await shown(), all);
        const regions = async () => (await page.evaluate(() => window.stipple.style())).clipRegions;
        assert.equal((await regions())[0].mode, 'highlight');
        await keepScreenshot(page, 'profile');
        await page.locator('canvas').first().focus();
        await page.keyboard.press('f');
        await page.waitForTimeout(1200);
        await choose('In the picture', 'alone');
        assert.equal(await shown(), rows.length);
        await choose('In the picture', 'as it is');
        assert.deepEqual(await regions(), []);
        await choose('In the picture', 'alone');
    });

    test('points are picked and measured in it; dragging, the wheel and the exaggeration move the view', async () => {
        const view = await panel().locator('.view').boundingBox();
        const told = panel().locator('p.told').last();
        const find = async (from, pattern) => {
            for (let x = from; x < view.width - 20; x += 6)
                for (let y = 20; y < view.height - 40; y += 12) {
                    await page.mouse.move(view.x + x, view.y + y);
                    await page.evaluate(() => new Promise(requestAnimationFrame)); // it is told
                    if (pattern.test(await told.textContent())) return { x: view.x + x, y: view.y + y };
                }
            throw new Error('no point was found');
        };
        const first = await find(view.width / 4, /Station/);
        await page.mouse.down();
        await page.mouse.up();
        const marked = await told.textContent();
        await find(view.width / 2, /From the marked point/);
        const text = await told.textContent();
        const numbers = (t) => t.match(/-?\d+\.\d+/g).map(Number);
        const [s1, h1] = numbers(marked), [s2, h2, , , , along, up, apart] = numbers(text);
        assert.ok(Math.abs(along - (s2 - s1)) < 0.0011 && Math.abs(up - (h2 - h1)) < 0.0011);
        assert.ok(Math.abs(apart - Math.hypot(along, up)) < 0.0011);

        const axes = () => panel().locator('svg').innerHTML();
        const before = await axes();
        await page.mouse.move(first.x, first.y);
        await page.mouse.wheel(0, -300);
        await page.waitForTimeout(200);
        const zoomed = await axes();
        assert.notEqual(zoomed, before);
        await page.mouse.down();
        await page.mouse.move(first.x + 80, first.y + 10, { steps: 4 });
        await page.mouse.up();
        await page.waitForTimeout(200);
        assert.notEqual(await axes(), zoomed);
        await page.getByLabel('Exaggeration of heights').fill('3');
        await page.getByLabel('Exaggeration of heights').press('Tab');
        await page.waitForTimeout(200);
        assert.notEqual(await axes(), before);
    });

    test('its width is changed, it is saved as a picture with axes, and closed while it loads', { skip: unless('downloads') }, async () => {
        const before = await shownPoints();
        await page.getByLabel('Width of the profile').fill('12');
        await page.getByLabel('Width of the profile').press('Tab');
        await complete();
        assert.ok((await shownPoints()) > 1.5 * before);
        const [download] = await Promise.all([
            page.waitForEvent('download'),
            panel().getByRole('link', { name: 'SVG' }).click(),
        ]);
        const picture = await readFile(await download.path(), 'utf8');
        assert.match(picture, /<image href="data:image\/png;base64,/);
        assert.ok((picture.match(/<text/g) ?? []).length > 4);
        await page.getByLabel('Width of the profile').fill('40');
        await page.getByLabel('Width of the profile').press('Tab');
        await page.getByRole('button', { name: 'Close the profile' }).click();
        await page.waitForTimeout(500);
        assert.equal(await panel().count(), 0);
        assert.deepEqual((await page.evaluate(() => window.stipple.style())).clipRegions, []);
        assert.deepEqual(complaints, []);
    });
});
