// Clip boxes by mouse and number: sides, middle and turn follow the pointer, and the points inside are the server's, all of them.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';

import { coverage } from './support/picture.mjs';
import { keepScreenshot, readPixels, settle } from './support/browser.mjs';
import { dot, minus, norm, openTownPage } from './support/town_page.mjs';

let town, page, complaints;

before(async () => {
    town = await openTownPage({ width: 1000, height: 640 });
    ({ page, complaints } = town);
});

after(() => town?.close());

const box = async () => (await page.evaluate(() => window.stipple.style())).clipBoxes[0];
const close = (a, b, bound) => assert.ok(norm(minus(a, b)) <= bound, `${a} and ${b}`);
const face = ({ centre, halfSize, axes }, axis, sign) =>
    centre.map((value, i) => value + sign * halfSize[axis] * axes[axis][i]);

async function drag(selector, dx, dy) {
    const handle = await page.locator(`stipple-clip-overlay ${selector}`).boundingBox();
    const from = { x: handle.x + handle.width / 2, y: handle.y + handle.height / 2 };
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move(from.x + dx, from.y + dy, { steps: 12 });
    await page.mouse.up();
    await settle(page);
    await page.waitForTimeout(150);
    const moved = await page.locator(`stipple-clip-overlay ${selector}`).boundingBox();
    return { from, to: { x: moved.x + moved.width / 2, y: moved.y + moved.height / 2 } };
}

describe('clip boxes', () => {
    test('a new box hides what is outside it, and the modes do what they say', async () => {
        const whole = coverage(await readPixels(page));
        await page.getByRole('button', { name: 'New box' }).click();
        await page.locator('[data-box="0"]').waitFor();
        await settle(page);
        const inside = coverage(await readPixels(page));
        assert.ok(inside > 0 && inside < 0.5 * whole, `${inside} of ${whole}`);
        const item = page.locator('[data-box="0"]');
        await item.getByLabel('Mode').selectOption({ label: 'Hide inside' });
        await settle(page);
        const outside = coverage(await readPixels(page));
        assert.ok(outside > inside && outside < whole, `${inside}, ${outside}, ${whole}`);
        await item.getByLabel('Mode').selectOption({ label: 'Highlight' });
        await settle(page);
        assert.equal(coverage(await readPixels(page)), whole);
        await item.getByLabel('Mode').selectOption({ label: 'Hide outside' });
        await settle(page);
    });

    test('a side follows the pointer and the opposite one stays; so do the middle and the turn', async () => {
        const first = await box();
        const grown = await drag('[data-face="x+"]', 40, 20);
        const second = await box();
        close(face(second, 0, -1), face(first, 0, -1), 1e-6);
        assert.ok(second.halfSize[0] !== first.halfSize[0]);
        assert.deepEqual(second.halfSize.slice(1), first.halfSize.slice(1));
        // It goes along its axis as far as the pointer went that way.
        const way = { x: grown.to.x - grown.from.x, y: grown.to.y - grown.from.y };
        const across = Math.abs(40 * way.y - 20 * way.x) / Math.hypot(way.x, way.y);
        const rest = Math.hypot(40 - way.x, 20 - way.y);
        assert.ok(Math.abs(rest - across) < 3, JSON.stringify({ way, rest, across }));

        const moved = await drag('[data-handle=centre]', 50, 15);
        const third = await box();
        assert.ok(Math.hypot(moved.to.x - moved.from.x - 50, moved.to.y - moved.from.y - 15) < 4, JSON.stringify(moved));
        assert.deepEqual(third.halfSize, second.halfSize);
        assert.ok(Math.abs(third.centre[2] - second.centre[2]) < 1e-9);

        await drag('[data-handle=turn]', 40, 60);
        const fourth = await box();
        assert.ok(norm(minus(fourth.axes[0], third.axes[0])) > 0.1);
        for (let a = 0; a < 3; a++)
            for (let b = 0; b < 3; b++)
                assert.ok(Math.abs(dot(fourth.axes[a], fourth.axes[b]) - Number(a === b)) < 1e-12);
        close(fourth.axes[2], [0, 0, 1], 0);
        assert.deepEqual(fourth.centre, third.centre);
        await keepScreenshot(page, 'clipped');
    });

    test('numbers are taken as they are entered, wrong ones are not', async () => {
        const enter = async (label, value) => {
            await page.getByLabel(label).fill(value);
            await page.getByLabel(label).press('Tab');
            await settle(page);
        };
        await enter('Size z of Box 1', '75.5');
        assert.equal((await box()).halfSize[2], 37.75);
        await enter('Heading of Box 1', '30');
        close((await box()).axes[0], [Math.cos(Math.PI / 6), 0.5, 0], 1e-12);
        await enter('Centre x of Box 1', '499990.25');
        assert.equal((await box()).centre[0], 499990.25);
        const before = await box();
        await enter('Size x of Box 1', '-3');
        await enter('Size y of Box 1', '');
        assert.deepEqual(await box(), before);
        const shown = Number(await page.getByLabel('Size x of Box 1').inputValue());
        assert.ok(Math.abs(shown / (2 * before.halfSize[0]) - 1) < 1e-11);
        await enter('Centre z of Box 1', '20');
    });

    test('the points inside, as a file of the server, are those of the whole cloud that lie in the box', async () => {
        const { centre, halfSize, axes } = await box();
        const rowsOf = async (address) => {
            const [head, ...rows] = (await (await fetch(address)).text()).trim().split(/\r?\n/);
            const names = head.split(',').map((name) => name.toLowerCase());
            return rows.map((row) => {
                const fields = row.split(',');
                return ['x', 'y', 'z'].map((name) => Number(fields[names.indexOf(name)]));
            });
        };
        const address = await page.locator('[data-box="0"] a', { hasText: 'CSV' }).getAttribute('href');
        const inside = await rowsOf(address);
        const all = await rowsOf(`${address.split('/points?')[0]}/points?format=csv`);
        assert.equal(all.length, 150_000);
        const expected = all.filter((p) =>
            axes.every((axis, a) => Math.abs(dot(minus(p, centre), axis)) <= halfSize[a]),
        );
        const text = (rows) => rows.map((row) => row.join(' ')).sort();
        console.log(`  ${inside.length} of ${all.length} points are inside`);
        assert.ok(inside.length > 1000);
        assert.deepEqual(text(inside), text(expected));
        await page.getByRole('button', { name: 'Delete Box 1' }).click();
        assert.equal(await box(), undefined);
        assert.equal(await page.locator('stipple-clip-overlay g').count(), 0);
        assert.deepEqual(complaints, []);
    });
});
