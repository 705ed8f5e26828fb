// The map: longitudes and latitudes against PROJ's, footprint, camera and measurements where they belong, a click goes there;
// without a coordinate system in the cloud's own coordinates; a base layer of the person's choice, and none without one.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { keepScreenshot, launch, openPage, settle, settleWithPoints, unless } from './support/browser.mjs';
import { makeTown, scratchFolder, serve, stipple } from './support/program.mjs';

const www = fileURLToPath(new URL('../../www/', import.meta.url));
const size = { width: 1100, height: 700 };
let browser, folder, server, projectionOf;

before(async () => {
    const { runnerImport } = await import(`${www}node_modules/vite/dist/node/index.js`);
    ({ projectionOf } = (await runnerImport('./src/map/projection.ts', { root: www, configFile: false })).module);
    folder = await scratchFolder();
    const placed = await makeTown(folder.path, { points: 40_000, name: 'placed' });
    const ply = join(folder.path, 'plain.ply'), plain = join(folder.path, 'plain.stipple'); // PLY files name no system
    await stipple('export', placed, '-o', ply);
    await stipple('convert', ply, '-o', plain);
    server = await serve(placed, plain);
    browser = await launch();
});
after(async () => {
    await browser?.close();
    await server?.stop();
    await folder?.cleanUp();
});

async function openCloud(name, query = '') {
    const opened = await openPage(browser, size);
    const requests = [];
    opened.page.on('request', (request) => requests.push(request.url()));
    await opened.page.goto(`${server.address}?cloud=clouds/${name}.stipple${query}`);
    await settleWithPoints(opened.page);
    return { ...opened, requests };
}
async function openMap(page) {
    await page.getByRole('button', { name: 'Map', exact: true }).click();
    await page.locator('stipple-map[data-camera]').waitFor();
    for (;;) {
        const isThere = await page
            .locator('stipple-map')
            .evaluate((map) => map.shapes().some(({ kind }) => kind === 'footprint') && map.screenOf([0, 0]) !== null);
        if (isThere) return;
        await page.waitForTimeout(50);
    }
}
const shapes = (page, kind) =>
    page.locator('stipple-map').evaluate((map, wanted) => map.shapes().filter((shape) => shape.kind === wanted), kind);
const screenOf = (page, place) => page.locator('stipple-map').evaluate((map, at) => map.screenOf(at), place);

describe('longitude and latitude', () => {
    test("are PROJ's to a hundredth of a millimetre, and to two metres where PROJ shifts a datum that counts as WGS 84 here", async () => {
        const systems = JSON.parse(await readFile(new URL('../oracles/lonlat.json', import.meta.url), 'utf8'));
        const worst = {};
        for (const { user, proj, wkt, places } of systems) {
            const projection = projectionOf({ proj, wkt });
            if (user === 'EPSG:31467') {
                assert.equal(projection, undefined, 'the datum of DHDN is not known to proj4 from what the file has');
                continue;
            }
            assert.ok(projection, user);
            worst[user] = 0;
            for (const { place, lonLat } of places) {
                const [longitude, latitude] = projection.toLonLat(place);
                const away = 111_320 * Math.hypot((longitude - lonLat[0]) * Math.cos((lonLat[1] * Math.PI) / 180), latitude - lonLat[1]);
                worst[user] = Math.max(worst[user], away);
                const back = projection.fromLonLat([longitude, latitude], place);
                for (const axis of [0, 1, 2]) assert.ok(Math.abs(back[axis] - place[axis]) < 1e-5, `${user} back: ${back} of ${place}`);
            }
        }
        console.log('  metres from PROJ:', JSON.stringify(worst));
        // NAD83(HARN), which PROJ's database has a shift for, of 1.3 m in Oregon.
        for (const [user, away] of Object.entries(worst)) assert.ok(away < (user === 'EPSG:2994' ? 2 : 1e-5), `${user}: ${away} m`);
    });

    test('systems whose datum is not known are refused, as is what is no system', () => {
        for (const crs of [
            { proj: '+proj=utm +zone=10 +datum=NAD27 +units=m +no_defs', wkt: '' },
            { proj: '+proj=tmerc +lat_0=0 +lon_0=9 +k=1 +x_0=3500000 +ellps=bessel +units=m', wkt: '' },
            { proj: '', wkt: 'LOCAL_CS["Site"]' },
            { proj: '+proj=nothing', wkt: 'nonsense' },
            { proj: '', wkt: '' },
        ])
            assert.equal(projectionOf(crs), undefined, JSON.stringify(crs));
    });
});

