// Steps back and forth through what is done with the tools, by mouse, fingers and keys: each brings the scene that was there.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';

import { settle } from './support/browser.mjs';
import { focused } from './support/keyboard.mjs';
import { keyHand, measurements, mouseHand, randomFrom, touchHand } from './support/tool_driver.mjs';
import { openTownPage } from './support/town_page.mjs';

let town, page, mouse, fingers, keys;

before(async () => {
    town = await openTownPage({ width: 760, height: 460 }, { points: 20_000 });
    ({ page } = town);
    const random = randomFrom(5);
    mouse = mouseHand(page, random);
    fingers = await touchHand(page, random);
    keys = keyHand(page, random);
});

after(() => town?.close());

const button = (name) => page.getByRole('button', { name, exact: true });
/** All that is set up, but for the camera. */
const scene = () =>
    page.evaluate(() => {
        const { camera, ...rest } = document.querySelector('stipple-viewer').getScene();
        return JSON.parse(JSON.stringify(rest));
    });
/** Polls, for what is done with a click may be there a few frames later. */
async function becomes(expected, why) {
    let now;
    for (let tries = 0; tries < 100; tries++) {
        now = await scene();
        if (JSON.stringify(now) === JSON.stringify(expected)) return;
        await page.waitForTimeout(30);
    }
    assert.deepEqual(now, expected, why);
}
async function another(before, why) {
    for (let tries = 0; tries < 200; tries++) {
        const now = await scene();
        if (JSON.stringify(now) !== JSON.stringify(before)) return;
        await page.waitForTimeout(30);
    }
    assert.fail(`${why}: nothing has changed`);
}
async function enter(label, value) {
    await page.getByLabel(label).fill(value);
    await page.getByLabel(label).press('Enter');
}
async function highlight(item) {
    await page.locator(item).getByLabel('Mode').focus();
    await page.keyboard.press('End');
}
const handle = (selector) => page.locator(selector).first();

const steps = [
    ['a new box', () => mouse.press(button('New box'))],
    ['its size', () => enter('Size z of Box 1', '31.5')],
    ['its middle, by a finger', () => fingers.drag(handle('stipple-clip-overlay [data-handle=centre]'), 20, 15)],
    ['its mode', () => highlight('[data-box="0"]')],
    ['a polygon on the screen', () => mouse.polygon('Polygon on the screen', 4)],
    ['its height', () => enter('Highest height of Polygon 1', '40')],
    ['it is only highlighted', () => highlight('li[data-region="0"]')],
    ['a distance', () => mouse.measure('Distance', 2)],
    ['its end, by the arrow keys', async () => {
        await page.locator('[data-kind=distance] .handle').last().focus();
        await page.keyboard.press('ArrowUp');
    }],
    ['an angle', () => keys.measure('Angle', 3)],
    ['the distance is gone', () => button('Delete Distance 1').click()],
    ['an annotation', async () => {
        await button('New annotation').click();
        await page.mouse.click(500, 230);
    }],
    ['its text', async () => {
        await page.getByLabel('Text (Markdown)').click();
        await page.keyboard.type('Here it leaks.');
        await page.keyboard.press('Tab');
    }],
    ['a place on the camera path', () => button('Add this view').click()],
    ['the box is gone', () => mouse.press(button('Delete Box 1'))],
    ['the annotation is gone', () => button('Delete').click()],
];

