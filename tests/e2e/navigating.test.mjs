// The ways to move the camera, by mouse and keys: what is under the pointer stays under it.
import assert from 'node:assert/strict';
import { after, before, beforeEach, describe, test } from 'node:test';

import { counters, keepScreenshot, settle, unless } from './support/browser.mjs';
import { minus, norm, openTownPage } from './support/town_page.mjs';

let town, page, complaints, first;

before(async () => {
    town = await openTownPage({ width: 900, height: 600 });
    ({ page, complaints } = town);
    first = await camera();
});

after(() => town?.close());

const camera = () => page.evaluate(() => window.stipple.camera());
const pick = (x, y) => page.evaluate(([a, b]) => window.stipple.pick(a, b), [x, y]);
const mode = (name) => page.getByRole('radio', { name: `Move: ${name}` }).check({ force: true });

/** Where a world point is in a picture of 900 × 600 pixels. */
function pixelOf({ position, target, up, fovYDegrees }, world) {
    const unit = (v) => v.map((value) => value / norm(v));
    const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
    const dot = (a, b) => a.reduce((sum, value, axis) => sum + value * b[axis], 0);
    const forward = unit(minus(target, position)), right = unit(cross(forward, up)), above = cross(right, forward);
    const away = minus(world, position), depth = dot(away, forward);
    const scale = 300 / (Math.tan((fovYDegrees * Math.PI) / 360) * depth);
    return { x: 450 + dot(away, right) * scale, y: 300 - dot(away, above) * scale };
}
/** Where the camera is once it has stood still for longer than it takes to be remembered. */
async function rest() {
    for (;;) {
        const before = JSON.stringify(await camera());
        await page.waitForTimeout(800);
        const now = await camera();
        if (JSON.stringify(now) === before) return now;
    }
}
const apart = (a, b) => Math.hypot(a.x - b.x, a.y - b.y);

async function drag(from, to, button = 'left') {
    await page.mouse.move(from.x, from.y);
    await page.mouse.down({ button });
    await page.waitForTimeout(400); // what is under the pointer is known
    await page.mouse.move(to.x, to.y, { steps: 6 });
    await page.mouse.up({ button });
    await settle(page);
}

