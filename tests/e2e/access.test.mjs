// Tokens and prepareRequest go with every request that the page sends: for lists, clouds, profiles and files; who is refused is asked for a token.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';

import { launch, openPage, settleWithPoints, unless } from './support/browser.mjs';
import { makeTown, scratchFolder, serve, stipple } from './support/program.mjs';

const size = { width: 1100, height: 720 };
let browser, folder, server, token, cloud;

/** A server whose only cloud is private. */
before(async () => {
    folder = await scratchFolder();
    const town = await makeTown(folder.path, { points: 40_000 }), access = join(folder.path, 'access.json');
    await stipple('access', 'protect', access, 'town');
    token = (await stipple('access', 'add', access, 'town', '--name', 'Lisa', '--for', '1d')).trim();
    server = await serve(town, '--access', access);
    cloud = `${server.address}clouds/town.stipple`;
    browser = await launch();
});
after(async () => {
    await browser?.close();
    await server?.stop();
    await folder?.cleanUp();
});

/** The page; `asked`: what it asks the server for besides itself. */
async function open() {
    const { page } = await openPage(browser, size);
    const asked = [];
    page.on('request', (request) => {
        const { pathname, search } = new URL(request.url());
        if (/^\/(api|clouds)\//.test(pathname)) asked.push({ method: request.method(), path: pathname + search, headers: request.headers() });
    });
    await page.goto(`${server.address}?cloud=`);
    await page.waitForFunction(() => window.stipple !== undefined);
    return { page, asked };
}
const profilePanel = (page) => page.getByRole('complementary', { name: 'Profile' });

/** A profile through the town, complete. */
async function cutProfile(page) {
    await page.getByRole('button', { name: 'Distance' }).click();
    for (const [i, position] of [{ x: 430, y: 300 }, { x: 620, y: 310 }].entries()) {
        await page.locator('canvas').first().click({ position });
        await page.waitForFunction((n) => window.stipple.measurements().at(-1)?.points.length === n, i + 1);
    }
    await page.keyboard.press('Enter');
    await page.getByRole('button', { name: 'Profile' }).click();
    await profilePanel(page).getByRole('status').filter({ hasText: 'complete' }).waitFor();
}

/** The file that the profile's link saves is that of its address. */
async function saveFile(page) {
    const link = profilePanel(page).getByRole('link', { name: 'CSV' }), address = await link.getAttribute('href');
    const saving = page.waitForEvent('download');
    await link.click();
    const saved = await saving;
    const right = await fetch(address, { headers: { Authorization: `Bearer ${token}` } });
    assert.equal(await readFile(await saved.path(), 'utf8'), await right.text());
    return saved.suggestedFilename();
}

async function giveToken(page, name, given) {
    await page.getByLabel(`Token for ${name}`).fill(given);
    await page.getByLabel(`Token for ${name}`).press('Enter');
}
const noProblem = (page) => page.locator('[data-problem]').first().waitFor({ state: 'detached' });

describe('access', () => {
    test('a token goes with lists, clouds, profiles and files of its server', { skip: unless('downloads') }, async () => {
        const { page, asked } = await open();
        await page.evaluate(() => window.stipple.open('/clouds/town.stipple', 'Town')); // as the list has it
        await page.locator('[data-problem=stopped]').waitFor();
        const refused = asked.length;
        await giveToken(page, 'Town', token);
        await noProblem(page);
        await settleWithPoints(page);
        await page.evaluate(() => window.stipple.setStyle({ sizePixels: 5, shape: 'square' }));
        await cutProfile(page);
        assert.equal(await saveFile(page), 'town-profile.csv');
        const sent = asked.slice(refused).filter(({ method }) => method !== 'OPTIONS');
        for (const kind of [/^\/api\/v1\/clouds$/, /^\/clouds\//, /profile\?.*spacing/, /profile\?.*format=csv/])
            assert.ok(sent.some(({ path }) => kind.test(path)), `${kind}: ${sent.map(({ path }) => path)}`);
        assert.deepEqual(sent.filter(({ headers }) => headers.authorization !== `Bearer ${token}`), []);
        await page.close();
    });

    test('a list that is refused is a problem with a field for a token; so are profiles and files', { skip: unless('downloads') }, async () => {
        const { page } = await openPage(browser, size);
        const isRefused = {};
        await page.route('**/api/v1/clouds', async (route) => {
            const isGranted = route.request().headers().authorization === `Bearer ${token}`;
            return isGranted ? route.continue() : route.fulfill({ status: 401, body: '' });
        });
        await page.route(/\/profile\?/, (route) => (isRefused.profile ? route.fulfill({ status: 403, body: '' }) : route.continue()));
        await page.goto(server.address);
        const { host } = new URL(server.address);
        await page.getByText('Its list of clouds is refused (status 401).').waitFor();
        await giveToken(page, host, 'wrong');
        await page.getByText('The token that was given is not accepted').waitFor();
        await giveToken(page, host, token);
        await noProblem(page);
        await page.getByRole('button', { name: /^town/ }).click();
        await settleWithPoints(page);
        await page.evaluate(() => window.stipple.setStyle({ sizePixels: 5, shape: 'square' }));
        await cutProfile(page);

        isRefused.profile = true;
        await profilePanel(page).getByRole('link', { name: 'CSV' }).click();
        await page.getByText('A file is refused (status 403).').waitFor();
        await page.getByRole('button', { name: `Hide the problem with ${host}` }).click();
        await noProblem(page);
        await profilePanel(page).getByLabel('Width of the profile').fill('3');
        await profilePanel(page).getByLabel('Width of the profile').press('Enter');
        await page.getByText('A profile is refused (status 403).').waitFor();
        isRefused.profile = false;
        await page.getByRole('button', { name: `Retry ${host}` }).click();
        await noProblem(page);
        await profilePanel(page).getByRole('status').filter({ hasText: 'complete' }).waitFor();
        await page.close();
    });

    test('prepareRequest prepares lists, clouds, profiles and files', async () => {
        const { page, asked } = await open();
        await page.evaluate(async (authorization) => {
            window.prepared = [];
            const prepare = (url, range) => {
                window.prepared.push([url, range ?? null]);
                return { headers: { Authorization: authorization } };
            };
            window.stipple.prepareRequest = prepare;
            const viewer = Object.assign(document.createElement('stipple-viewer'), { prepareRequest: prepare });
            viewer.setAttribute('server', './');
            document.body.append(viewer);
            await viewer.whenReady();
            window.offered = await viewer.serverClouds();
            viewer.remove();
        }, `Bearer ${token}`);
        assert.deepEqual(await page.evaluate(() => window.offered.map(({ id }) => id)), ['town']);
        assert.ok(asked.some(({ path, headers }) => path === '/api/v1/clouds' && headers.authorization === `Bearer ${token}`));
        await page.evaluate((address) => window.stipple.open(address, 'Town'), cloud);
        await settleWithPoints(page);
        const prepared = await page.evaluate(() => window.prepared);
        assert.deepEqual(prepared.find(([url]) => url === `${server.address}api/v1/clouds`), [`${server.address}api/v1/clouds`, null]);
        assert.ok(prepared.filter(([url]) => url === cloud).every(([, range]) => /^bytes=\d+-\d+$/.test(range)));
        await page.close();
    });
});