describe('steps back and forth', () => {
    test('each brings back what was there, and does it again', async () => {
        const states = [await scene()];
        for (const [name, act] of steps) {
            await act();
            await another(states.at(-1), name);
            await settle(page);
            states.push(await scene());
        }
        const measured = await measurements(page);
        assert.deepEqual((await focused(page))?.tag, 'canvas'); // the button that deleted went with what it deleted
        const ways = [() => page.keyboard.press('Control+z'), () => page.keyboard.press('Meta+z'), () => mouse.press(button('Undo')), () => fingers.press(button('Undo'))];
        for (let i = steps.length - 1; i >= 0; i--) {
            await ways[i % ways.length]();
            await becomes(states[i], `before ${steps[i][0]}`);
        }
        assert.equal(await button('Undo').getAttribute('aria-disabled'), 'true');
        const again = [() => page.keyboard.press('Control+Shift+Z'), () => page.keyboard.press('Control+y'), () => button('Redo').click()];
        for (let i = 0; i < steps.length; i++) {
            await again[i % again.length]();
            await becomes(states[i + 1], steps[i][0]);
        }
        assert.equal(await button('Redo').getAttribute('aria-disabled'), 'true');
        assert.deepEqual(await measurements(page), measured); // with their answers
        assert.deepEqual(town.complaints, []);
    });

    test('what is done after steps back takes the place of what was ahead', async () => {
        await page.keyboard.press('Control+z');
        const before = await scene();
        await button('New box').click();
        await another(before, 'a new box');
        assert.equal(await button('Redo').getAttribute('aria-disabled'), 'true');
        await page.getByRole('application', { name: 'Point cloud' }).focus();
        await page.keyboard.press('Control+z');
        await becomes(before, 'before the new box');
    });

    test('in a drawing it is the last corner; in a field the text that was not taken yet', async () => {
        const before = await scene();
        await button('Polygon on the screen').click();
        for (const [i, [x, y]] of [[400, 150], [600, 150], [500, 300], [450, 320]].entries()) {
            await page.mouse.click(x, y);
            await page.locator(`stipple-clip-overlay [data-drawn="${i + 1}"]`).waitFor({ state: 'attached' });
        }
        await page.keyboard.press('Control+z');
        await page.locator('stipple-clip-overlay [data-drawn="3"]').waitFor({ state: 'attached' });
        await page.keyboard.press('Enter');
        await another(before, 'a polygon');
        const drawn = await scene();
        assert.equal(drawn.style.clipRegions.at(-1).region.prism.corners.length, 3);
        const field = page.getByLabel('Lowest height of Polygon 2');
        await field.focus();
        await page.keyboard.type('7');
        await page.keyboard.press('Control+z');
        assert.equal(await field.inputValue(), '');
        await becomes(drawn, 'with the polygon');
        await page.keyboard.type('12');
        await page.keyboard.press('Enter');
        await another(drawn, 'a height');
        await page.keyboard.press('Control+z');
        await becomes(drawn, 'before the height');
        assert.equal(await field.inputValue(), '');
        await page.keyboard.press('Control+z');
        await becomes(before, 'before the polygon');
    });

    test('a text that is taken by the click on something else is a step of its own', async () => {
        const empty = await scene(), titles = async () => (await scene()).annotations.map(({ title }) => title);
        await button('New annotation').click();
        await page.mouse.click(500, 230);
        await another(empty, 'an annotation');
        const first = (await titles()).at(-1);
        await page.getByLabel('Title').click();
        await page.keyboard.press('Control+a');
        await page.keyboard.type('Leak');
        await button('Delete').click();
        await becomes(empty, 'it is gone');
        await page.keyboard.press('Control+z');
        assert.equal((await titles()).at(-1), 'Leak');
        await page.keyboard.press('Control+z');
        assert.equal((await titles()).at(-1), first);
        await page.keyboard.press('Control+z');
        await becomes(empty, 'none yet');
    });

    test('a profile is closed and opened again; a scene that is shown is a beginning', async () => {
        await mouse.measure('Distance', 2);
        const before = await scene();
        await button('Profile').last().click();
        await another(before, 'a profile');
        const open = await scene();
        await enter('Width of the profile', '3');
        await another(open, 'another width');
        await page.getByRole('application', { name: 'Point cloud' }).focus();
        await page.keyboard.press('Control+z');
        await becomes(open, 'the width before');
        await page.keyboard.press('Control+z');
        await becomes(before, 'no profile');
        await page.keyboard.press('Control+Shift+Z');
        await becomes(open, 'the profile again');
        await page.evaluate(() => {
            const viewer = document.querySelector('stipple-viewer');
            viewer.setScene({ ...viewer.getScene(), measurements: [] });
        });
        const shown = await scene();
        assert.deepEqual(shown.measurements, []);
        await page.keyboard.press('Control+z');
        await page.waitForTimeout(200);
        assert.deepEqual(await scene(), shown);
        assert.deepEqual(town.complaints, []);
    });
});