describe('the map', () => {
    test('is loaded when it is wanted, and asks no other host', async () => {
        const { page, requests, complaints } = await openCloud('placed');
        const before = requests.filter((url) => url.endsWith('.js')).length;
        assert.ok(!requests.some((url) => /cloud_map|projection/.test(url)), 'the map was loaded with the page');
        await openMap(page);
        assert.ok(requests.some((url) => /cloud_map/.test(url)));
        assert.ok(requests.filter((url) => url.endsWith('.js')).length > before);
        for (const url of requests) assert.ok(url.startsWith(server.address) || url.startsWith('blob:'), url);
        assert.deepEqual(complaints, []);
        await page.close();
    });

    test('shows footprint, camera, view cone and measurements where they are, and a click goes there', { skip: unless('downloads') }, async () => {
        const { page } = await openCloud('placed');
        await openMap(page);
        const info = JSON.parse(await stipple('info', join(folder.path, 'placed.stipple'), '--json'));
        const { proj, wkt } = info.metadata.crs, { min, max } = info.metadata.bounds;
        const projection = projectionOf({ proj, wkt });
        const near = (a, b, slack = 1e-9) => Math.abs(a[0] - b[0]) < slack && Math.abs(a[1] - b[1]) < slack;

        const [footprint] = await shapes(page, 'footprint');
        for (const corner of [[min[0], min[1], 0], [max[0], min[1], 0], [max[0], max[1], 0], [min[0], max[1], 0]])
            assert.ok(footprint.places.some((place) => near(place, projection.toLonLat(corner))), String(corner));
        const camera = await page.evaluate(() => window.stipple.camera());
        const [at] = await shapes(page, 'camera'), [cone] = await shapes(page, 'cone');
        assert.ok(near(at.places[0], projection.toLonLat(camera.position)));
        assert.ok(near(cone.places[0], projection.toLonLat(camera.position)));
        // Both sides of the cone are as far from the direction of view as the picture is wide.
        const half = Math.atan((Math.tan((camera.fovYDegrees * Math.PI) / 360) * size.width) / size.height);
        const plan = cone.places.map((place) => projection.fromLonLat(place, camera.position));
        const bearing = ([x, y]) => Math.atan2(y - camera.position[1], x - camera.position[0]);
        const along = bearing(camera.target);
        for (const side of plan.slice(1)) {
            const off = Math.abs(((bearing(side) - along + 3 * Math.PI) % (2 * Math.PI)) - Math.PI);
            assert.ok(Math.abs(off - half) < 1e-4, `${off} and ${half}`);
        }

        await page.getByRole('button', { name: 'Distance', exact: true }).click();
        for (const [i, x] of [420, 560].entries()) {
            await page.locator('canvas[role=application]').click({ position: { x, y: 330 } });
            await page.waitForFunction((n) => window.stipple.measurements().at(-1)?.points.length === n, i + 1);
        }
        await page.keyboard.press('Enter');
        await page.waitForFunction(() => window.stipple.measurements()[0]?.answer);
        const [measured] = await page.evaluate(() => window.stipple.measurements());
        const [line] = await shapes(page, 'measurement');
        for (const [i, { position }] of measured.points.entries()) assert.ok(near(line.places[i], projection.toLonLat(position)));
        await keepScreenshot(page, 'map');

        // GeoJSON as RFC 7946 wants it, with the exact coordinates beside.
        const [download] = await Promise.all([
            page.waitForEvent('download'),
            page.getByRole('button', { name: 'GeoJSON', exact: true }).click(),
        ]);
        const geojson = JSON.parse(await readFile(await download.path(), 'utf8')), [feature] = geojson.features;
        assert.equal(geojson.crs, undefined);
        assert.equal(feature.geometry.type, 'LineString');
        for (const [i, { position }] of measured.points.entries()) {
            assert.ok(near(feature.geometry.coordinates[i], projection.toLonLat(position), 1e-12));
            assert.deepEqual(feature.properties.coordinates[i], position);
        }
        assert.equal(feature.properties.epsg, 32632);

        // A click: the camera looks at that place, from as far and in the same direction.
        const wanted = [min[0] + 0.3 * (max[0] - min[0]), min[1] + 0.65 * (max[1] - min[1]), camera.target[2]];
        const screen = await screenOf(page, projection.toLonLat(wanted));
        await page.mouse.click(screen.x, screen.y);
        await page.waitForFunction(
            ([x, y]) => {
                const { target } = window.stipple.camera();
                return Math.hypot(target[0] - x, target[1] - y) < 10;
            },
            wanted,
        );
        await page.waitForTimeout(1200); // the flight ends
        const there = await page.evaluate(() => window.stipple.camera());
        for (const axis of [0, 1, 2]) {
            const before = camera.position[axis] - camera.target[axis], now = there.position[axis] - there.target[axis];
            assert.ok(Math.abs(before - now) < 1e-6 * Math.abs(before) + 1e-6);
        }
        assert.equal(there.target[2], camera.target[2]);
        await page.close();
    });

    test('a point says its longitude and latitude', async () => {
        const { page } = await openCloud('placed');
        await page.locator('canvas[role=application]').click({ position: { x: 560, y: 330 } });
        await page.locator('[data-value=Longitude]').waitFor();
        const info = JSON.parse(await stipple('info', join(folder.path, 'placed.stipple'), '--json'));
        const projection = projectionOf(info.metadata.crs);
        const numbers = {};
        for (const name of ['X', 'Y', 'Z', 'Longitude', 'Latitude'])
            numbers[name] = Number(await page.locator(`[data-value=${name}]`).textContent());
        const [longitude, latitude] = projection.toLonLat([numbers.X, numbers.Y, numbers.Z]);
        assert.ok(Math.abs(numbers.Longitude - longitude) <= 5.1e-9 && Math.abs(numbers.Latitude - latitude) <= 5.1e-9);
        await page.close();
    });

    test('a cloud without a coordinate system has a map of its own coordinates, and says so', async () => {
        const { page, complaints } = await openCloud('plain');
        await openMap(page);
        await page.locator('stipple-map').getByText('names no coordinate system').waitFor();
        const { metadata: { bounds } } = JSON.parse(await stipple('info', join(folder.path, 'plain.stipple'), '--json'));
        const [footprint] = await shapes(page, 'footprint');
        assert.ok(footprint.places.some(([x, y]) => x === bounds.min[0] && y === bounds.min[1]));
        const camera = await page.evaluate(() => window.stipple.camera());
        const wanted = [0.5 * (bounds.min[0] + bounds.max[0]), bounds.min[1] + 0.25 * (bounds.max[1] - bounds.min[1])];
        const screen = await screenOf(page, wanted);
        await page.mouse.click(screen.x, screen.y);
        await page.waitForTimeout(1500);
        const { target } = await page.evaluate(() => window.stipple.camera());
        assert.ok(Math.hypot(target[0] - wanted[0], target[1] - wanted[1]) < 10, `${target} instead of ${wanted}`);
        assert.equal(target[2], camera.target[2]);
        await keepScreenshot(page, 'map_own');
        assert.deepEqual(complaints, []);
        await page.close();
    });

    test('a base layer is fetched from where the person says, and what fails is told', async () => {
        const asked = [];
        const pixel = Buffer.from(
            'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==', 'base64');
        const tiles = createServer((request, response) => {
            asked.push(request.url);
            const isThere = request.url.startsWith('/here/');
            response.writeHead(isThere ? 200 : 404, { 'Content-Type': 'image/png', 'Access-Control-Allow-Origin': '*' });
            response.end(isThere ? pixel : '');
        });
        await new Promise((resolve) => tiles.listen(0, '127.0.0.1', resolve));
        const host = `http://127.0.0.1:${tiles.address().port}`;
        try {
            const { page } = await openCloud('placed');
            await openMap(page);
            await page.getByRole('button', { name: 'Base layer' }).click();
            await page.getByLabel('Address of its tiles').fill(`${host}/here/{z}/{x}/{y}.png`);
            await page.getByRole('button', { name: 'Use' }).click();
            for (let i = 0; i < 100 && asked.length === 0; i++) await page.waitForTimeout(50);
            assert.match(asked[0] ?? '', /^\/here\/\d+\/\d+\/\d+\.png$/);
            await page.getByRole('button', { name: 'Base layer' }).click();
            await page.getByLabel('Address of its tiles').fill(`${host}/gone/{z}/{x}/{y}.png`);
            await page.getByRole('button', { name: 'Use' }).click();
            await page.locator('stipple-map').getByText("The base layer can’t be had: 404").waitFor();
            await page.close();
        } finally {
            tiles.close();
            tiles.closeAllConnections();
        }
    });
});
