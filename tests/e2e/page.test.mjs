// The page against the real server: it opens, draws what the native program draws, obeys its controls, rests
// when nothing changes, and says what went wrong.
import assert from 'node:assert/strict';
import { copyFile, readFile, rename } from 'node:fs/promises';
import { createServer } from 'node:http';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';

import {
    counters,
    keepScreenshot,
    launch,
    openPage,
    readPixels,
    settle,
    settleWithPoints,
} from './support/browser.mjs';
import { compare, coverage, readPng } from './support/picture.mjs';
import { makeTown, scratchFolder, serve, stipple } from './support/program.mjs';

let browser, folder, town, server;

before(async () => {
    folder = await scratchFolder();
    town = await makeTown(folder.path);
    server = await serve(town);
    browser = await launch();
});

after(async () => {
    await browser?.close();
    await server?.stop();
    await folder?.cleanUp();
});

/** The page with the town, drawn whole. */
async function openTown(options) {
    const opened = await openPage(browser, options);
    await opened.page.goto(server.address);
    await settleWithPoints(opened.page);
    return opened;
}

async function townBounds() {
    const answer = await fetch(new URL('/api/v1/clouds', server.address));
    const [{ id }] = (await answer.json()).clouds;
    const cloud = await fetch(new URL(`/api/v1/clouds/${id}`, server.address));
    return (await cloud.json()).bounds;
}

function report(what, figures) {
    console.log(`  ${what}: ${JSON.stringify(figures)}`);
}

describe('opening', () => {
    test("the server's cloud opens and is drawn, and nothing complains", async () => {
        const { page, complaints } = await openPage(browser);
        const start = performance.now();
        await page.goto(server.address);
        await page.waitForFunction(() => window.stipple?.counters().frame.pointsDrawn > 0);
        const firstPicture = performance.now() - start;
        const { frame, session } = await settleWithPoints(page);
        const whole = performance.now() - start;

        const covered = coverage(await readPixels(page));
        report('opened', {
            firstPictureMs: Math.round(firstPicture),
            wholePictureMs: Math.round(whole),
            requests: session.requests,
            bytesReceived: session.bytesReceived,
            pointsDrawn: frame.pointsDrawn,
            covered: Number(covered.toFixed(3)),
        });
        assert.ok(frame.complete);
        assert.ok(covered > 0.1, `only ${covered} of the canvas is covered`);
        await keepScreenshot(page, 'opened');
        assert.deepEqual(complaints, []);
        await page.close();
    });

    test('a file that is dropped on the page opens without the server', async () => {
        const { page, complaints } = await openPage(browser);
        await page.goto(`${server.address}?cloud=`);
        await page.waitForFunction(() => window.stipple !== undefined);
        const before = await counters(page);
        const base64 = (await readFile(town)).toString('base64');
        const dropped = await page.evaluateHandle((text) => {
            const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
            const transfer = new DataTransfer();
            transfer.items.add(new File([bytes], 'dropped.stipple'));
            return transfer;
        }, base64);
        await page.dispatchEvent('stipple-viewer', 'dragenter', { dataTransfer: dropped });
        await page.getByText('Drop a .stipple file to open it').waitFor();
        await page.dispatchEvent('stipple-viewer', 'drop', { dataTransfer: dropped });

        const { frame } = await settleWithPoints(page);
        assert.equal(before.frame.pointsDrawn, 0);
        assert.ok(frame.pointsDrawn > 10_000);
        await page.getByText('dropped.stipple').waitFor();
        assert.deepEqual(complaints, []);
        await page.close();
    });

    test('a file that is chosen with the button opens', async () => {
        const { page } = await openPage(browser);
        await page.goto(`${server.address}?cloud=`);
        await page.locator('stipple-clouds input[type=file]').setInputFiles(town);
        const { frame } = await settleWithPoints(page);
        assert.ok(frame.pointsDrawn > 10_000);
        await page.close();
    });
});

