// Clip boxes by mouse and number: sides, middle and turn follow the pointer, and the points inside are the server's, all of them.
// Clip polygons on the ground and on the screen, by mouse, finger and keyboard: what is shown, picked and saved is what lies in them.
import assert from 'node:assert/strict';
import { readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';

import { projection } from './support/exact_polygons.mjs';
import { coverage } from './support/picture.mjs';
import { stipple } from './support/program.mjs';
import { keepScreenshot, openPage, readPixels, settle, unless } from './support/browser.mjs';
import { dot, minus, norm, openTownPage } from './support/town_page.mjs';

let town, page, complaints, pointsInside;

before(async () => {
    town = await openTownPage({ width: 1000, height: 640 });
    ({ page, complaints } = town);
});

after(() => town?.close());

const box = async () => (await page.evaluate(() => window.stipple.style())).clipBoxes[0];
const close = (a, b, bound) => assert.ok(norm(minus(a, b)) <= bound, `${a} and ${b}`);
const face = ({ centre, halfSize, axes }, axis, sign) =>
    centre.map((value, i) => value + sign * halfSize[axis] * axes[axis][i]);

/** Places of points of a CSV file. */
function rowsIn(csv) {
    const [head, ...rows] = csv.trim().split(/\r?\n/);
    const names = head.split(',').map((name) => name.toLowerCase());
    return rows.map((row) => {
        const fields = row.split(',');
        return ['x', 'y', 'z'].map((name) => Number(fields[names.indexOf(name)]));
    });
}
const rowsOf = async (address) => rowsIn(await (await fetch(address)).text());
const text = (rows) => rows.map((row) => row.join(' ')).sort();

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
        const address = await page.locator('[data-box="0"] a', { hasText: 'CSV' }).getAttribute('href');
        const inside = await rowsOf(address);
        const all = await rowsOf(`${address.split('/points?')[0]}/points?format=csv`);
        assert.equal(all.length, 150_000);
        const expected = all.filter((p) =>
            axes.every((axis, a) => Math.abs(dot(minus(p, centre), axis)) <= halfSize[a]),
        );
        console.log(`  ${inside.length} of ${all.length} points are inside`);
        assert.ok(inside.length > 1000);
        assert.deepEqual(text(inside), text(expected));
        pointsInside = inside.length;
    });

    test('measured, a box says its sizes and how many points are in it; so do the files', { skip: unless('downloads') }, async () => {
        await page.getByRole('button', { name: 'Measure Box 1' }).click();
        await page.waitForFunction(() => window.stipple.measurements()[0]?.answer);
        const { centre, halfSize, axes } = await box();
        const sizes = halfSize.map((half) => 2 * half);
        const [measured] = await page.evaluate(() => window.stipple.measurements());
        const { width, depth, height, volume } = measured.answer;
        assert.deepEqual([width, depth, height, volume], [...sizes, sizes[0] * sizes[1] * sizes[2]]);
        assert.equal(measured.answer.pointsInside, pointsInside);
        const field = (name) => page.locator(`[data-measurement=box] [data-field=${name}]`).textContent();
        assert.match(await field('volume'), /m³/);
        assert.equal((await field('pointsInside')).replaceAll(/\D/g, ''), String(pointsInside));
        const file = async (label) => {
            const [download] = await Promise.all([
                page.waitForEvent('download'),
                page.locator('stipple-measure').getByRole('button', { name: label, exact: true }).click(),
            ]);
            return readFile(await download.path(), 'utf8');
        };
        const [json] = JSON.parse(await file('JSON')).measurements;
        assert.deepEqual([json.kind, json.box, json.result.pointsInside], ['box', { centre, halfSize, axes }, pointsInside]);
        assert.match(await file('CSV'), new RegExp(`\r\nBox volume 1,box,.*,${pointsInside},`));
        const [{ properties, geometry }] = JSON.parse(await file('GeoJSON')).features;
        assert.deepEqual([properties.volume, geometry.type, geometry.coordinates[0].length], [volume, 'Polygon', 5]);
        const dxf = (await file('DXF')).split('\r\n');
        assert.equal(dxf.filter((line) => line === 'LINE').length, 12);
        await page.getByRole('button', { name: 'Delete Box volume 1' }).click();
        assert.equal((await page.evaluate(() => window.stipple.measurements())).length, 0);
        await page.getByRole('button', { name: 'Delete Box 1' }).click();
        assert.equal(await box(), undefined);
        assert.equal(await page.locator('stipple-clip-overlay g').count(), 0);
        assert.deepEqual(complaints, []);
    });
});

/** In plan, by crossings; away from its edges. */
function holds(ring, [x, y]) {
    let inside = false;
    for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
        const [x1, y1] = ring[i], [x2, y2] = ring[j];
        if (y1 > y !== y2 > y && x < ((x2 - x1) * (y - y1)) / (y2 - y1) + x1) inside = !inside;
    }
    return inside;
}