describe('moving about', () => {
    beforeEach(async () => {
        await mode('Orbit');
        await page.evaluate((to) => window.stipple.setCamera(to), first);
        await settle(page);
        await page.waitForTimeout(700); // it is remembered
    });

    test('the ground follows the pointer; the other button turns about what is under it', async () => {
        await mode('Earth');
        const place = (await pick(480, 260)).position;
        await drag({ x: 480, y: 260 }, { x: 560, y: 330 });
        const moved = await camera();
        assert.ok(apart(pixelOf(moved, place), { x: 560, y: 330 }) < 0.5, JSON.stringify(pixelOf(moved, place)));
        assert.ok(Math.abs(moved.position[2] - first.position[2]) < 1e-6);

        const pivot = (await pick(560, 330)).position, seen = pixelOf(moved, pivot);
        await drag({ x: 560, y: 330 }, { x: 640, y: 350 }, 'right');
        const turned = await camera();
        assert.ok(apart(pixelOf(turned, pivot), seen) < 0.5);
        assert.ok(norm(minus(turned.position, moved.position)) > 1);
        assert.ok(Math.abs(norm(minus(turned.position, pivot)) / norm(minus(moved.position, pivot)) - 1) < 1e-9);
    });

    test('what is dragged across the view stays under the pointer, and the wheel goes to it', async () => {
        const place = (await pick(520, 280)).position;
        await drag({ x: 520, y: 280 }, { x: 470, y: 340 }, 'right');
        assert.ok(apart(pixelOf(await camera(), place), { x: 470, y: 340 }) < 0.5);

        await page.mouse.move(470, 340);
        for (let i = 0; i < 4; i++) {
            await page.mouse.wheel(0, -100);
            await page.waitForTimeout(150);
        }
        await settle(page);
        const near = await camera();
        assert.ok(norm(minus(near.position, place)) < 0.7 * norm(minus(first.position, place)));
        assert.ok(apart(pixelOf(near, place), { x: 470, y: 340 }) < 20); // the first step went by the target's depth
    });

    test('a double click flies to the point, U goes back, shift U forth, F shows all', { skip: unless('double clicks') }, async () => {
        const { position: place } = await pick(500, 250);
        await page.locator('canvas').dblclick({ position: { x: 500, y: 250 } });
        await page.waitForFunction(
            (wanted) => Math.hypot(...window.stipple.camera().target.map((v, i) => v - wanted[i])) < 1e-6,
            place,
        );
        const near = await rest();
        assert.ok(apart(pixelOf(near, place), { x: 450, y: 300 }) < 1e-3);
        const reached = (wanted) =>
            page.waitForFunction((json) => JSON.stringify(window.stipple.camera()) === json, JSON.stringify(wanted));
        await page.locator('canvas').press('u');
        await reached(first);
        await page.locator('canvas').press('Shift+U');
        await reached(near);
        await page.locator('canvas').press('f');
        const all = await rest();
        assert.ok(norm(minus(all.target, all.position)) > 1.5 * norm(minus(near.target, near.position)));
        await page.getByRole('button', { name: 'town', exact: true }).click();
        assert.ok(norm(minus((await rest()).position, all.position)) < 1e-6);
        assert.equal(await page.getByRole('button', { name: 'Back' }).isEnabled(), true);
        await keepScreenshot(page, 'navigated');
    });

    test('a flight that begins while another is under way takes its place, and goes its whole way', async () => {
        const ended = await page.evaluate(async () => {
            const frame = () => new Promise(requestAnimationFrame);
            const canvas = document.querySelector('stipple-viewer').shadowRoot.querySelector('canvas');
            const press = (key) => canvas.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true }));
            window.stipple.setCamera({ target: window.stipple.camera().position.map((v, i) => v + [30, 30, -40][i]) });
            press('f');
            const start = performance.now();
            while (performance.now() - start < 600) await frame();
            press('f'); // 200 ms before the first would have ended
            let changed = 0, last = JSON.stringify(window.stipple.camera());
            const second = performance.now();
            for (;;) {
                await frame();
                const now = JSON.stringify(window.stipple.camera());
                if (now !== last) changed = performance.now() - second;
                last = now;
                if (performance.now() - second > 1500) return changed;
            }
        });
        assert.ok(ended > 600, `it ended after ${ended} ms`);
    });

    test('one walks while a key is held, looks around by dragging, and rests when it is let go', async () => {
        await mode('Fly');
        await page.mouse.move(480, 300);
        await page.locator('canvas').focus();
        await page.keyboard.down('w');
        await page.waitForTimeout(600);
        await page.keyboard.up('w');
        const walked = await camera(), way = minus(walked.position, first.position);
        const view = minus(first.target, first.position);
        const along = way.reduce((sum, value, axis) => sum + value * view[axis], 0) / norm(way) / norm(view);
        assert.ok(norm(way) > 1, String(norm(way)));
        assert.ok(along > 0.999999, String(along));

        await settle(page);
        const before = (await counters(page)).frame;
        await page.waitForTimeout(600);
        assert.deepEqual((await camera()).position, walked.position);
        assert.deepEqual((await counters(page)).frame.pointsDrawn, before.pointsDrawn);

        await drag({ x: 480, y: 300 }, { x: 530, y: 320 });
        const looked = await camera();
        assert.deepEqual(looked.position, walked.position);
        assert.ok(norm(minus(looked.target, walked.target)) > 1);
        // Keys of walking do nothing in the other modes.
        await mode('Orbit');
        await page.locator('canvas').press('w');
        await page.waitForTimeout(200);
        assert.deepEqual((await camera()).position, walked.position);
        assert.deepEqual(complaints, []);
    });
});
