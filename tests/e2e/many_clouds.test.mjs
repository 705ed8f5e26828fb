// A page with many clouds: those in view are opened, the others when they come into view.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';

import { keepScreenshot, launch, openPage, settle } from './support/browser.mjs';
import { makeTown, scratchFolder, serve } from './support/program.mjs';

const count = 6;
let browser, server, folder;

before(async () => {
    folder = await scratchFolder();
    for (let i = 0; i < count; i++) await makeTown(folder.path, { points: 4000, seed: i + 1, name: `tile${i}` });
    server = await serve(folder.path);
    browser = await launch();
});
after(async () => {
    await browser?.close();
    await server?.stop();
    await folder?.cleanUp();
});

/** The page, and which clouds were asked for so far. */
async function open(query) {
    const opened = await openPage(browser);
    const asked = new Set();
    opened.page.on('request', (request) => {
        const cloud = /clouds\/(\w+)\.stipple/.exec(request.url());
        if (cloud) asked.add(cloud[1]);
    });
    await opened.page.goto(server.address + query);
    await opened.page.waitForFunction(() => window.stipple);
    return { ...opened, asked };
}

describe('many clouds', () => {
    test('?cloud=* opens all that the server has', async () => {
        const { page, complaints, asked } = await open('?cloud=*');
        await page.waitForFunction((count) => window.stipple.clouds().filter(({ stage }) => stage === 'ready').length === count, count);
        assert.equal(asked.size, count);
        assert.deepEqual(complaints, []);
        await page.close();
    });

    test('the list opens all of them with one button', async () => {
        const { page } = await open('?cloud=');
        await page.getByRole('button', { name: 'Open all of them' }).click();
        await page.waitForFunction((count) => window.stipple.clouds().filter(({ stage }) => stage === 'ready').length === count, count);
        assert.equal(await page.getByRole('button', { name: 'Open all of them' }).count(), 0);
        await page.close();
    });

    test('a cloud elsewhere is not asked for before it is in view, and says so', async () => {
        const { page, complaints, asked } = await open('?cloud=');
        await page.evaluate(() => window.stipple.open('clouds/tile0.stipple', 'Here'));
        await page.waitForFunction(() => window.stipple.clouds().some(({ stage }) => stage === 'ready'));
        await settle(page);
        await page.evaluate(() => {
            const bounds = { min: [1e6, 1e6, 0], max: [1.0001e6, 1.0001e6, 20] };
            window.stipple.open('clouds/tile1.stipple', 'There', bounds);
        });
        const { frame } = await settle(page);
        await page.waitForFunction(() => window.stipple.clouds().map(({ stage }) => stage).join() === 'ready,waiting');
        assert.equal(frame.cloudsWaiting, 1);
        assert.ok(!asked.has('tile1'));
        await page.getByText('waiting until it is in view').waitFor();
        await keepScreenshot(page, 'waiting-cloud');

        await page.locator('stipple-clouds').getByRole('button', { name: 'There', exact: true }).click(); // flies to what it is said to fill
        await page.waitForFunction(() => window.stipple.clouds().every(({ stage }) => stage !== 'waiting'));
        assert.ok(asked.has('tile1'));
        assert.deepEqual(complaints, []);
        await page.close();
    });
});
