// The measuring tools, driven by mouse and keyboard: each result against its formula, computed here from the points'
// integers; handles, list, units and files.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, before, beforeEach, describe, test } from 'node:test';

import { keepScreenshot, settle, unless } from './support/browser.mjs';
import { cross, dot, minus, norm, openTownPage } from './support/town_page.mjs';

const places = [
    { x: 420, y: 210 },
    { x: 520, y: 250 },
    { x: 455, y: 320 },
    { x: 560, y: 330 },
];

let town, page, complaints;

before(async () => {
    town = await openTownPage({ width: 900, height: 600 });
    ({ page, complaints } = town);
});

after(() => town?.close());

const measurements = () => page.evaluate(() => window.stipple.measurements());
const tool = (name) => page.getByRole('button', { name, exact: true });
const row = (kind) => page.locator(`[data-measurement=${kind}]`);
const click = ({ x, y }) => page.locator('canvas').click({ position: { x, y } });

/** Waits until `count` points of the measurement at the end of the list were taken. */
const taken = (count) =>
    page.waitForFunction((wanted) => window.stipple.measurements().at(-1)?.points.length === wanted, count);

async function measure(name, count) {
    await tool(name).click();
    for (let i = 0; i < count; i++) {
        await click(places[i]);
        await taken(i + 1);
    }
    return (await measurements()).at(-1);
}

/** From the first point, exact: differences of integers. */
function local({ points }) {
    const [first] = points;
    return points.map(({ integers, scale }) =>
        integers.map((value, axis) => Number(BigInt(value) - BigInt(first.integers[axis])) * scale[axis]),
    );
}
const worst = {};

function same(what, found, expected, bound = 1e-12) {
    const off = Math.abs(found / expected - 1);
    worst[what] = Math.max(worst[what] ?? 0, off);
    assert.ok(off <= bound, `${what}: ${found} instead of ${expected}`);
}

async function clear() {
    for (const { name } of await measurements()) await page.getByRole('button', { name: `Delete ${name}` }).click();
    assert.deepEqual(await measurements(), []);
}

