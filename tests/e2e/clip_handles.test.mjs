// The handles of clip boxes and polygons by mouse, fingers and keys: corners moved, added and taken away, boxes moved, sized and turned
// in any way; the points inside are those of the scan, tested one by one.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, beforeEach, describe, test } from 'node:test';

import { settle } from './support/browser.mjs';
import { pointsInFootprint, pointsShownIn, projection } from './support/exact_polygons.mjs';
import { pointsInBox, readScan } from './support/exact_regions.mjs';
import { focused, tabTo } from './support/keyboard.mjs';
import { exportDifferences } from './support/tool_checks.mjs';
import { mouseHand, randomFrom, touchHand } from './support/tool_driver.mjs';
import { dot, minus, norm, openTownPage } from './support/town_page.mjs';

let town, page, scan, mouse, fingers, touch;

before(async () => {
    town = await openTownPage({ width: 800, height: 460 }, { points: 20_000 });
    ({ page } = town);
    scan = await readScan(join(town.folder, 'town.las'));
    mouse = mouseHand(page, randomFrom(3));
    fingers = await touchHand(page, randomFrom(3));
    const session = await page.context().newCDPSession(page);
    touch = (type, ...touchPoints) => session.send('Input.dispatchTouchEvent', { type, touchPoints });
});
after(() => town?.close());
beforeEach(async () => {
    await page.evaluate(() => window.stipple.setStyle({ clipBoxes: [], clipRegions: [] }));
    await settle(page);
});

const style = () => page.evaluate(() => window.stipple.style());
const region = async () => (await style()).clipRegions[0].region;
const box = async () => (await style()).clipBoxes[0];
const handle = (name) => page.locator(`stipple-clip-overlay [data-${name}]`);
const count = (kind) => handle(kind).count();
const middle = async (locator) => {
    const { x, y, width, height } = await locator.boundingBox();
    return { x: x + width / 2, y: y + height / 2 };
};
async function doubleTap(locator) {
    const at = await middle(locator);
    for (let i = 0; i < 2; i++) {
        await touch('touchStart', at);
        await touch('touchEnd');
    }
}
const press = async (...keys) => {
    for (const key of keys) await page.keyboard.press(key);
};
/** The list's LAS file has the points that are right, and some; so has the native program's of the region. */
async function checkFile(item, right, inside) {
    const address = await page.locator(item).locator('a', { hasText: /^LAS$/ }).getAttribute('href');
    const { points, off, native } = await exportDifferences(address, right, inside, { scan, cloud: join(town.folder, 'town.stipple'), folder: town.folder });
    assert.ok(points > 20, `${points} points`);
    assert.deepEqual([off, native], [0, 0]);
}
async function draw(tool, places) {
    await page.getByRole('button', { name: tool }).click();
    for (const [i, [x, y]] of places.entries()) {
        await page.mouse.click(x, y);
        await handle(`drawn="${i + 1}"`).waitFor({ state: 'attached' });
    }
    await page.keyboard.press('Enter');
    await handle('corner="0"').waitFor();
}

