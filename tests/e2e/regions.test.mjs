// Points of regions without a server that cuts them: the page of a plain file host reads the nodes itself. What a clip box and a
// polygon hold is what the export of the same box, and every point of the scan, say.
import assert from 'node:assert/strict';
import { createServer } from 'node:http';
import { open, readFile, stat, writeFile } from 'node:fs/promises';
import { extname, join } from 'node:path';
import { after, before, describe, test } from 'node:test';

import { keepScreenshot, launch, openPage, settle, settleWithPoints, unless } from './support/browser.mjs';
import { makeTown, root, scratchFolder, stipple } from './support/program.mjs';
import { answerPicker, pickedFile, waitForPicked } from './support/files.mjs';
import { readLas } from './support/las.mjs';
import { dot, minus } from './support/town_page.mjs';

const types = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm', '.svg': 'image/svg+xml' };

/** A static host: files and ranges of them, nothing else. */
async function staticHost(folders) {
    const server = createServer(async (request, response) => {
        const path = new URL(request.url, 'http://localhost').pathname;
        const name = path.endsWith('/') ? `${path}index.html` : path;
        for (const folder of folders) {
            const file = join(folder, name);
            const size = await stat(file).then((s) => s.size, () => -1);
            if (size < 0) continue;
            const head = { 'content-type': types[extname(file)] ?? 'application/octet-stream', etag: `"${size}"`, 'accept-ranges': 'bytes' };
            const range = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? '');
            if (!range) {
                response.writeHead(200, head).end(await readFile(file));
                return;
            }
            const [from, to] = [Number(range[1]), Math.min(Number(range[2]), size - 1)];
            const bytes = Buffer.alloc(to - from + 1);
            const handle = await open(file);
            await handle.read(bytes, 0, bytes.length, from);
            await handle.close();
            response.writeHead(206, { ...head, 'content-range': `bytes ${from}-${to}/${size}` }).end(bytes);
            return;
        }
        response.writeHead(404).end();
    });
    await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
    return { address: `http://127.0.0.1:${server.address().port}/`, stop: () => server.close() };
}

let folder, host, browser, page, complaints, cloud, scan;

before(async () => {
    folder = await scratchFolder();
    cloud = await makeTown(folder.path);
    scan = await readLas(cloud.replace('.stipple', '.las'));
    host = await staticHost([join(root, 'www/dist'), folder.path]);
    browser = await launch();
    ({ page, complaints } = await openPage(browser, { width: 1000, height: 700 }));
    await page.goto(`${host.address}?cloud=town.stipple`);
    await settleWithPoints(page);
    await page.evaluate(() => window.stipple.setStyle({ sizePixels: 4, shape: 'square' }));
    await settle(page);
    complaints.length = 0; // a static host has no list of clouds, which the browser tells of
});

after(async () => {
    await browser?.close();
    host?.stop();
    await folder?.cleanUp();
});

const key = (p) => p.join(' ');
const text = (points) => points.map(key).sort();

async function save(format) {
    const [download] = await Promise.all([
        page.waitForEvent('download'),
        page.locator('[data-own]').getByRole('button', { name: format, exact: true }).click(),
    ]);
    const path = join(folder.path, `saved.${format.toLowerCase()}`);
    await download.saveAs(path);
    return path;
}

