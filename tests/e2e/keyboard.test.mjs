// The whole page without a pointer: a cloud is opened, looked at, measured, cut, clipped and annotated, and the scene saved. Handles of
// measurements and the cursor of a profile go from point to point.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, before, describe, test } from 'node:test';

import { keepScreenshot, launch, openPage, settle, settleWithPoints, unless } from './support/browser.mjs';
import { exactAnswer } from './support/exact_answers.mjs';
import { relativeError } from './support/exact_numbers.mjs';
import { focused, tabTo } from './support/keyboard.mjs';
import { makeTown, scratchFolder, serve } from './support/program.mjs';

let browser, folder, server, page, complaints;

before(async () => {
    folder = await scratchFolder();
    server = await serve(await makeTown(folder.path, { points: 60_000 }), await makeTown(folder.path, { points: 20_000, seed: 2, name: 'village' }));
    browser = await launch();
    ({ page, complaints } = await openPage(browser, { width: 1100, height: 720 }));
    await page.goto(`${server.address}?cloud=`); // none is opened
    await page.waitForFunction(() => window.stipple !== undefined);
    // Nothing in this file may use it.
    page.mouse.click = page.mouse.down = page.mouse.move = () => assert.fail('a pointer was used');
});
after(async () => {
    await browser?.close();
    await server?.stop();
    await folder?.cleanUp();
});

const press = async (...keys) => {
    for (const key of keys) await page.keyboard.press(key);
};
const type = async (text) => {
    await press('ControlOrMeta+a');
    await page.keyboard.type(text);
    await press('Enter');
};
const measurements = () => page.evaluate(() => window.stipple.measurements());
const camera = () => page.evaluate(() => window.stipple.camera());
const said = (pattern) => page.getByRole('status').filter({ hasText: pattern }).first().waitFor({ state: 'attached' });
const isIn = async (tag) => assert.equal((await focused(page)).tag, tag);

/** Takes the point in the middle; the view moves on until there is one. */
async function take(count) {
    for (let tries = 0; tries < 40; tries++) {
        const isThere = await page.evaluate(() => window.stipple.pick(innerWidth / 2, innerHeight / 2));
        if (isThere) {
            await press(' ');
            await page.waitForFunction((n) => window.stipple.measurements().at(-1)?.points.length === n, count);
            return;
        }
        await press('Shift+ArrowUp');
        await settle(page);
    }
    assert.fail('no point comes to the middle');
}

