// The page without a mouse, without sight, in the dark and in the light, from right to left, and on a telephone.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { after, before, describe, test } from 'node:test';

import { keepScreenshot, openPage, settle, unless } from './support/browser.mjs';
import { focused, tabTo } from './support/keyboard.mjs';
import { openTownPage } from './support/town_page.mjs';

let town, page, axe;
before(async () => {
    axe = await readFile(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
    town = await openTownPage({ width: 1100, height: 900 });
    page = town.page;
});
after(() => town?.close());

const camera = () => page.evaluate(() => window.stipple.camera());

/** Nothing that axe-core calls serious or critical, in either theme. */
async function checkAxe(what) {
    await page.evaluate(axe);
    for (const colorScheme of ['dark', 'light']) {
        await page.emulateMedia({ colorScheme });
        await page.waitForTimeout(300); // colours that change by transitions
        const found = await page.evaluate(async () => {
            const { violations } = await window.axe.run(document, { resultTypes: ['violations'] });
            return violations.map(({ id, impact, nodes }) => ({ id, impact, where: nodes.map(({ target, failureSummary }) => `${target.join(' ')}: ${failureSummary}`) }));
        });
        await keepScreenshot(page, `${what}_${colorScheme}`);
        const bad = found.filter(({ impact }) => impact === 'serious' || impact === 'critical');
        console.log(`  axe, ${what}, ${colorScheme}: ${found.map(({ id, impact }) => `${id} (${impact})`).join(', ') || 'nothing'}`);
        assert.deepEqual(bad, [], `${what}, ${colorScheme}`);
    }
    await page.emulateMedia({ colorScheme: 'dark' });
}

/** Panels that lie on each other, by the parts of the page that they are. */
function overlapping() {
    const app = document.querySelector('stipple-viewer').shadowRoot.querySelector('stipple-app').shadowRoot;
    const panels = [...app.querySelectorAll('.panel, .status')].filter((panel) => panel.getBoundingClientRect().width > 0);
    const meet = (a, b) => a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1;
    return panels.flatMap((a, i) =>
        panels.slice(i + 1).filter((b) => meet(a.getBoundingClientRect(), b.getBoundingClientRect())).map((b) => `${a.className} and ${b.className}`),
    );
}

describe('by the keyboard alone', () => {
    test('every tool is reached, works, and lets go', async () => {
        await page.evaluate(() => document.activeElement?.blur());
        await page.keyboard.press('Tab');
        assert.equal((await focused(page)).tag, 'canvas');
        const start = await camera();
        await page.keyboard.press('ArrowLeft');
        assert.notDeepEqual((await camera()).position, start.position);
        await page.keyboard.press('1');
        await settle(page);

        // Measuring: the toolbar is one stop, its tools are reached by arrows, points are taken in the middle.
        await tabTo(page, 'Distance');
        await page.keyboard.press('ArrowRight');
        assert.equal((await focused(page)).name, 'Height');
        await page.keyboard.press('End');
        assert.equal((await focused(page)).name, 'Volume');
        await page.keyboard.press('Home');
        await page.keyboard.press('Enter');
        assert.equal((await focused(page)).tag, 'canvas');
        await page.keyboard.press(' ');
        await page.waitForFunction(() => window.stipple.measurements()[0]?.points.length === 1);
        await page.keyboard.press('Shift+ArrowLeft');
        await settle(page);
        await page.keyboard.press(' ');
        await page.waitForFunction(() => window.stipple.measurements()[0]?.points.length === 2);
        await page.keyboard.press('Enter');
        const [{ answer }] = await page.evaluate(() => window.stipple.measurements());
        assert.ok(answer.distance > 0);
        await page.getByRole('status').filter({ hasText: /^Distance 1: Distance .*Horizontal/ }).waitFor({ state: 'attached' });
        // Back at the toolbar it stands where it was left.
        await tabTo(page, 'Distance');
        await page.keyboard.press('ArrowRight');
        await page.keyboard.press('Enter');
        await page.keyboard.press('Escape');
        assert.equal(await page.getByRole('button', { name: 'Height', pressed: true }).count(), 0);

        await tabTo(page, 'Profile');
        await page.keyboard.press('Enter');
        await page.getByText(/points, complete/).waitFor();

        await tabTo(page, 'New box');
        await page.keyboard.press('Enter');
        await page.getByText('Box 1').waitFor();
        await tabTo(page, 'Mode');
        await page.keyboard.press('End'); // the last mode
        await page.waitForFunction(() => window.stipple.style().clipBoxes[0].mode === 'highlight');
        await tabTo(page, 'Size x of Box 1');
        await page.keyboard.press('ControlOrMeta+a');
        await page.keyboard.type('25');
        await page.keyboard.press('Enter');
        await page.waitForFunction(() => window.stipple.style().clipBoxes[0].halfSize[0] === 12.5);

        await tabTo(page, 'New annotation');
        await page.keyboard.press('Enter');
        assert.equal((await focused(page)).tag, 'canvas');
        await page.keyboard.press(' ');
        await page.waitForFunction(() => window.stipple.annotations().length === 1);
        await tabTo(page, 'Title');
        await page.keyboard.press('ControlOrMeta+a');
        await page.keyboard.type('By hand');
        await page.keyboard.press('Enter');
        await page.waitForFunction(() => window.stipple.annotations()[0].title === 'By hand');

        await tabTo(page, 'Top');
        await page.keyboard.press('ArrowRight');
        await page.keyboard.press('Enter');
        const front = await camera();
        assert.ok(Math.abs(front.position[2] - front.target[2]) < 1e-6 * Math.hypot(...front.position));
        await page.keyboard.press('Escape'); // from a panel back to the picture
        assert.equal((await focused(page)).tag, 'canvas');
        await page.keyboard.press('f');
        await page.waitForTimeout(1000);
        await settle(page);
        await page.keyboard.press(' ');
        await page.getByRole('complementary', { name: 'Point' }).waitFor();
        await tabTo(page, 'Help');
        await page.keyboard.press('Enter');
        await page.getByRole('dialog', { name: 'Help' }).waitFor();
        assert.equal((await focused(page)).name, 'Close the help');
        await keepScreenshot(page, 'help');
        await page.keyboard.press('Escape');
        await page.getByRole('dialog').waitFor({ state: 'detached' });
        assert.equal((await focused(page)).name, 'Help');
        await tabTo(page, 'Link');
        await page.keyboard.press('Enter');
        await page.getByLabel('Link to this scene').waitFor();
        await tabTo(page, 'Counters', { most: 250 });
        await page.keyboard.press('Enter');
        await page.getByRole('complementary', { name: 'Counters' }).waitFor();
        assert.deepEqual(town.complaints, []);
    });

    test('with every panel open, axe-core finds nothing serious in either theme', async () => {
        await page.evaluate(() => window.stipple.setLimits({ pointBudget: -1 })); // a notice, too
        await page.getByRole('alert').first().waitFor();
        await page.getByRole('button', { name: 'Map', exact: true }).click();
        await page.locator('stipple-map[data-camera]').waitFor();
        assert.deepEqual(await page.evaluate(overlapping), []);
        await checkAxe('all_panels');
        await page.getByRole('button', { name: 'Help' }).click();
        await checkAxe('help');
        await page.keyboard.press('Escape');
        await page.getByRole('button', { name: 'Dismiss' }).first().click();
    });
});

describe('from right to left', () => {
    test('panels change sides, and nothing leaves the page', async () => {
        await page.evaluate(() => (document.documentElement.dir = 'rtl'));
        const box = await page.getByRole('region', { name: 'Controls' }).boundingBox();
        assert.ok(box.x + box.width > 1100 - 20 && box.x > 550, JSON.stringify(box));
        await keepScreenshot(page, 'right_to_left');
        const before = (await page.getByLabel('Budget').inputValue());
        await page.getByLabel('Budget').focus();
        await page.keyboard.press('ArrowLeft'); // the greater end is on the left
        assert.ok(Number(await page.getByLabel('Budget').inputValue()) > Number(before));
        await page.evaluate(() => (document.documentElement.dir = ''));
    });
});

/** What of the controls is cut off: beyond the page's edges, a text wider than its button, a label that breaks within a word. */
function cutOff() {
    const wrong = [], width = innerWidth;
    const checkWords = (element) => {
        const walker = document.createTreeWalker(element, NodeFilter.SHOW_TEXT), range = document.createRange();
        for (let node = walker.nextNode(); node; node = walker.nextNode())
            for (const { 0: word, index } of node.data.matchAll(/[\p{Script=Latin}\d]+/gu)) {
                range.setStart(node, index);
                range.setEnd(node, index + word.length);
                if (new Set([...range.getClientRects()].map(({ top }) => Math.round(top))).size > 1) wrong.push(`${word} is broken`);
            }
    };
    const walk = (root) => {
        for (const element of root.querySelectorAll('*')) {
            if (element.shadowRoot) walk(element.shadowRoot);
            if (!element.matches('button, select, input, textarea, a, .choice, .choice span, legend, output, .row, .row > span')) continue;
            const box = element.getBoundingClientRect();
            if (box.width === 0 || element.matches('.unseen, .unseen *, .label')) continue;
            const name = element.getAttribute('aria-label') ?? element.textContent.trim();
            if (element.matches('.row > span:first-child, .choice span, button, legend')) checkWords(element);
            if (box.left < 0 || box.right > width) wrong.push(`${name} is cut off: ${box.left} to ${box.right}`);
            if (element.scrollWidth > element.clientWidth + 1 && !element.matches('input, textarea, select, a'))
                wrong.push(`${name} is wider than its place: ${element.scrollWidth} in ${element.clientWidth}`);
            // WCAG 2.2, 2.5.8: 24 pixels; links in a line of text are exempt, and what has so much room around it.
            const target = element.closest('label') ?? element;
            if (element.matches('button, select, input:not([type=checkbox])') && target.getBoundingClientRect().height < 24)
                wrong.push(`${name} is ${box.height} high`);
        }
    };
    walk(document);
    return wrong;
}

describe('in other languages', () => {
    for (const language of ['de', 'fr', 'ja'])
        test(`${language}: the page says so, and its texts have room`, async () => {
            const { page: other, complaints } = await openPage(town.browser, { width: 1100, height: 900 });
            await other.goto(`${town.address}?lang=${language}`);
            await settle(other);
            assert.equal(await other.evaluate(() => document.documentElement.lang), language);
            await other.evaluate(() => window.stipple.setStyle({ detail: { mode: 'continuous' }, colourMode: 'intensity' }));
            await settle(other);
            assert.deepEqual(await other.evaluate(cutOff), []);
            await keepScreenshot(other, `language_${language}`);
            await other.setViewportSize({ width: 360, height: 640 });
            await settle(other);
            assert.deepEqual(await other.evaluate(cutOff), []);
            assert.deepEqual(complaints, []);
            await other.close();
        });
});

describe('on a telephone', () => {
    test('360 pixels are enough: a sheet at the foot, nothing cut off, targets for fingers, nothing serious for axe-core', async () => {
        await page.setViewportSize({ width: 360, height: 640 });
        await settle(page);
        const controls = page.getByRole('region', { name: 'Controls' });
        const box = await controls.boundingBox();
        assert.ok(box.x >= 0 && box.x + box.width <= 360 && box.y + box.height <= 640 && box.height <= 400, JSON.stringify(box));
        assert.deepEqual(await page.evaluate(cutOff), []);
        assert.deepEqual(await page.evaluate(overlapping), []);
        await checkAxe('telephone');
        for (const name of ['Close the point', 'Close the profile', 'Close the map']) await page.getByRole('button', { name }).click();
        await page.getByRole('button', { name: 'Counters' }).click();
        await page.getByRole('button', { name: 'Hide', exact: true }).first().click();
        await keepScreenshot(page, 'telephone_closed');
        assert.ok((await controls.boundingBox()).height < 80);
    });
});

describe('fingers and pen', { skip: unless('touch') }, () => {
    let session;
    before(async () => {
        session = await page.context().newCDPSession(page);
    });
    const touch = (type, ...points) =>
        session.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
    /** All fingers go from where they are to the others, in steps that do not wait for the page. */
    async function fingers(from, to, steps = 8) {
        const sent = [touch('touchStart', ...from)];
        for (let i = 1; i <= steps; i++)
            sent.push(touch('touchMove', ...from.map(([x, y], at) => [x + ((to[at][0] - x) * i) / steps, y + ((to[at][1] - y) * i) / steps])));
        await Promise.all([...sent, touch('touchEnd')]);
        await page.waitForTimeout(700); // what is under them is known some frames later
        await settle(page);
        return camera();
    }
    async function mouse(from, to, button = 'left') {
        await page.mouse.move(...from);
        await page.mouse.down({ button });
        await page.mouse.move(...to, { steps: 8 });
        await page.mouse.up({ button });
        await settle(page);
        return camera();
    }
    const reset = async (start) => {
        await page.evaluate((it) => window.stipple.setCamera(it), start);
        await settle(page);
    };
    const minus = (a, b) => a.map((value, axis) => value - b[axis]);
    const norm = (a) => Math.hypot(...a);
    const near = (a, b, size) => assert.ok(norm(minus(a, b)) < 1e-6 * size, `${a} is not ${b}`);

    test('one finger and a pen move the camera as the mouse does, two fingers by their middle and spread, three as the other button', async () => {
        await page.evaluate(() => window.stipple.setStyle({ clipBoxes: [], sizePixels: 6 }));
        await settle(page);
        const start = await camera(), size = norm(minus(start.position, start.target));
        const expected = await mouse([180, 200], [240, 230]);
        await reset(start);
        const byFinger = await fingers([[180, 200]], [[240, 230]]);
        near(byFinger.position, expected.position, size);
        assert.ok(norm(minus(byFinger.position, start.position)) > 0.01 * size);

        await reset(start);
        const pen = (type, x, y, buttons) =>
            session.send('Input.dispatchMouseEvent', { type, x, y, button: 'left', buttons, pointerType: 'pen', clickCount: 1 });
        await pen('mousePressed', 180, 200, 1);
        for (let i = 1; i <= 8; i++) await pen('mouseMoved', 180 + 7.5 * i, 200 + 3.75 * i, 1);
        await pen('mouseReleased', 240, 230, 0);
        await settle(page);
        near((await camera()).position, expected.position, size);

        // Apart by 1.5 about a middle that stays: 1 / 1.5 of the distance, in the same direction.
        await reset(start);
        const spread = await fingers([[140, 250], [220, 250]], [[120, 250], [240, 250]]);
        const ratio = norm(minus(spread.position, spread.target)) / size;
        assert.ok(Math.abs(ratio - 80 / 120) < 1e-6, `the distance is ${ratio} of what it was`);
        // Together, across the view: the whole camera moves, in its own plane, by what 40 pixels are at its target.
        await reset(start);
        const moved = await fingers([[140, 250], [220, 250]], [[180, 250], [260, 250]]);
        const way = minus(moved.target, start.target), view = minus(start.target, start.position);
        near(way, minus(moved.position, start.position), size);
        const along = Math.abs(way.reduce((sum, value, axis) => sum + value * view[axis], 0)) / norm(way) / size;
        assert.ok(along < 1e-6, `the camera moved along its view by ${along}`);
        const pixels = (norm(way) / (2 * size * Math.tan((start.fovYDegrees * Math.PI) / 360))) * 640;
        assert.ok(Math.abs(pixels - 40) < 0.5, `the picture moved by ${pixels} pixels`);

        // Three: the place under their middle goes with them, and the camera keeps its direction and its distance along it. That
        // says where the camera is: the place lies at a known depth, where a pixel is so many units.
        await reset(start);
        const place = await findPoint();
        const { position: grabbed } = await page.evaluate(({ x, y }) => window.stipple.pick(x, y), place); // with the radius of a gesture
        const across = expectedAfter(start, grabbed, { x: place.x + 30, y: place.y + 15 });
        assert.ok(norm(minus(across, start.position)) > 1e-3 * size);
        const three = await fingers(
            [[place.x - 30, place.y], [place.x, place.y], [place.x + 30, place.y]],
            [[place.x, place.y + 15], [place.x + 30, place.y + 15], [place.x + 60, place.y + 15]],
        );
        exactly(three.position, across);
        exactly(minus(three.target, three.position), minus(start.target, start.position));
        await reset(start);
        const other = await mouse([place.x, place.y], [place.x + 30, place.y + 15], 'right');
        exactly(other.position, across);
    });

    /** To the rounding of world coordinates. */
    const exactly = (a, b) => assert.ok(norm(minus(a, b)) < 1e-8, `${a} is not ${b}: ${norm(minus(a, b))} off`);

    /** A place of the picture, with room for fingers around it, where there is a point. */
    async function findPoint() {
        const found = await page.evaluate(async () => {
            for (let y = 300; y < 520; y += 20)
                for (let x = 100; x < 240; x += 20) {
                    const isFree = document.elementFromPoint(x, y).shadowRoot.elementFromPoint(x, y).tagName === 'CANVAS';
                    if (isFree && (await window.stipple.pick(x, y, 2))) return { x, y };
                }
            return null;
        });
        assert.ok(found, 'there is no point in the picture');
        return found;
    }

    /** Where the camera is once a place has come to lie at a pixel by moving across the view alone. */
    function expectedAfter({ position, target, up, fovYDegrees }, place, { x, y }) {
        const { width, height } = page.viewportSize();
        const cross = ([a, b, c], [u, v, w]) => [b * w - c * v, c * u - a * w, a * v - b * u];
        const scaled = (v, by) => v.map((value) => value * by), dot = (a, b) => a.reduce((sum, value, i) => sum + value * b[i], 0);
        const unit = (v) => scaled(v, 1 / norm(v));
        const forward = unit(minus(target, position)), right = unit(cross(forward, up)), upwards = cross(right, forward);
        const away = minus(place, position), depth = dot(away, forward);
        const unitsPerPixel = (2 * depth * Math.tan((fovYDegrees * Math.PI) / 360)) / height;
        const goesRight = dot(away, right) - (x - width / 2) * unitsPerPixel, goesUp = dot(away, upwards) + (y - height / 2) * unitsPerPixel;
        return position.map((value, i) => value + goesRight * right[i] + goesUp * upwards[i]);
    }

    test('a tap asks about the point', async () => {
        await page.evaluate(() => window.stipple.setStyle({ sizePixels: 8 }));
        await settle(page);
        const place = await page.evaluate(async () => {
            for (let y = 60; y < 520; y += 20)
                for (let x = 100; x < 260; x += 20) if (await window.stipple.pick(x, y, 2)) return [x, y];
        });
        await touch('touchStart', place);
        await touch('touchEnd');
        await page.getByRole('complementary', { name: 'Point' }).waitFor();
        const broken = await page.locator('stipple-point dd.number').evaluateAll((values) =>
            values.filter((value) => {
                const range = document.createRange();
                range.selectNodeContents(value);
                return new Set([...range.getClientRects()].map(({ top }) => Math.round(top))).size > 1 || value.scrollWidth > value.clientWidth;
            }).map((value) => `${value.dataset.value} ${value.textContent}`),
        );
        assert.deepEqual(broken, []); // a number is on one line
        await keepScreenshot(page, 'telephone_point');
        assert.deepEqual(town.complaints, []);
    });
});