describe('regions of a static host', () => {
    test("a clip box's points are saved by the page: those of the export of the same box, and of the scan", { skip: unless('downloads') }, async () => {
        await page.getByRole('button', { name: 'New box' }).click();
        await page.locator('[data-box="0"]').waitFor();
        await page.getByLabel('Heading of Box 1').fill('25');
        await page.getByLabel('Heading of Box 1').press('Tab');
        await settle(page);
        const { centre, halfSize, axes } = (await page.evaluate(() => window.stipple.style())).clipBoxes[0];
        const inside = scan.points.filter((p) =>
            axes.every((axis, a) => Math.abs(dot(minus(scan.placeOf(p), centre), axis)) <= halfSize[a]),
        );
        assert.ok(inside.length > 1000 && inside.length < scan.points.length / 2, `${inside.length}`);
        const sizes = halfSize.map((half) => 2 * half);
        const exported = join(folder.path, 'exported.las');
        await stipple('export', cloud, '-o', exported, '--rotated-box', `${centre.join(',')};${sizes.join(',')};25`);
        const reference = await readLas(exported);
        assert.deepEqual(text(reference.points), text(inside));
        const saved = await save('LAS'), las = await readLas(saved);
        assert.deepEqual(text(las.points), text(inside));
        assert.deepEqual([las.scale, las.offset, las.format], [reference.scale, reference.offset, reference.format]);
        assert.deepEqual([...las.records()].sort(), [...reference.records()].sort(), 'all attributes are the same');
        const laz = await save('LAZ');
        await stipple('convert', laz, '-o', join(folder.path, 'again.stipple'));
        await stipple('export', join(folder.path, 'again.stipple'), '-o', join(folder.path, 'again.las'));
        assert.deepEqual(text((await readLas(join(folder.path, 'again.las'))).points), text(inside));
        const [head, ...rows] = (await readFile(await save('CSV'), 'utf8')).trim().split('\n');
        assert.match(head, /^X,Y,Z,/);
        assert.equal(rows.length, inside.length);
        console.log(`  ${inside.length} of ${scan.points.length} points are inside`);
        // On the disk as it comes, its header last.
        await answerPicker(page);
        await page.locator('[data-own]').getByRole('button', { name: 'LAS', exact: true }).click();
        const expected = await readFile(saved);
        const kept = await waitForPicked(page, 'town-Box 1.las', (file) => file.length === expected.length);
        assert.equal(Buffer.compare(kept, expected), 0);
        await answerPicker(page, 1000);
        await page.locator('[data-own]').getByRole('button', { name: 'CSV', exact: true }).click();
        await page.getByRole('alert').filter({ hasText: 'The disk is full. Nothing of it was kept.' }).first().waitFor();
        assert.equal(await pickedFile(page, 'town-Box 1.csv'), null);
        await page.evaluate(() => (window.showSaveFilePicker = undefined));
        const volume = await page.locator('[data-volume]').textContent();
        const shown = Number(/[\d.]+/.exec(volume)[0]);
        assert.ok(Math.abs(shown / (sizes[0] * sizes[1] * sizes[2]) - 1) < 1e-3, volume);
        await page.getByRole('button', { name: 'Delete Box 1' }).click();
        await settle(page);
    });

    test('cut and fill over a polygon: the points of the scan in it, above and below the base', async () => {
        const places = [{ x: 420, y: 300 }, { x: 640, y: 320 }, { x: 600, y: 430 }, { x: 430, y: 410 }];
        await page.getByRole('button', { name: 'Volume', exact: true }).click();
        for (const [i, place] of places.entries()) {
            await page.locator('canvas').first().click({ position: place });
            await page.waitForFunction((n) => window.stipple.measurements().at(-1)?.points.length === n, i + 1);
        }
        await page.keyboard.press('Enter');
        const answered = () =>
            page.waitForFunction(() => {
                const item = window.stipple.measurements()[0];
                return item.error !== undefined || (item.answer !== undefined && item.share === undefined);
            });
        const item = async () => {
            await answered();
            const [found] = await page.evaluate(() => window.stipple.measurements());
            assert.equal(found.error, undefined);
            return found;
        };
        const rim = await item();
        const ring = rim.points.map(({ position }) => position);
        const area = Math.abs(ring.reduce((sum, [x, y], i) => {
            const [u, v] = ring[(i + 1) % ring.length];
            return sum + (x - ring[0][0]) * (v - ring[0][1]) - (u - ring[0][0]) * (y - ring[0][1]);
        }, 0)) / 2;
        assert.ok(Math.abs(rim.answer.area / area - 1) < 1e-9, `${rim.answer.area} and ${area}`);
        const inside = scan.points.map((p) => scan.placeOf(p)).filter((p) => holds(ring, p));
        assert.equal(rim.answer.pointsInside, inside.length);

        await page.locator('[data-measurement=volume] select').selectOption({ label: 'A level plane' });
        const low = Math.min(...inside.map(([, , z]) => z)) - 1;
        await page.getByLabel('Height of the base of Volume 1').fill(String(low));
        await page.getByLabel('Height of the base of Volume 1').press('Tab');
        await page.waitForFunction((height) => {
            const [{ base, answer, share }] = window.stipple.measurements();
            return base?.height === height && answer && share === undefined;
        }, low);
        const level = await item();
        assert.equal(level.answer.fill, 0);
        const expected = cutAbove(inside, ring, low, level.answer.cell);
        console.log(`  cut ${level.answer.cut} ± ${level.answer['±cut']}, by hand ${expected}`);
        assert.ok(Math.abs(level.answer.cut / expected - 1) < 2e-3, `${level.answer.cut} and ${expected}`);
        assert.ok(level.answer['±cut'] > 0);
        const shown = await page.locator('[data-measurement=volume] [data-field=cut]').textContent();
        assert.match(shown, /\d m³ .*± \d/s);
        await keepScreenshot(page, 'volume');

        // A corner that is dragged measures anew.
        const handle = await page.locator('stipple-measure-overlay [data-kind=volume] circle').first().boundingBox();
        await page.mouse.move(handle.x + 5, handle.y + 5);
        await page.mouse.down();
        await page.mouse.move(handle.x + 45, handle.y + 15, { steps: 6 });
        await page.mouse.up();
        await page.waitForFunction((cut) => window.stipple.measurements()[0].answer?.cut !== cut && window.stipple.measurements()[0].answer, level.answer.cut);
        const moved = await item();
        assert.notDeepEqual(moved.points[0].integers, level.points[0].integers);
        assert.equal(moved.base.height, low);
        await page.getByRole('button', { name: 'Delete Volume 1' }).click();
        assert.deepEqual(complaints, []);
    });

    test('a profile fills in until it has all points of its corridor, and its file has stations', { skip: unless('downloads') }, async () => {
        await page.getByRole('button', { name: 'Distance', exact: true }).click();
        for (const [i, place] of [{ x: 430, y: 300 }, { x: 620, y: 320 }].entries()) {
            await page.locator('canvas').first().click({ position: place });
            await page.waitForFunction((n) => window.stipple.measurements().at(-1)?.points.length === n, i + 1);
        }
        await page.keyboard.press('Enter');
        const [a, b] = (await page.evaluate(() => window.stipple.measurements())).at(-1).points.map(({ position }) => position);
        await page.getByRole('button', { name: 'Profile', exact: true }).click();
        const panel = page.getByRole('complementary', { name: 'Profile' });
        await panel.getByRole('status').filter({ hasText: 'complete' }).waitFor();
        const width = Number(await page.getByLabel('Width of the profile').inputValue());
        const [dx, dy] = minus(b, a), length = Math.hypot(dx, dy);
        const inside = scan.points.map((p) => scan.placeOf(p)).filter(([x, y]) => {
            const station = ((x - a[0]) * dx + (y - a[1]) * dy) / length, offset = ((x - a[0]) * dy - (y - a[1]) * dx) / length;
            return station >= -1e-9 && station <= length + 1e-9 && Math.abs(offset) <= width / 2 + 1e-9;
        });
        console.log(`  ${inside.length} points in the profile`);
        assert.ok(inside.length > 100);
        assert.equal(Number(await panel.getByRole('status').first().getAttribute('data-points')), inside.length);
        const [download] = await Promise.all([
            page.waitForEvent('download'),
            panel.getByRole('button', { name: 'CSV', exact: true }).click(),
        ]);
        const [head, ...rows] = (await readFile(await download.path(), 'utf8')).trim().split('\n');
        assert.match(head, /,Station,Offset$/);
        assert.equal(rows.length, inside.length);
        await page.getByRole('button', { name: 'Close the profile' }).click();
        assert.deepEqual(complaints, []);
    });

    test('a file of this machine, too', { skip: unless('downloads') }, async () => {
        const own = await openPage(browser, { width: 1000, height: 700 });
        await own.page.goto(host.address);
        await own.page.locator('stipple-clouds input[type=file]').setInputFiles(cloud);
        await settleWithPoints(own.page);
        await own.page.getByRole('button', { name: 'New box' }).click();
        await own.page.locator('[data-box="0"]').waitFor();
        const { centre, halfSize } = (await own.page.evaluate(() => window.stipple.style())).clipBoxes[0];
        const [download] = await Promise.all([
            own.page.waitForEvent('download'),
            own.page.locator('[data-own]').getByRole('button', { name: 'LAS', exact: true }).click(),
        ]);
        const las = await readLas(await download.path());
        const inside = scan.points.filter((p) => scan.placeOf(p).every((value, a) => Math.abs(value - centre[a]) <= halfSize[a]));
        assert.ok(inside.length > 1000);
        assert.deepEqual(text(las.points), text(inside));
        await own.page.close();
    });
});

