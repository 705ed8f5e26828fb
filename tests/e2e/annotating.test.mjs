// Annotations: put, edited, flown to, hidden with what they belong to, covered and far ones; their texts run no script; kept by scenes.
import assert from 'node:assert/strict';
import { readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';

import { keepScreenshot, settle, unless } from './support/browser.mjs';
import { minus, norm, openTownPage } from './support/town_page.mjs';

let town, page, complaints;

before(async () => {
    town = await openTownPage({ width: 1000, height: 640 });
    ({ page, complaints } = town);
});

after(() => town?.close());

const annotations = () => page.evaluate(() => window.stipple.annotations());
const label = (title) => page.locator('stipple-annotation-overlay').getByRole('button', { name: title });
const camera = () => page.evaluate(() => window.stipple.camera());

async function put(x, y, title) {
    const count = (await annotations()).length;
    await page.getByRole('button', { name: 'New annotation' }).click();
    await page.locator('canvas').click({ position: { x, y } });
    await page.waitForFunction((n) => window.stipple.annotations().length === n, count + 1);
    await page.getByLabel('Title').fill(title);
    await page.getByLabel('Title').press('Tab');
    return (await annotations()).at(-1);
}

async function savedScene() {
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save' }).click()]);
    return JSON.parse(await readFile(await download.path(), 'utf8'));
}

describe('annotations', () => {
    test('one is put where the point is, edited, and its text is Markdown without scripts', async () => {
        const place = await page.evaluate(() => window.stipple.pick(480, 300));
        const church = await put(480, 300, 'Church');
        assert.deepEqual(church.position, place.position);
        const text = [
            '# Nave\n\nBuilt **1250**, see [the list](https://example.org/list "more").',
            '<script>window.hacked = 1</script><img src=x onerror="window.hacked=1">',
            '[bad](javascript:window.hacked=1) <a href="javascript:window.hacked=1">worse</a>',
            '<svg onload="window.hacked=1"></svg><iframe src="javascript:window.hacked=1"></iframe>',
            '<form action="https://example.org"><input name=a></form><style>* { display: none }</style>',
        ].join('\n\n');
        await page.getByLabel('Text (Markdown)').fill(text);
        await page.getByLabel('Text (Markdown)').press('Tab');
        const shown = page.locator('stipple-annotation-overlay .text');
        await shown.getByRole('heading', { name: 'Nave' }).waitFor();
        await page.waitForTimeout(300);
        assert.equal(await page.evaluate(() => window.hacked), undefined);
        assert.equal(await shown.locator('script, svg, iframe, form, input, style').count(), 0);
        const links = await shown.locator('a').evaluateAll((list) => list.map((a) => [a.getAttribute('href'), a.target, a.rel]));
        assert.deepEqual(links[0], ['https://example.org/list', '_blank', 'noopener noreferrer']);
        assert.match(await shown.textContent(), /<script>window/); // HTML is text
        for (const [href] of links.slice(1)) assert.ok(href === null || !href.startsWith('javascript'), String(href));
        assert.equal(await shown.locator('[onerror], [onload]').count(), 0);
        await keepScreenshot(page, 'annotated');
    });

    test('one flies to it, or to the view that it keeps', async () => {
        const [church] = await annotations();
        const before = await camera();
        await page.getByRole('button', { name: 'Keep this view' }).click();
        const house = await put(620, 330, 'House');
        await page.getByRole('button', { name: 'Fly to House' }).click();
        await page.waitForFunction((to) => Math.hypot(...window.stipple.camera().target.map((v, i) => v - to[i])) < 1e-6, house.position);
        assert.ok(norm(minus((await camera()).position, before.position)) > 1);
        await page.getByRole('button', { name: 'Fly to Church' }).click();
        await page.waitForFunction((to) => JSON.stringify(window.stipple.camera()) === to, JSON.stringify(before));
        assert.deepEqual((await annotations())[0].camera, before);
        assert.equal(church.title, 'Church');
    });

    test('what belongs to a hidden one is hidden, what is far is not shown, what is covered is faint', async () => {
        const [church, house] = await annotations();
        await page.locator('stipple-annotations').getByRole('button', { name: 'House', exact: true }).click();
        await page.getByLabel('Belongs to').selectOption({ label: 'Church' });
        assert.equal((await annotations())[1].parent, church.id);
        assert.equal(await label('House').count(), 1);
        await page.getByRole('button', { name: 'Hide Church' }).click();
        assert.equal(await label('House').count(), 0);
        await page.getByRole('button', { name: 'Hide Church' }).click();
        // Not even the page's own controls can make one belong to what belongs to it.
        await page.locator('stipple-annotations').getByRole('button', { name: 'Church', exact: true }).click();
        await page.getByLabel('Belongs to').selectOption({ label: 'House' });
        assert.equal((await annotations())[0].parent, 0);

        const distance = norm(minus((await camera()).position, house.position));
        await page.locator('stipple-annotations').getByRole('button', { name: 'House', exact: true }).click();
        for (const [limit, count] of [[0.9 * distance, 0], [1.1 * distance, 1]]) {
            await page.getByLabel('Shown up to this distance').fill(String(limit));
            await page.getByLabel('Shown up to this distance').press('Tab');
            assert.equal(await label('House').count(), count);
        }
        await page.locator('stipple-annotations').getByRole('button', { name: 'House', exact: true }).click(); // closed
    });

    test('a scene keeps them, wrong trees are refused, and deleting one takes what belongs to it', { skip: unless('downloads') }, async () => {
        const before = await annotations();
        const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save' }).click()]);
        const scene = JSON.parse(await readFile(await download.path(), 'utf8'));
        assert.deepEqual(scene.annotations, before);
        const path = join(town.folder, 'scene.json');
        const load = async (value) => {
            await writeFile(path, JSON.stringify(value));
            await page.locator('stipple-scene input[type=file]').setInputFiles(path);
        };
        const one = { id: 1, position: [0, 0, 0] };
        const chain = Array.from({ length: 40 }, (_, i) => ({ id: i + 1, parent: i, position: [0, 0, 0] }));
        for (const [list, message] of [
            [[{ ...one, parent: 1 }], /to itself/],
            [[{ ...one, parent: 2 }, { ...one, id: 2, parent: 1 }], /to itself/],
            [[{ ...one, parent: 7 }], /none that is there/],
            [[one, one], /same id/],
            [chain, /deeper than 32/],
        ]) {
            await load({ ...scene, annotations: list });
            const notice = page.getByRole('alert').filter({ hasText: message });
            await notice.first().waitFor();
            await notice.first().getByRole('button', { name: 'Dismiss' }).click();
            assert.deepEqual(await annotations(), before);
        }
        // One on the surface, one behind it.
        await settle(page);
        const { position: seen } = await page.evaluate(() => window.stipple.pick(480, 300));
        const from = (await camera()).position, behind = seen.map((value, axis) => value + 0.5 * (value - from[axis]));
        await load({ ...scene, annotations: [{ ...one, title: 'Before', position: seen }, { ...one, id: 2, title: 'Behind', position: behind }] });
        await page.locator('stipple-annotation-overlay .covered').waitFor();
        assert.deepEqual(await page.locator('stipple-annotation-overlay .covered').allInnerTexts(), ['Behind']);

        await load(scene);
        await page.waitForFunction(() => window.stipple.annotations()[1]?.title === 'House');
        await page.locator('stipple-annotations').getByRole('button', { name: 'Church', exact: true }).click();
        await page.locator('stipple-annotations').getByRole('button', { name: 'Delete' }).click();
        assert.deepEqual(await annotations(), []);
        await load(scene);
        await page.waitForFunction(() => window.stipple.annotations().length === 2);
        assert.deepEqual(await annotations(), before);
        assert.deepEqual(complaints, []);
    });

    test('a tour goes from one to the next, in the order of the tree, past hidden ones, until it is ended', { skip: unless('downloads') }, async () => {
        const { position: seen } = await page.evaluate(() => window.stipple.pick(480, 300));
        const there = await camera(), beside = seen.map((value, axis) => value + (axis === 0 ? 3 : 0));
        const list = [
            { id: 1, title: 'Last', position: seen },
            { id: 2, title: 'Hidden', position: seen, hidden: true },
            { id: 3, title: 'First', position: seen, camera: there },
            { id: 4, parent: 3, title: 'Child', position: beside },
        ].sort((a, b) => (a.title === 'Last') - (b.title === 'Last'));
        const path = join(town.folder, 'tour.json');
        await writeFile(path, JSON.stringify({ ...(await savedScene()), annotations: list }));
        await page.locator('stipple-scene input[type=file]').setInputFiles(path);
        await page.waitForFunction(() => window.stipple.annotations().length === 4);
        const tour = page.getByRole('button', { name: 'Tour from one to the next' });
        const opened = page.locator('stipple-annotations .title[aria-expanded=true]');
        const seenTitles = [];
        await tour.click();
        for (const title of ['First', 'Child', 'Last']) {
            await opened.filter({ hasText: title }).waitFor();
            seenTitles.push(await opened.innerText());
            if (title === 'First') await page.waitForFunction((to) => JSON.stringify(window.stipple.camera()) === to, JSON.stringify(there));
            if (title === 'Child')
                await page.waitForFunction((to) => Math.hypot(...window.stipple.camera().target.map((v, i) => v - to[i])) < 1e-6, beside);
        }
        assert.deepEqual(seenTitles, ['First', 'Child', 'Last']);
        await tour.waitFor(); // it has ended

        await tour.click();
        await opened.filter({ hasText: 'First' }).waitFor();
        await page.getByRole('button', { name: 'End the tour' }).click();
        await page.waitForTimeout(3500);
        assert.equal(await opened.innerText(), 'First');
        assert.deepEqual(complaints, []);
    });
});