describe('the picture', () => {
    const size = { width: 640, height: 480 };
    // Both draw with the same shaders, but the drivers place points on sub-pixel grids of their own (1/16 and
    // 1/256 px), so an edge near a pixel's centre may fall on either side of it: the more edge there is in the
    // picture, the more pixels differ, by whatever lies beside them. Both limits are of the pixels that points cover,
    // so that they mean the same however much of the picture is background.
    const looks = {
        'RGB, circles of 3 px': {
            style: { colourMode: 'rgb', sizePixels: 3 },
            tolerance: { share: 0.02, mean: 0.7 },
        },
        'elevation, squares of 5 px': {
            style: { colourMode: 'elevation', gradient: 'turbo', shape: 'square', sizePixels: 5 },
            tolerance: { share: 0.095, mean: 2.5 },
        },
        'intensity, world sizes, no EDL': {
            style: { colourMode: 'intensity', sizeMode: 'world', sizeWorld: 0.5, edl: { enabled: false } },
            tolerance: { share: 0.07, mean: 3.5 },
        },
        'continuous detail, as wide as the spacing': {
            style: {
                detail: { mode: 'continuous', spacingPixels: 3, peripheralFalloff: 0.3 },
                sizeMode: 'spacing',
                edl: { enabled: false },
            },
            tolerance: { share: 0.01, mean: 0.6 },
        },
        'classes, of them ground hidden, second returns filtered': {
            style: {
                colourMode: 'classification',
                sizePixels: 3,
                hiddenClasses: [2],
                filters: [{ attribute: 'Return Number', max: 1 }],
            },
            tolerance: { share: 0.02, mean: 0.7 },
        },
        'a turned clip box': {
            style: (bounds) => ({
                sizePixels: 3,
                clipBoxes: [
                    {
                        mode: 'hideOutside',
                        centre: bounds.min.map((least, axis) => (least + bounds.max[axis]) / 2),
                        halfSize: bounds.min.map((least, axis) => (bounds.max[axis] - least) / 4),
                        rotation: [0, 0, 0.3827, 0.9239],
                    },
                ],
            }),
            tolerance: { share: 0.02, mean: 0.7 },
        },
        'high-quality splats': {
            style: { splats: { enabled: true }, sizePixels: 4, edl: { enabled: false } },
            tolerance: { share: 0.02, mean: 0.7 },
        },
        'adaptive sizes': {
            style: { sizeMode: 'adaptive', edl: { enabled: false } },
            tolerance: { share: 0.03, mean: 2 },
        },
        'paraboloids': {
            style: { shape: 'paraboloid', sizePixels: 6, edl: { enabled: false } },
            tolerance: { share: 0.02, mean: 0.7 },
        },
        'expanded late': {
            // A centre that falls into another pixel takes its whole disc with it.
            style: { delayedExpansion: 'on', sizePixels: 3, edl: { enabled: false } },
            tolerance: { share: 0.06, mean: 3 },
        },
    };

    /** What the page shows of `cloud` in that style is what the native program draws of it. */
    async function checkAgainstNative(page, cloud, style, tolerance) {
        await page.evaluate((s) => window.stipple.setStyle(s), style);
        await settle(page);
        const drawn = await readPixels(page);
        const camera = await page.evaluate(() => window.stipple.camera());
        const { frame } = await counters(page);

        const output = join(folder.path, 'native.png');
        const said = JSON.parse(
            await stipple(
                'render', cloud, '-o', output, '--backend', 'gles', '--json',
                '--size', `${size.width}x${size.height}`,
                '--view', JSON.stringify(camera),
                '--style', JSON.stringify(style),
            ),
        );
        const difference = compare(drawn, await readPng(output));
        const covered = coverage(drawn);
        const share = difference.share / covered;
        const mean = difference.mean / covered;
        report('differs from native', { ...difference, covered, shareOfCovered: share, meanOfCovered: mean });
        assert.equal(frame.pointsDrawn, said.frame.pointsDrawn);
        assert.equal(frame.nodesDrawn, said.frame.nodesDrawn);
        assert.ok(share <= tolerance.share, `${difference.differing} pixels differ`);
        assert.ok(mean <= tolerance.mean, `the mean difference is ${mean}`);
        return drawn;
    }

    for (const [name, { style: wanted, tolerance }] of Object.entries(looks)) {
        test(`equals the native GLES picture: ${name}`, async () => {
            const { page } = await openTown(size);
            const style = typeof wanted === 'function' ? wanted(await townBounds()) : wanted;
            await checkAgainstNative(page, town, style, tolerance);
            await page.close();
        });
    }

    test('draws discs along normals, which are fetched for nothing else, as the native program does', async () => {
        const oriented = await makeTown(folder.path, { points: 60_000, name: 'oriented', normals: true });
        const host = await serve(oriented);
        try {
            const { page, complaints } = await openPage(browser, size);
            await page.goto(host.address);
            const before = await settleWithPoints(page);
            const circles = await readPixels(page);
            await page.getByLabel('Shape: Disc').check();
            const { session } = await settle(page);
            assert.ok(session.attributeBytesFetched > before.session.attributeBytesFetched);
            const look = { shape: 'disc', sizePixels: 6, edl: { enabled: false } };
            const tolerance = { share: 0.02, mean: 0.7 };
            const discs = await checkAgainstNative(page, oriented, look, tolerance);
            await keepScreenshot(page, 'discs');
            assert.ok(compare(circles, discs).share > 0.01, 'discs look like the circles before them');
            const further = [{ splats: { enabled: true } }, { splats: { enabled: false }, delayedExpansion: 'on' }];
            for (const change of further)
                await checkAgainstNative(page, oriented, { ...look, ...change }, { share: 0.06, mean: 3 });
            assert.deepEqual(complaints, []);
            await page.close();
        } finally {
            await host.stop();
        }
    });

    test('offers discs where a cloud has normals, and says when one has none', async () => {
        const { page } = await openTown();
        assert.equal(await page.getByLabel('Shape: Disc').count(), 0);
        await page.evaluate(() => window.stipple.setStyle({ shape: 'disc' }));
        await page.getByText(/has no normals.*circles, not as discs/).first().waitFor();
        assert.equal(await page.getByLabel('Shape: Disc').count(), 1);
        await page.close();
    });

    test('follows the budget', async () => {
        const { page } = await openTown();
        const before = await counters(page);
        await page.getByLabel('Budget').fill('0'); // the slider's lower end: 10,000 points
        const after = await settle(page);
        assert.ok(after.frame.pointsDrawn <= 10_000);
        assert.ok(after.frame.pointsDrawn < before.frame.pointsDrawn);
        assert.ok(after.frame.pointsDrawn > 0);
        assert.ok(after.frame.nodesSelected < before.frame.nodesSelected);
        await page.close();
    });

    test('follows the colour, the size and the light', async () => {
        const { page } = await openTown();
        const shareChangedBy = async (act) => {
            const from = await readPixels(page);
            await act();
            await settle(page);
            return compare(from, await readPixels(page)).share;
        };
        const shares = {
            colour: await shareChangedBy(() => page.getByLabel('Colour by').selectOption('elevation')),
            gradient: await shareChangedBy(() => page.getByLabel('Gradient').selectOption('inferno')),
            size: await shareChangedBy(() => page.getByLabel('Size', { exact: true }).fill('700')),
            shape: await shareChangedBy(() => page.getByLabel('Shape: Square').check()),
            light: await shareChangedBy(() => page.getByLabel('Eye-dome lighting').uncheck()),
            view: await shareChangedBy(() => page.getByRole('button', { name: 'Top' }).click()),
            projection: await shareChangedBy(() => page.getByLabel('Projection: Ortho.').check()),
        };
        report('share of pixels changed', shares);
        for (const [control, share] of Object.entries(shares))
            assert.ok(share > 0.005, `${control} changed ${share} of the picture`);
        await keepScreenshot(page, 'controls');
        await page.close();
    });
});