describe('measuring', () => {
    beforeEach(clear);

    test('distances, heights, azimuths, angles, areas and circles are those of their formulas', async () => {
        const distance = await measure('Distance', 3);
        await page.keyboard.press('Enter');
        const [a, b, c] = local(distance);
        same('distance', distance.answer.distance, norm(minus(b, a)) + norm(minus(c, b)));
        const plan = (u, v) => Math.hypot(v[0] - u[0], v[1] - u[1]);
        same('horizontal', distance.answer.horizontal, plan(a, b) + plan(b, c));
        same('vertical', distance.answer.vertical, c[2] - a[2]);
        assert.ok(distance.answer['±distance'] > 0);

        const height = await measure('Height', 2);
        same('height', height.answer.height, Math.abs(b[2] - a[2]));
        const azimuth = await measure('Azimuth', 2);
        const turn = (Math.atan2(b[0] - a[0], b[1] - a[1]) * 180) / Math.PI;
        same('azimuth', azimuth.answer.azimuth, turn < 0 ? turn + 360 : turn);

        const angle = await measure('Angle', 3);
        const u = minus(a, b), v = minus(c, b);
        same('angle', angle.answer.angle, (Math.acos(dot(u, v) / norm(u) / norm(v)) * 180) / Math.PI);

        const circle = await measure('Circle', 3);
        const sides = [norm(minus(a, b)), norm(minus(b, c)), norm(minus(c, a))];
        const triangle = norm(cross(minus(b, a), minus(c, a))) / 2;
        same('radius', circle.answer.radius, (sides[0] * sides[1] * sides[2]) / (4 * triangle));

        const area = await measure('Area', 3);
        await page.keyboard.press('Enter');
        same('area of a triangle', area.answer.inPlane, triangle);
        same('area in plan', area.answer.horizontal, Math.abs(cross(minus(b, a), minus(c, a))[2]) / 2);

        const point = await measure('Point', 1);
        assert.deepEqual(point.answer.position, point.points[0].position);

        assert.equal((await measurements()).length, 7);
        assert.equal(await tool('Area').getAttribute('aria-pressed'), 'false');
        await keepScreenshot(page, 'measured');
        console.log(`  worst relative differences: ${JSON.stringify(worst)}`);
    });

    test('the list shows values with their deviation, in the unit that is chosen', async () => {
        const { answer, points } = await measure('Distance', 2);
        await page.keyboard.press('Enter');
        const shown = await row('distance').locator('[data-field=distance]').textContent();
        assert.match(shown, /^\s*\d+\.\d+ .*± \d/);
        const unitMeters = points[0].unitMeters || 1;
        assert.ok(Math.abs(parseFloat(shown) - answer.distance) < answer['±distance']);
        if (points[0].unitMeters > 0) {
            await page.getByLabel('Unit').selectOption({ label: 'Feet' });
            const feet = await row('distance').locator('[data-field=distance]').textContent();
            assert.match(feet, / ft/);
            assert.ok(Math.abs(parseFloat(feet) * 0.3048 - answer.distance * unitMeters) < 2 * answer['±distance'] * unitMeters);
            await page.getByLabel('Unit').selectOption({ label: 'As the cloud' });
        }
        await row('distance').getByLabel('Name').fill('Gate');
        await page.keyboard.press('Tab');
        assert.equal((await measurements())[0].name, 'Gate');
        const overlay = page.locator('stipple-measure-overlay g');
        assert.equal(await overlay.count(), 1);
        await page.getByRole('button', { name: 'Hide Gate' }).click();
        assert.equal(await overlay.count(), 0);
        await page.getByRole('button', { name: 'Hide Gate' }).click();
        assert.equal(await overlay.count(), 1);
    });

    test('a handle is dragged to another point, and lines follow the camera', async () => {
        const original = await measure('Distance', 2);
        await page.keyboard.press('Enter');
        const handle = page.locator('stipple-measure-overlay circle').nth(1);
        const box = await handle.boundingBox();
        await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
        await page.mouse.down();
        await page.mouse.move(places[3].x, places[3].y, { steps: 5 });
        await page.mouse.up();
        await page.waitForFunction(
            (old) => JSON.stringify(window.stipple.measurements()[0].points[1].integers) !== JSON.stringify(old),
            original.points[1].integers,
        );
        await page.waitForTimeout(500); // questions on the way are answered; a new one would take their place
        const expected = await page.evaluate(({ x, y }) => window.stipple.pick(x, y), places[3]);
        const [moved] = await measurements();
        assert.deepEqual(moved.points[1].integers, expected.integers);
        const [a, b] = local(moved);
        same('distance after dragging', moved.answer.distance, norm(minus(b, a)));

        const before = await page.locator('stipple-measure-overlay path.line').getAttribute('d');
        await page.locator('canvas').press('ArrowLeft');
        await settle(page);
        const after = await page.locator('stipple-measure-overlay path.line').getAttribute('d');
        assert.notEqual(after, before);
        // Each handle lies where its point is picked.
        const end = await page.locator('stipple-measure-overlay circle').nth(1).boundingBox();
        const there = await page.evaluate(
            ([x, y]) => window.stipple.pick(x, y, 3),
            [end.x + end.width / 2, end.y + end.height / 2],
        );
        assert.ok(there === null || norm(minus(there.position, moved.points[1].position)) < 5);
        await page.locator('canvas').press('ArrowRight');
        await settle(page);
    });

    test('Backspace takes a point back, Escape gives up, too few points leave nothing', async () => {
        await measure('Area', 3);
        await page.keyboard.press('Backspace');
        await taken(2);
        assert.equal((await measurements())[0].answer, undefined);
        await page.keyboard.press('Enter');
        assert.deepEqual(await measurements(), []);
        await measure('Circle', 2);
        await page.keyboard.press('Escape');
        assert.deepEqual(await measurements(), []);
        assert.equal(await page.getByRole('complementary', { name: 'Point' }).count(), 0);
        // The first point again: a circle through two places does not exist, which is said.
        await measure('Circle', 2);
        await click(places[0]);
        await taken(3);
        assert.match(await row('circle').getByRole('alert').textContent(), /no circle/);
    });

    test('clicks that come faster than their answers all count, and the end waits for them', async () => {
        await tool('Area').click();
        for (const { x, y } of places) await page.mouse.click(x, y);
        await page.keyboard.press('Backspace');
        await page.mouse.click(places[3].x, places[3].y);
        await page.keyboard.press('Enter');
        await taken(4);
        const [{ points }] = await measurements();
        for (const [i, { x, y }] of places.entries()) {
            const { integers } = await page.evaluate(([x, y]) => window.stipple.pick(x, y), [x, y]);
            assert.deepEqual(points[i].integers, integers);
        }
        assert.equal(await tool('Area').getAttribute('aria-pressed'), 'false');
    });

    test('files for other programs hold what was measured', { skip: unless('downloads') }, async () => {
        const area = await measure('Area', 4);
        await page.keyboard.press('Enter');
        await row('area').getByLabel('Name').fill('Site "A", =1+1');
        await page.keyboard.press('Tab');
        const save = async (label) => {
            const [download] = await Promise.all([page.waitForEvent('download'), tool(label).click()]);
            return readFile(await download.path(), 'utf8');
        };
        const json = JSON.parse(await save('JSON'));
        assert.deepEqual(json.measurements[0].result, area.answer);
        assert.deepEqual(json.measurements[0].points[2].integers, area.points[2].integers);
        const csv = (await save('CSV')).split('\r\n');
        assert.match(csv[0], /^name,kind,crs,unit,.*horizontal.*,points$/);
        assert.ok(csv[1].startsWith('"Site ""A"", =1+1",area,'), csv[1]);
        const geojson = JSON.parse(await save('GeoJSON'));
        const ring = geojson.features[0].geometry.coordinates[0];
        assert.equal(ring.length, 5);
        assert.deepEqual(ring[0], ring[4]);
        assert.equal(geojson.features[0].properties.horizontal, area.answer.horizontal);
        const dxf = await save('DXF');
        assert.match(dxf, /AC1009/);
        assert.equal(dxf.split('VERTEX\r\n').length - 1, 4);
        const xs = dxf.split('VERTEX\r\n').slice(1).map((part) => Number(part.match(/ ?10\r\n([^\r]+)/)[1]));
        assert.deepEqual(xs, area.points.map(({ position }) => position[0]));
        assert.ok(dxf.endsWith('EOF\r\n'));
        assert.deepEqual(complaints, []);
    });
});