describe('stipple export --region', () => {
    const exported = async (region, ...options) => {
        const out = join(folder.path, 'region.csv');
        await stipple('export', cloud, '-o', out, '--force', '--region', region, ...options);
        return (await readFile(out, 'utf8')).trim().split(/\r?\n/).slice(1);
    };

    test('takes JSON, or a file of it, together with other options; what is wrong with it is named, and nothing is written', async () => {
        const places = scan.points.map(scan.placeOf), [x, y] = [0, 1].map((axis) => places.reduce((sum, p) => sum + p[axis], 0) / places.length);
        const region = JSON.stringify({ polygon: [[x - 40, y - 30], [x + 50, y - 20], [x, y + 60]] }), file = join(folder.path, 'region.json');
        await writeFile(file, region);
        const inside = await exported(region);
        assert.ok(inside.length > 100, `${inside.length}`);
        assert.deepEqual(await exported(file), inside);
        const low = await exported(region, '--height', '..10');
        assert.ok(low.length > 0 && low.length < inside.length);
        const wrong = [
            ['{"prism": {"eye": null, "forward": [0, 0, -1], "corners": [[0, 0, 1], [1, 0]]}}', /--region, prism\.corners\[1\]: must be 3 numbers/],
            ['{"polygon": [[0, 0]', /--region: it is no JSON/],
            ['absent.json', /absent\.json.*begins with \{, or a file of it/],
        ];
        const none = join(folder.path, 'none.las');
        for (const [text, sentence] of wrong) await assert.rejects(stipple('export', cloud, '-o', none, '--region', text), sentence);
        await assert.rejects(stipple('export', cloud, '-o', none, '--region', '{"line": [[0, 0], [1, 0]], "width": 1}', '--profile', '0,0;1,1', '--width', '1'), /there is another line/);
        await assert.rejects(stat(none));
    });
});

/** In plan, by crossings; edges and corners belong to it. */
function holds(ring, [x, y]) {
    let inside = false;
    for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
        const [x1, y1] = ring[i], [x2, y2] = ring[j];
        if (x === x1 && y === y1) return true;
        if (y1 > y !== y2 > y && x < ((x2 - x1) * (y - y1)) / (y2 - y1) + x1) inside = !inside;
    }
    return inside;
}