describe('colour and hiding', () => {
    test('classes are named and can be hidden; filters and clip boxes take effect, wrong ones are said', async () => {
        const { page } = await openTown();
        await page.getByLabel('Colour by').selectOption('classification');
        await settle(page);
        const all = coverage(await readPixels(page));
        const ground = page.getByLabel('Class 2: Ground');
        await ground.uncheck();
        await settle(page);
        const hidden = await counters(page);
        const withoutGround = coverage(await readPixels(page));
        assert.ok(hidden.frame.pointsHidden > 0);
        assert.ok(withoutGround < 0.95 * all);
        await keepScreenshot(page, 'classes');
        await ground.check();
        await settle(page);
        assert.equal(coverage(await readPixels(page)), all);

        await page.getByLabel('Show by').selectOption('Return Number');
        await page.getByLabel('From, to: least').fill('2');
        await page.getByLabel('From, to: least').press('Enter');
        await settle(page);
        assert.ok(coverage(await readPixels(page)) < 0.5 * all);
        await page.getByLabel('Show by').selectOption('');
        await settle(page);

        const { min, max } = await townBounds();
        const centre = min.map((least, axis) => (least + max[axis]) / 2);
        const halfSize = min.map((least, axis) => (max[axis] - least) / 8);
        const boxes = page.getByRole('textbox', { name: 'Clip boxes' });
        await boxes.fill(JSON.stringify([{ mode: 'hideOutside', centre, halfSize }]));
        await boxes.blur();
        const clipped = await settle(page);
        assert.ok(clipped.frame.nodesClipped > 0);
        assert.ok(coverage(await readPixels(page)) < 0.5 * all);
        await boxes.fill('[{"mode": "hideOutside"');
        await boxes.blur();
        await page.getByRole('alert').first().waitFor();
        assert.match(await page.getByRole('alert').first().textContent(), /clip boxes/);
        await page.close();
    });
});

