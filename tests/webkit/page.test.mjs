// The page in the engine of Safari: its pictures and picks against the native program's, its tools by mouse and keys.
import assert from 'node:assert/strict';
import { mkdir, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';

import { compare, coverage, readPng } from '../e2e/support/picture.mjs';
import { makeTown, scratchFolder, serve, stipple } from '../e2e/support/program.mjs';
import { launch } from './webkit.mjs';

let browser, page, folder, server, town;
before(async () => {
    folder = await scratchFolder();
    town = await makeTown(folder.path, { points: 60_000 });
    server = await serve(town);
    browser = await launch();
    ({ page } = browser);
    await page.resize(900, 640);
    await page.goto(server.address);
    await settleWithPoints();
});
after(async () => {
    await browser?.close();
    await server?.stop();
    await folder?.cleanUp();
});

const settleWithPoints = () => page.waitFor(() => {
    const counters = window.stipple?.counters();
    return counters?.settled && counters.frame.pointsDrawn > 0;
});
const settle = () => page.evaluate(() => window.stipple.settled());
const camera = () => page.evaluate(() => window.stipple.camera());
const show = async (style) => {
    await page.evaluate((s) => window.stipple.setStyle(s), style);
    await settle();
};
async function picture() {
    const { width, height, base64 } = await page.evaluate(() => window.stipple.readPixels());
    return { width, height, rgba: Buffer.from(base64, 'base64') };
}
const sizeOf = ({ width, height }) => `${width}x${height}`;

async function keepScreenshot(name) {
    const kept = process.env.STIPPLE_E2E_PICTURES;
    if (!kept) return;
    await mkdir(kept, { recursive: true });
    await writeFile(join(kept, `webkit_${name}.png`), await page.screenshot());
}

describe('in WebKit', () => {
    const plain = { colourMode: 'rgb', shape: 'circle', sizePixels: 3, edl: { enabled: true }, splats: { enabled: false } };
    const looks = {
        'circles, lit': [{}, { share: 0.02, mean: 0.5 }],
        'elevation, squares': [{ colourMode: 'elevation', shape: 'square', sizePixels: 5 }, { share: 0.02, mean: 0.5 }],
        splats: [{ splats: { enabled: true } }, { share: 0.06, mean: 3 }],
    };
    for (const [name, [change, tolerance]] of Object.entries(looks))
        test(`the picture is the native one: ${name}`, async () => {
            const style = { ...plain, ...change };
            await show(style);
            const drawn = await picture(), { frame } = await page.evaluate(() => window.stipple.counters());
            const output = join(folder.path, 'native.png');
            const said = JSON.parse(
                await stipple('render', town, '-o', output, '--backend', 'gles', '--json', '--size', sizeOf(drawn), '--view', JSON.stringify(await camera()), '--style', JSON.stringify(style)),
            );
            const difference = compare(drawn, await readPng(output)), covered = coverage(drawn);
            const [share, mean] = [difference.share / covered, difference.mean / covered];
            console.log(`  differs in ${(100 * share).toFixed(3)} % of the covered pixels, ${mean.toFixed(4)} levels in the mean`);
            await keepScreenshot(name.replace(/\W+/g, '_'));
            assert.equal(frame.pointsDrawn, said.frame.pointsDrawn);
            assert.ok(covered > 0.1 && share <= tolerance.share && mean <= tolerance.mean, `${share}, ${mean}`);
        });

    test('picks are the native ones, with the same values', async () => {
        const style = { ...plain, edl: { enabled: false } };
        await show(style);
        const drawn = await picture(), view = JSON.stringify(await camera());
        let found = 0, equal = 0;
        for (let i = 0; i < 12; i++) {
            const [x, y] = [Math.round(drawn.width * (0.4 + 0.05 * (i % 4))), Math.round(drawn.height * (0.4 + 0.1 * Math.floor(i / 4)))];
            const picked = await page.evaluate((a, b) => window.stipple.pick(a, b), x, y);
            const native = JSON.parse(await stipple('render', town, '--pick', `${x},${y}`, '--size', sizeOf(drawn), '--view', view, '--style', JSON.stringify(style)));
            assert.equal(picked === null, native === null, `at ${x}, ${y}`);
            if (!picked) continue;
            found++;
            if (picked.point.node !== native.point.node || picked.point.index !== native.point.index) continue; // an edge beside a pixel's centre
            equal++;
            assert.deepEqual([picked.integers, picked.values], [native.integers, native.values]);
        }
        console.log(`  ${equal} of ${found}`);
        assert.ok(found >= 8 && equal >= found - 1, `${equal} of ${found}`);
    });

    test('a distance by two clicks is exact', async () => {
        await show({ ...plain, sizePixels: 5 });
        const { width, height } = await picture();
        await page.press('Distance');
        for (const [i, part] of [0.45, 0.6].entries()) {
            await page.click(Math.round(width * part), Math.round(height * 0.55));
            await page.waitFor((n) => window.stipple.measurements().at(-1)?.points.length === n, i + 1);
        }
        await page.focusPicture();
        await page.key('ENTER');
        const item = await page.waitFor(() => window.stipple.measurements().find(({ answer }) => answer));
        const [a, b] = item.points.map(({ integers }) => integers.map(BigInt));
        const { scale } = item.points[0];
        const exact = Math.hypot(...a.map((value, axis) => Number(b[axis] - value) * scale[axis]));
        const value = item.answer.total ?? item.answer.length ?? item.answer.distance;
        assert.ok(Math.abs(value - exact) <= 1e-12 * exact, `${JSON.stringify(item.answer)} for ${exact}`);
        await keepScreenshot('distance');
    });

    test('mouse and keys move the camera; a double click flies', async () => {
        const { width, height } = await picture(), middle = [Math.round(width * 0.6), Math.round(height * 0.5)];
        const moved = async (act) => {
            const before = JSON.stringify(await camera());
            await act();
            await page.waitFor((then) => JSON.stringify(window.stipple.camera()) !== then, before);
            await settle();
        };
        await moved(() => page.drag(middle, [middle[0] + 80, middle[1] + 30]));
        await page.focusPicture();
        await moved(() => page.key('ARROW_LEFT'));
        await moved(() => page.doubleClick(...middle));
    });

    test('a clip box hides what is outside it', async () => {
        await page.press('New box');
        await page.waitFor(() => window.stipple.style().clipBoxes.length === 1);
        await settle();
        const { frame } = await page.evaluate(() => window.stipple.counters());
        assert.ok(frame.pointsHidden > 0 || frame.nodesClipped > 0, JSON.stringify(frame));
        await keepScreenshot('box');
    });

    test('a cloud that is not there is said', async () => {
        await page.goto(`${server.address}?cloud=clouds/none.stipple`);
        const text = await page.waitFor(() => {
            const texts = (root) => [...root.querySelectorAll('*')].flatMap((element) => [...(element.shadowRoot ? [element.shadowRoot.textContent, ...texts(element.shadowRoot)] : [])]);
            return texts(document).find((said) => /there is no such file on the server/.test(said));
        });
        assert.match(text, /\bhttp:\/\/\S+none\.stipple: there is no such file on the server/);
    });
});