/** Cells of that size, each with the mean height of its points; those without get the mean of their eight neighbours' that had one a round before. */
function cutAbove(points, ring, base, cell) {
    const low = (axis) => Math.min(...ring.map((p) => p[axis])), high = (axis) => Math.max(...ring.map((p) => p[axis]));
    const [x0, y0] = [low(0), low(1)], columns = Math.ceil((high(0) - x0) / cell), rows = Math.ceil((high(1) - y0) / cell);
    const sums = new Map();
    for (const [x, y, z] of points) {
        const at = Math.min(rows - 1, Math.floor((y - y0) / cell)) * columns + Math.min(columns - 1, Math.floor((x - x0) / cell));
        const { sum, count } = sums.get(at) ?? { sum: 0, count: 0 };
        sums.set(at, { sum: sum + z - base, count: count + 1 });
    }
    const heights = new Map([...sums].map(([at, { sum, count }]) => [at, sum / count]));
    while (heights.size < columns * rows) {
        const found = [];
        for (let at = 0; at < columns * rows; at++) {
            if (heights.has(at)) continue;
            const near = [];
            for (const dy of [-1, 0, 1])
                for (const dx of [-1, 0, 1]) {
                    const column = (at % columns) + dx, row = Math.floor(at / columns) + dy;
                    if (column >= 0 && column < columns && row >= 0 && row < rows && heights.has(row * columns + column))
                        near.push(heights.get(row * columns + column));
                }
            if (near.length > 0) found.push([at, near.reduce((sum, height) => sum + height, 0) / near.length]);
        }
        for (const [at, height] of found) heights.set(at, height);
    }
    // The share of each cell that lies in the polygon, by a raster of 20 × 20 places.
    const side = 20;
    let volume = 0;
    for (const [at, height] of heights) {
        const [x, y] = [x0 + (at % columns) * cell, y0 + Math.floor(at / columns) * cell];
        let hits = 0;
        for (let i = 0; i < side * side; i++)
            hits += holds(ring, [x + (((i % side) + 0.5) / side) * cell, y + ((Math.floor(i / side) + 0.5) / side) * cell]) ? 1 : 0;
        volume += (hits / side ** 2) * cell * cell * height;
    }
    return volume;
}