describe('clip polygons', () => {
    const region = async () => (await page.evaluate(() => window.stipple.style())).clipRegions[0];
    const item = () => page.locator('li[data-region="0"]');
    const csv = () => page.locator('li[data-region="0"] a', { hasText: 'CSV' }).getAttribute('href');
    let all;

    before(async () => {
        all = await rowsOf(new URL('api/v1/clouds/town/points?format=csv', town.address));
        await page.evaluate(() => window.stipple.setLimits({ minNodePixels: 1, pointBudget: 1_000_000 }));
        await settle(page);
    });
    /** All points that the picture has of the cloud, less what is hidden. */
    const shown = async () => {
        await settle(page);
        const { frame } = await page.evaluate(() => window.stipple.counters());
        return frame.pointsDrawn - frame.pointsHidden;
    };

    test('on the ground: corners are clicked, heights entered; the picture, the file and the native export have the same points', async () => {
        await page.keyboard.press('Escape');
        await page.evaluate(() => window.stipple.setStyle({ sizePixels: 6, clipBoxes: [] }));
        await page.locator('canvas').focus();
        await page.keyboard.press('1'); // from the top: all of it is in view
        await page.getByRole('button', { name: 'Polygon on the ground' }).click();
        const places = [[380, 220], [660, 250], [520, 330], [640, 450], [400, 430]];
        for (const [i, [x, y]] of places.entries()) {
            await page.locator('canvas').click({ position: { x, y } });
            await page.locator(`stipple-clip-overlay [data-drawn="${i + 1}"]`).waitFor({ state: 'attached' });
        }
        await page.locator('canvas').click({ position: { x: 480, y: 300 } });
        await page.locator('stipple-clip-overlay [data-drawn="6"]').waitFor({ state: 'attached' });
        await page.keyboard.press('Backspace');
        await page.keyboard.press('Enter');
        await item().waitFor({ state: 'attached' });
        const { mode, region: { polygon } } = await region();
        assert.equal(mode, 'hideOutside');
        assert.equal(polygon.length, 5);
        assert.ok(polygon.every(([x, y]) => all.some((p) => p[0] === x && p[1] === y)), 'corners are points of the cloud');

        // A height that many points have, so that it matters on which side of it they count.
        const inPlan = all.filter((p) => holds(polygon, p));
        const heights = inPlan.map(([, , z]) => z).sort((a, b) => a - b);
        const low = heights[Math.floor(heights.length / 4)], high = heights[Math.floor(heights.length * 0.95)];
        for (const [label, value] of [['Lowest height of Polygon 1', low], ['Highest height of Polygon 1', high]]) {
            await page.getByLabel(label).fill(String(value));
            await page.getByLabel(label).press('Tab');
        }
        assert.deepEqual((await region()).region.heights, [low, high]);
        await page.getByLabel('Highest height of Polygon 1').fill(String(low - 1)); // below the lowest
        await page.getByLabel('Highest height of Polygon 1').press('Tab');
        assert.deepEqual((await region()).region.heights, [low, high]);

        const saved = await rowsOf(await csv());
        const [geojson, out] = ['foot.geojson', 'foot.csv'].map((name) => join(town.folder, name));
        await writeFile(geojson, JSON.stringify({ type: 'Polygon', coordinates: [[...polygon, polygon[0]]] }));
        await stipple('export', join(town.folder, 'town.stipple'), '-o', out, '--polygon', geojson, '--height', `${low}..${high}`);
        const native = rowsIn(await readFile(out, 'utf8'));
        console.log(`  ${saved.length} of ${all.length} points are inside`);
        assert.ok(saved.length > 500);
        assert.deepEqual(text(saved), text(native));
        const corners = new Set(polygon.map(String));
        const byHand = inPlan.filter(([x, y, z]) => z >= low && z <= high && !corners.has(String([x, y])));
        assert.deepEqual(text(saved.filter(([x, y]) => !corners.has(String([x, y])))), text(byHand));
        assert.equal(await shown(), saved.length);
        await keepScreenshot(page, 'clip_polygon');
        await item().getByLabel('Mode').selectOption({ label: 'Hide inside' });
        assert.equal(await shown(), all.length - saved.length);
        await item().getByLabel('Mode').selectOption({ label: 'Highlight' });
        assert.equal(await shown(), all.length);
        await item().getByLabel('Mode').selectOption({ label: 'Hide outside' });
        await settle(page);
        const key = (p) => p.map((value) => value.toFixed(6)).join(' '); // CSV has the decimals of the grid
        const inside = new Set(saved.map(key));
        let picked = 0;
        for (let x = 360; x < 700; x += 35)
            for (const y of [260, 320, 380, 440]) {
                const point = await page.evaluate(([at, up]) => window.stipple.pick(at, up, 1), [x, y]);
                if (!point) continue;
                picked++;
                assert.ok(inside.has(key(point.position)), key(point.position));
            }
        assert.ok(picked > 5, `${picked}`);

        // A corner follows the pointer, over the picture.
        const moved = await drag('[data-corner="0"]', -30, 12);
        assert.ok(Math.hypot(moved.to.x - moved.from.x + 30, moved.to.y - moved.from.y - 12) < 3, JSON.stringify(moved));
        assert.deepEqual((await region()).region.polygon.slice(1), polygon.slice(1));
        await page.getByRole('button', { name: 'Delete Polygon 1' }).click();
        assert.equal(await region(), undefined);
    });

    test('on the screen, by keyboard, mouse and finger: what shows inside it, at any depth', { skip: unless('touch') }, async () => {
        await page.locator('canvas').focus();
        await page.keyboard.press('3');
        await settle(page);
        await page.getByRole('button', { name: 'Polygon on the screen' }).click();
        const drawn = (count) => page.locator(`stipple-clip-overlay [data-drawn="${count}"]`).waitFor({ state: 'attached' });
        await drawn(0);
        const canvas = await page.locator('canvas').boundingBox();
        const ring = [[canvas.width / 2 - 60, canvas.height / 2 - 40], [640, 300], [520, 320], [560, 420]];
        for (let i = 0; i < 3; i++) await page.keyboard.press('ArrowLeft'); // 20 pixels each
        for (let i = 0; i < 10; i++) await page.keyboard.press('Shift+ArrowUp'); // 4
        await page.keyboard.press(' ');
        await drawn(1);
        await page.locator('canvas').click({ position: { x: ring[1][0], y: ring[1][1] } });
        await drawn(2);
        const session = await page.context().newCDPSession(page);
        const touchPoints = [{ x: canvas.x + ring[2][0], y: canvas.y + ring[2][1] }];
        await session.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints });
        await session.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
        await drawn(3);
        await page.locator('canvas').click({ position: { x: ring[3][0], y: ring[3][1] } });
        await drawn(4);
        // An edge that crosses is refused, and the drawing can be mended.
        await page.locator('canvas').click({ position: { x: 660, y: 250 } });
        await page.keyboard.press('Enter');
        await page.getByRole('alert').filter({ hasText: 'cross' }).waitFor();
        await page.getByRole('button', { name: 'Dismiss' }).click();
        await page.locator('canvas').focus();
        await page.keyboard.press('Backspace');
        await page.keyboard.press('Enter');
        await item().waitFor({ state: 'attached' });
        const saved = await rowsOf(await csv());
        const camera = await page.evaluate(() => window.stipple.camera());
        const isNear = (p) => ring.some((a, i) => {
            const b = ring[(i + 1) % ring.length], length = Math.hypot(b[0] - a[0], b[1] - a[1]);
            return Math.abs((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])) / length < 1e-6;
        });
        const show = projection(camera, canvas), places = all.map((p) => [p, show(p)]);
        const unsure = places.filter(([, at]) => isNear(at)).length;
        const expected = places.filter(([, at]) => holds(ring, at)).map(([p]) => p);
        console.log(`  ${saved.length} points show in the polygon, ${unsure} of all are within a millionth of a pixel of its edges' lines`);
        assert.ok(saved.length > 500);
        if (unsure === 0) assert.deepEqual(text(saved), text(expected));
        else assert.ok(Math.abs(saved.length - expected.length) <= unsure);
        assert.equal(await shown(), saved.length);
        await item().getByLabel('Mode').selectOption({ label: 'Hide inside' });
        assert.equal(await shown(), all.length - saved.length);
        await page.getByRole('button', { name: 'Delete Polygon 1' }).click();
        assert.equal(await page.locator('stipple-clip-overlay g').count(), 0);
        assert.deepEqual(complaints, []);
    });
});

describe('a tool that is still on its way', () => {
    test('takes the clicks that come before it is there', async () => {
        const { page: other } = await openPage(town.browser, { width: 1000, height: 640 });
        await other.route('**/polygon_tool*', async (route) => {
            await new Promise((resolve) => setTimeout(resolve, 1500));
            await route.continue();
        });
        await other.goto(town.address);
        await settle(other);
        await other.evaluate(() => window.stipple.setStyle({ sizePixels: 6 }));
        await settle(other);
        await other.getByRole('button', { name: 'Polygon on the ground' }).click();
        for (const [x, y] of [[560, 300], [660, 300], [620, 380]]) await other.mouse.click(x, y);
        await other.keyboard.press('Enter');
        assert.equal((await other.evaluate(() => window.stipple.style())).clipRegions.length, 0);
        await other.waitForFunction(() => window.stipple.style().clipRegions[0]?.region.polygon.length === 3);
        assert.equal(await other.getByRole('region', { name: 'Point' }).count(), 0); // nobody asked about one
        await other.close();
    });
});