describe('handles of clips', () => {
    test('a box by keys: sides, middle and turn; by mouse it is turned about its other axes', async () => {
        await page.getByRole('button', { name: 'New box' }).click();
        await handle('face="x+"').waitFor();
        await settle(page);
        const first = await box();
        await page.getByRole('application', { name: 'Point cloud' }).focus();
        await tabTo(page, 'Side x+ of Box 1', { backwards: false });
        const [from, to] = [await middle(handle('face="x+"')), await middle(handle('face="x-"'))];
        await press(from.x > to.x ? 'ArrowRight' : 'ArrowLeft');
        const second = await box();
        assert.ok(second.halfSize[0] > first.halfSize[0]);
        const end = ({ centre, halfSize }) => centre[0] - halfSize[0];
        assert.ok(Math.abs(end(second) - end(first)) < 1e-6, 'the other side stays');
        await press(...Array(9).fill('PageDown'));
        assert.equal((await focused(page)).name, 'Middle of Box 1');
        await press('Shift+ArrowUp');
        const third = await box();
        assert.deepEqual(third.halfSize, second.halfSize);
        assert.notDeepEqual(third.centre, second.centre);
        await press(...Array(3).fill('PageUp'));
        assert.equal((await focused(page)).name, 'Turn Box 1 about z');
        await press('Shift+ArrowRight', 'Shift+ArrowRight', 'ArrowLeft');
        const turned = await box();
        assert.ok(Math.abs((Math.atan2(turned.axes[0][1], turned.axes[0][0]) * 180) / Math.PI - 9) < 1e-9);
        assert.deepEqual(turned.axes[2], [0, 0, 1]);

        await mouse.drag(handle('handle=turnX'), 15, 40);
        await fingers.drag(handle('handle=turnY'), 25, 12);
        await settle(page);
        const tilted = await box();
        assert.ok(tilted.axes[2][2] < 0.999 && norm(minus(tilted.axes[1], turned.axes[1])) > 0.05, JSON.stringify(tilted.axes));
        for (let a = 0; a < 3; a++) for (let b = 0; b < 3; b++) assert.ok(Math.abs(dot(tilted.axes[a], tilted.axes[b]) - Number(a === b)) < 1e-14);
        assert.deepEqual(tilted.centre, turned.centre);
        await page.getByText('It is turned about more than z.').waitFor({ state: 'attached' });
        await checkFile('[data-box="0"]', pointsInBox(scan, tilted), { box: { centre: tilted.centre, halfSize: tilted.halfSize, axes: tilted.axes } });
        await page.getByRole('application', { name: 'Point cloud' }).focus();
        await page.keyboard.press('Control+z');
        await page.keyboard.press('Control+z');
        assert.deepEqual((await box()).axes, turned.axes);
    });

    test('a footprint: corners are added on its edges and taken away, by mouse, fingers and keys', async () => {
        await page.getByRole('application', { name: 'Point cloud' }).focus();
        await press('1'); // from the top
        await settle(page);
        await mouse.polygon('Polygon on the ground', 3);
        await handle('corner="0"').waitFor();
        const { polygon } = await region();
        await mouse.drag(handle('new="0"'), 4, -40);
        const four = (await region()).polygon;
        assert.deepEqual([four[0], four[2], four[3]], polygon);
        const [[ax, ay], [bx, by]] = polygon, [x, y] = four[1];
        assert.ok(Math.abs((bx - ax) * (y - ay) - (by - ay) * (x - ax)) > 1, 'it went on with the pointer');
        await fingers.drag(handle('new="2"'), 25, 20);
        assert.equal((await region()).polygon.length, 5);
        assert.deepEqual((await region()).polygon.slice(0, 3), four.slice(0, 3));
        // By keys: from corner to corner, the small ones between.
        await handle('corner="0"').focus();
        await press('PageUp');
        assert.equal((await focused(page)).name, 'New corner after corner 5 of Polygon 1');
        await press('Enter');
        await page.waitForFunction(() => window.stipple.style().clipRegions[0].region.polygon.length === 6);
        assert.equal((await focused(page)).name, 'Corner 6 of Polygon 1');
        const six = (await region()).polygon;
        await press('Shift+ArrowLeft', 'ArrowUp');
        const moved = (await region()).polygon;
        assert.deepEqual(moved.slice(0, 5), six.slice(0, 5));
        assert.notDeepEqual(moved[5], six[5]);
        await checkFile('li[data-region="0"]', pointsInFootprint(scan, { polygon: moved }), { polygon: moved });

        await handle('corner="1"').dblclick();
        assert.deepEqual((await region()).polygon, moved.filter((_, i) => i !== 1));
        await doubleTap(handle('corner="4"'));
        assert.deepEqual((await region()).polygon, moved.filter((_, i) => i !== 1 && i !== 5));
        await handle('corner="2"').focus();
        await press('Delete');
        assert.equal(await count('corner'), 3);
        assert.match((await focused(page)).name, /^Corner 3 of/);
        const left = (await region()).polygon;
        await press('Delete', 'Backspace'); // three are needed
        assert.deepEqual((await region()).polygon, left);
        await checkFile('li[data-region="0"]', pointsInFootprint(scan, { polygon: left }), { polygon: left });
        for (let i = 0; i < 3; i++) await press('Control+z'); // each key that changed something
        assert.deepEqual((await region()).polygon, moved);
    });

    test('a polygon on the screen: in the view that it was drawn in, which is gone back to', async () => {
        await page.getByRole('application', { name: 'Point cloud' }).focus();
        await press('3'); // iso
        await settle(page);
        const places = [[420, 140], [620, 150], [600, 330], [440, 320]];
        await draw('Polygon on the screen', places);
        const drawn = await region();
        await page.getByRole('application', { name: 'Point cloud' }).focus();
        await press('ArrowLeft', 'ArrowUp');
        await settle(page);
        assert.equal(await count('corner'), 0);
        await page.getByText('Its corners are moved in the view that it was drawn in.').waitFor();
        await page.getByRole('button', { name: 'Go to the view of Polygon 1' }).click();
        await handle('corner="0"').waitFor();
        await page.waitForTimeout(1000);
        await settle(page);
        const corner = async (i) => middle(handle(`corner="${i}"`));
        for (const [i, [x, y]] of places.entries()) {
            const at = await corner(i);
            assert.ok(Math.hypot(at.x - x, at.y - y) < 0.05, JSON.stringify([i, at]));
        }
        await mouse.drag(handle('corner="2"'), 20, -30);
        await fingers.drag(handle('new="3"'), -30, 10);
        await handle('new="0"').focus();
        await press('Shift+ArrowUp'); // adds it, and moves it
        await page.waitForFunction(() => window.stipple.style().clipRegions[0].region.prism.corners.length === 6);
        assert.equal((await focused(page)).name, 'Corner 2 of Polygon 1');
        await press('ArrowRight', 'ArrowRight');
        const ring = [[420, 140], [528, 125], [620, 150], [620, 300], [440, 320], [400, 240]];
        const { prism } = await region();
        assert.deepEqual([prism.eye, prism.corners[0], prism.corners[2], prism.corners[4]], [drawn.prism.eye, ...[0, 1, 3].map((i) => drawn.prism.corners[i])]);
        for (const [i, [x, y]] of ring.entries()) {
            const at = await corner(i);
            assert.ok(Math.hypot(at.x - x, at.y - y) < 0.05, JSON.stringify([i, at]));
        }
        // What is not moved is exactly where it was; the others are where they show.
        const camera = await page.evaluate(() => window.stipple.camera()), show = projection(camera, await page.getByRole('application', { name: 'Point cloud' }).boundingBox());
        const shownRing = prism.corners.map(show);
        const { inside, unsure } = pointsShownIn(scan, shownRing, show);
        assert.equal(unsure.length, 0);
        await checkFile('li[data-region="0"]', inside, { prism });
        // A corner does not cross an edge: it stays where it was last.
        await mouse.drag(handle('corner="5"'), 300, 0);
        const kept = (await region()).prism;
        assert.equal(kept.corners.length, 6);
        await checkFile('li[data-region="0"]', pointsShownIn(scan, kept.corners.map(show), show).inside, { prism: kept });
        await handle('corner="5"').dblclick();
        await handle('corner="1"').focus();
        await press('Delete');
        assert.deepEqual((await region()).prism.corners, [0, 2, 3, 4].map((i) => kept.corners[i]));
        assert.equal(await page.getByRole('alert').count(), 0);
        assert.deepEqual(town.complaints, []);
    });

    test('the same in parallel view', async () => {
        await page.getByLabel('Projection: Ortho.').check({ force: true });
        await settle(page);
        await draw('Polygon on the screen', [[420, 140], [620, 150], [600, 330]]);
        const { prism } = await region();
        assert.equal(prism.eye, null);
        await page.getByRole('application', { name: 'Point cloud' }).focus();
        await press('ArrowLeft');
        await settle(page);
        assert.equal(await count('corner'), 0);
        await page.getByRole('button', { name: 'Go to the view of Polygon 1' }).click();
        await handle('corner="0"').waitFor();
        await page.waitForTimeout(1000);
        await settle(page);
        const [a, b] = await Promise.all([0, 1].map((i) => middle(handle(`corner="${i}"`))));
        assert.ok(Math.abs((b.y - a.y) / (b.x - a.x) - 10 / 200) < 1e-3, JSON.stringify([a, b]));
        await mouse.drag(handle('corner="1"'), -30, 10);
        const moved = await region();
        assert.deepEqual([0, 2].map((i) => moved.prism.corners[i]), [0, 2].map((i) => prism.corners[i]));
        const at = await middle(handle('corner="1"'));
        assert.ok(Math.hypot(at.x - b.x + 30, at.y - b.y - 10) < 0.05, JSON.stringify([at, b]));
    });
});