describe('picking', () => {
    const size = { width: 640, height: 480 };

    test('a pick finds the point that the native program finds, with the same values', async () => {
        const { page } = await openTown(size);
        await page.evaluate(() => window.stipple.setStyle({ sizePixels: 3 }));
        await settle(page);
        const camera = await page.evaluate(() => window.stipple.camera());
        let equal = 0, found = 0;
        const places = Array.from({ length: 16 }, (_, i) => ({ x: 130 + 97 * (i % 4) + i, y: 120 + 71 * Math.floor(i / 4) + i }));
        for (const { x, y } of places) {
            const picked = await page.evaluate(([a, b]) => window.stipple.pick(a, b), [x, y]);
            const native = JSON.parse(
                await stipple(
                    'render', town, '--pick', `${x},${y}`, '--size', `${size.width}x${size.height}`,
                    '--view', JSON.stringify(camera), '--style', '{"sizePixels": 3}',
                ),
            );
            assert.equal(picked === null, native === null, `at ${x}, ${y}`);
            if (!picked) continue;
            found += 1;
            // A browser's sub-pixel grid is coarser: an edge may fall on the other side of a pixel's centre.
            if (picked.point.node !== native.point.node || picked.point.index !== native.point.index) continue;
            equal += 1;
            assert.deepEqual(picked.integers, native.integers);
            assert.deepEqual(picked.position, native.position);
            assert.deepEqual(picked.values, native.values);
        }
        report('picks', { places: places.length, found, equal });
        assert.ok(found >= 8);
        assert.ok(equal >= found - 1, `${equal} of ${found} are the native program's`);
        await page.close();
    });

    test('a click shows the point and all it has, Escape closes it; a drag shows none', async () => {
        const { page, complaints } = await openTown(size);
        const panel = page.getByRole('complementary', { name: 'Point' });
        await page.mouse.move(320, 240);
        await page.mouse.down();
        await page.mouse.move(340, 250, { steps: 4 });
        await page.mouse.up();
        await page.waitForTimeout(300);
        assert.equal(await panel.count(), 0);
        await settle(page);

        await page.locator('canvas').click({ position: { x: 380, y: 260 } });
        await panel.waitFor();
        const picked = await page.evaluate(() => window.stipple.pick(380, 260));
        assert.equal(await panel.locator('[data-value=X]').textContent(), String(picked.position[0]));
        assert.equal(
            await panel.locator('[data-value=Classification]').textContent(),
            String(picked.values.Classification),
        );
        assert.equal(picked.cloudName.length > 0, true);
        await keepScreenshot(page, 'picked');
        await page.locator('canvas').press('Escape');
        await panel.waitFor({ state: 'detached' });
        assert.equal(await page.evaluate(() => window.stipple.pick(2, 2, 0)), null);
        assert.deepEqual(complaints, []);
        await page.close();
    });
});