describe('the page by the keyboard alone', () => {
    test('a cloud is opened and looked at', async () => {
        assert.equal((await page.evaluate(() => window.stipple.clouds())).length, 0);
        await tabTo(page, 'town 60K points');
        await press('Enter');
        await settleWithPoints(page);
        await page.waitForTimeout(1000); // the flight there
        await tabTo(page, 'Size');
        await press(...Array.from({ length: 20 }, () => 'PageUp'));
        await press('Escape');
        await isIn('canvas');
        const start = await camera();
        await press('1', 'ArrowLeft', '+', '+');
        await settle(page);
        assert.notDeepEqual((await camera()).position, start.position);
        await press('3', '+', '+');
        await settle(page);
    });

    test('a distance is measured, and its handles go to the next points', async () => {
        await tabTo(page, 'Distance');
        await press('Enter');
        await isIn('canvas');
        await take(1);
        await press('Shift+ArrowLeft', 'Shift+ArrowLeft');
        await settle(page);
        await take(2);
        await press('Enter');
        await said(/^Distance 1: Distance /);
        const before = (await measurements())[0];

        await tabTo(page, 'Point 1 of Distance 1');
        await press('PageDown');
        assert.equal((await focused(page)).name, 'Point 2 of Distance 1');
        let last = before.points[1], x = await handleAt(2);
        for (const [key, axis, sign] of [['ArrowRight', 'x', 1], ['Shift+ArrowRight', 'x', 1], ['ArrowUp', 'y', -1], ['ArrowLeft', 'x', -1]]) {
            await press(key);
            await page.waitForFunction((old) => JSON.stringify(window.stipple.measurements()[0].points[1].point) !== old, JSON.stringify(last.point));
            const [moved] = await measurements(), now = await handleAt(2);
            assert.deepEqual(moved.points[0], before.points[0]);
            assert.ok(sign * (now[axis] - x[axis]) > 0, `${key}: ${JSON.stringify([x, now])}`);
            assert.ok(Math.abs(now[axis] - x[axis]) <= (key.startsWith('Shift') ? 210 : 64), `${key}: ${JSON.stringify([x, now])}`);
            assert.equal((await focused(page)).name, 'Point 2 of Distance 1');
            const { distance } = exactAnswer('distance', moved.points);
            assert.ok(relativeError(moved.answer.distance, distance) <= 1e-15);
            [last, x] = [moved.points[1], now];
        }
        const [{ answer }] = await measurements();
        await said(new RegExp(`^Distance 1: Distance ${answer.distance.toFixed(0).slice(0, -1)}`));
        await keepScreenshot(page, 'handle_by_keys');
        // Beside the cloud there is nothing to go to.
        await press('PageUp');
        assert.equal((await focused(page)).name, 'Point 1 of Distance 1');
        await press('Escape');
        await isIn('canvas');
    });

    async function handleAt(number) {
        const box = await page.getByRole('button', { name: `Point ${number} of Distance 1` }).boundingBox();
        return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
    }

    test('its profile is moved, and a cursor says each point', { skip: unless('Tab beyond the page') }, async () => {
        await tabTo(page, 'Profile');
        await press('Enter');
        await page.getByText(/points, complete/).waitFor();
        await tabTo(page, 'Width of the profile');
        await type('12');
        await page.getByText(/\d{2} points, complete/).waitFor();
        const view = page.getByRole('application', { name: /^Picture of the profile/ });
        const axes = () => view.locator('svg').innerHTML();
        await tabTo(page, await view.getAttribute('aria-label'));
        await press('Home');
        await page.waitForTimeout(50);
        const whole = await axes();
        for (const key of ['ArrowRight', 'ArrowUp', '+', '-']) {
            const before = await axes();
            await press(key);
            await page.waitForTimeout(50);
            assert.notEqual(await axes(), before, key);
        }
        await press('Home');
        await page.waitForTimeout(50);
        assert.equal(await axes(), whole);

        const cursor = page.getByRole('complementary', { name: 'Profile' }).getByRole('status').last();
        const place = async () => (await cursor.textContent()).match(/-?[\d.,]+\d/g)?.map((text) => Number(text.replaceAll(',', '')));
        await press('Shift+ArrowRight');
        await said(/^Station /);
        const [station, height] = await place();
        await press('Enter');
        let last = station;
        for (let i = 0; i < 5; i++) {
            await press('Shift+ArrowRight');
            await page.waitForTimeout(30);
            const [next] = await place();
            assert.ok(next >= last, `${next} after ${last}`);
            last = next;
        }
        assert.ok(last > station);
        assert.match(await cursor.textContent(), /From the marked point/);
        for (let i = 0; i < 5; i++) await press('Shift+ArrowLeft');
        await page.waitForTimeout(30);
        assert.deepEqual((await place()).slice(0, 2), [station, height], 'five on and five back');
        await press('Shift+ArrowUp');
        await page.waitForTimeout(30);
        const [, above] = await place();
        await press('Shift+ArrowDown');
        await page.waitForTimeout(30);
        assert.ok(above >= (await place())[1]);
        await keepScreenshot(page, 'profile_by_keys');
        await tabTo(page, 'Close the profile');
        await press('Enter');
    });

    test('a box is set, an annotation put, and the scene saved', { skip: unless('Tab beyond the page') }, async () => {
        await tabTo(page, 'New box');
        await press('Enter');
        await page.getByText('Box 1').waitFor();
        await tabTo(page, 'Size x of Box 1');
        await type('80');
        await tabTo(page, 'Heading of Box 1');
        await type('90');
        await page.waitForFunction(() => window.stipple.style().clipBoxes[0].axes[0][1] === 1);
        await tabTo(page, 'New annotation');
        await press('Enter');
        await isIn('canvas');
        await press(' ');
        await page.waitForFunction(() => window.stipple.annotations().length === 1);
        await tabTo(page, 'Title');
        await type('By hand');
        await tabTo(page, 'Save');
        const [download] = await Promise.all([page.waitForEvent('download'), press('Enter')]);
        const scene = JSON.parse(await readFile(await download.path(), 'utf8'));
        assert.equal(scene.clouds.length, 1);
        assert.deepEqual(scene.measurements.map(({ kind, points }) => [kind, points.length]), [['distance', 2]]);
        const [{ halfSize, axes }] = scene.style.clipBoxes;
        assert.equal(halfSize[0], 40);
        assert.deepEqual(axes, [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], 'right angles are exact');
        assert.equal(scene.annotations[0].title, 'By hand');
        assert.deepEqual(complaints, []);
    });
});