describe('moving', () => {
    const camera = (page) => page.evaluate(() => window.stipple.camera());

    test('mouse, wheel and keys move the camera', async () => {
        const { page } = await openTown();
        const start = await camera(page);
        await page.mouse.move(450, 240);
        await page.mouse.down();
        await page.mouse.move(520, 260, { steps: 5 });
        await page.mouse.up();
        const orbited = await camera(page);
        assert.notDeepEqual(orbited.position, start.position);
        assert.deepEqual(orbited.target, start.target);

        await page.mouse.down({ button: 'right' });
        await page.mouse.move(480, 220, { steps: 5 });
        await page.mouse.up({ button: 'right' });
        const panned = await camera(page);
        assert.notDeepEqual(panned.target, orbited.target);

        const distance = (c) => Math.hypot(...c.position.map((value, axis) => value - c.target[axis]));
        await page.mouse.wheel(0, -400);
        await page.waitForFunction((old) => window.stipple.camera().position[0] !== old, panned.position[0]);
        assert.ok(distance(await camera(page)) < distance(panned));

        await page.locator('canvas').press('1');
        await settle(page);
        const top = await camera(page);
        assert.ok(Math.abs(top.position[0] - top.target[0]) < 1e-6 * distance(top));
        await page.close();
    });

    test('a still camera draws no frame and asks for nothing', async () => {
        const { page } = await openTown();
        await page.waitForTimeout(300);
        const before = await counters(page);
        await page.waitForTimeout(1500);
        const after = await counters(page);
        assert.deepEqual(after, before);
        assert.equal(after.settled, true);
        report('after 1.5 s of rest', { framesDrawn: after.session.framesDrawn, requests: after.session.requests });

        await page.evaluate(() => window.stipple.setCamera(window.stipple.camera()));
        await settle(page);
        const same = await counters(page);
        assert.equal(same.session.framesDrawn, before.session.framesDrawn);
        await page.close();
    });

    test('a frame time draws coarser while the camera moves, and all of it once it rests', async () => {
        const { page } = await openTown();
        const whole = await readPixels(page);
        const { frame: before } = await counters(page);
        await page.evaluate(() => window.stipple.setLimits({ frameMilliseconds: 5 }));
        await settle(page);
        const fewest = await page.evaluate(async () => {
            const start = window.stipple.camera();
            let least = Infinity, coarsest = 1;
            for (let i = 1; i <= 40; i++) {
                const position = start.position.map((value, axis) => value + (start.target[axis] - value) * 0.002 * i);
                window.stipple.setCamera({ position });
                await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
                const { frame } = window.stipple.counters();
                least = Math.min(least, frame.pointsDrawn);
                coarsest = Math.max(coarsest, frame.coarserForTime);
            }
            window.stipple.setCamera(start);
            return { least, coarsest };
        });
        report('while it moved', { ...fewest, atRest: before.pointsDrawn });
        assert.ok(fewest.coarsest > 1.2);
        assert.ok(fewest.least < 0.8 * before.pointsDrawn);
        await page.waitForFunction(() => window.stipple.counters().frame.coarserForTime === 1);
        await settle(page);
        assert.equal((await counters(page)).frame.pointsDrawn, before.pointsDrawn);
        assert.equal(compare(whole, await readPixels(page)).differing, 0);
        const rested = await counters(page);
        await page.waitForTimeout(800);
        assert.equal((await counters(page)).session.framesDrawn, rested.session.framesDrawn);
        await page.close();
    });

    test('a lost WebGL context is said, and comes back with the picture', async () => {
        const { page } = await openTown();
        const before = await readPixels(page);
        await page.evaluate(async () => {
            const canvas = document.querySelector('stipple-viewer').shadowRoot.querySelector('canvas');
            window.loss = canvas.getContext('webgl2').getExtension('WEBGL_lose_context');
            window.loss.loseContext();
        });
        const said = page.getByText('The browser has taken the graphics away');
        await said.waitFor();
        await keepScreenshot(page, 'context_lost');
        await page.evaluate(() => window.loss.restoreContext());
        await said.waitFor({ state: 'detached' });
        await settle(page);
        assert.equal(compare(before, await readPixels(page)).differing, 0);
        await page.close();
    });
});

describe('what goes wrong is said in words', () => {
    const alert = async (address, options = {}) => {
        const { page } = await openPage(browser);
        await options.prepare?.(page);
        await page.goto(address);
        const box = page.getByRole('alert').first();
        await box.waitFor();
        const text = await box.textContent();
        await keepScreenshot(page, options.name ?? 'alert');
        await page.close();
        return text;
    };

    test('a cloud that is not there', async () => {
        const text = await alert(`${server.address}?cloud=absent.stipple`, { name: 'absent' });
        assert.match(text, /absent\.stipple: there is no such file on the server/);
    });

    test('a file that is no cloud', async () => {
        const text = await alert(`${server.address}?cloud=index.html`);
        assert.match(text, /index\.html/);
    });

    test('a server that ignores Range', async () => {
        const bytes = await readFile(town);
        const plain = createServer((_, response) => {
            response.writeHead(200, { 'content-length': bytes.length, 'access-control-allow-origin': '*' });
            response.end(bytes);
        });
        await new Promise((resolve) => plain.listen(0, '127.0.0.1', resolve));
        const cloud = `http://127.0.0.1:${plain.address().port}/town.stipple`;
        const text = await alert(`${server.address}?cloud=${encodeURIComponent(cloud)}`);
        assert.match(text, /the server ignores Range and sends the whole file/);
        plain.closeAllConnections();
        await new Promise((resolve) => plain.close(resolve));
    });

    test('a server that is not there', async () => {
        const cloud = encodeURIComponent('http://127.0.0.1:9/town.stipple');
        const text = await alert(`${server.address}?cloud=${cloud}`);
        assert.match(text, /the server can't be reached/);
    });

    test('a browser without WebGL2', async () => {
        const text = await alert(server.address, {
            prepare: (page) =>
                page.addInitScript(() => {
                    const getContext = HTMLCanvasElement.prototype.getContext;
                    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
                        return kind === 'webgl2' ? null : getContext.call(this, kind, ...rest);
                    };
                }),
        });
        assert.match(text, /gives the page no WebGL2.*newer browser/);
    });

    test('a file that is replaced while it is looked at', async () => {
        const replaced = join(folder.path, 'replaced.stipple');
        await copyFile(town, replaced);
        const other = await makeTown(folder.path, { seed: 2, name: 'other', points: 70_000 });
        const own = await serve(replaced);
        const { page } = await openPage(browser);
        // A budget this small leaves most of the file unread.
        await page.addInitScript(() => {
            const open = setInterval(() => {
                if (!window.stipple) return;
                clearInterval(open);
                window.stipple.setLimits({ pointBudget: 1000 });
            }, 1);
        });
        await page.goto(own.address);
        await page.waitForFunction(() => window.stipple?.counters().frame.nodesKnown > 0);
        await page.evaluate(() => window.stipple.settled());
        const camera = await page.evaluate(() => window.stipple.camera());
        await page.getByText('150,000 points').waitFor();
        await rename(other, replaced);
        await page.evaluate(() => window.stipple.setLimits({ pointBudget: 1_000_000 }));
        // It is opened anew, once, and looked at from where one was.
        await page.getByText('70,000 points').first().waitFor();
        const { frame } = await settleWithPoints(page);
        assert.ok(frame.complete);
        assert.equal(await page.getByText('150,000 points').count(), 0);
        assert.deepEqual(await page.evaluate(() => window.stipple.camera()), camera);
        await keepScreenshot(page, 'replaced');
        await page.close();
        await own.stop();
    });
});
