// What comes over the wire before a person can do anything: the page's own files, coded as servers send them.
import assert from 'node:assert/strict';
import { existsSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { launch, openPage, settle } from './support/browser.mjs';
import { makeTown, scratchFolder, serve } from './support/program.mjs';

const dist = fileURLToPath(new URL('../../www/dist/', import.meta.url));
const most = 400_000;

let browser, folder, server;
before(async () => {
    folder = await scratchFolder();
    server = await serve(await makeTown(folder.path, { points: 20_000 }));
    browser = await launch();
});
after(async () => {
    await browser?.close();
    await server?.stop();
    await folder?.cleanUp();
});

describe('the size of the page', () => {
    test('what is loaded at first is at most 400 kB; languages, Markdown and what else is wanted later come later', async () => {
        const { page } = await openPage(browser);
        const asked = new Set();
        page.on('request', (request) => asked.add(new URL(request.url()).pathname.slice(1) || 'index.html'));
        page.on('worker', (worker) => asked.add(new URL(worker.url()).pathname.slice(1)));
        await page.goto(server.address);
        await settle(page);
        const files = [...asked].filter((path) => existsSync(join(dist, path)));
        const sizeOf = (path) => statSync(join(dist, existsSync(join(dist, `${path}.br`)) ? `${path}.br` : path)).size;
        const sizes = files.map((path) => [path, sizeOf(path)]).sort((a, b) => b[1] - a[1]);
        const total = sizes.reduce((sum, [, size]) => sum + size, 0);
        console.log(`  ${total} bytes: ${sizes.map(([path, size]) => `${path} ${size}`).join(', ')}`);
        assert.ok(files.some((path) => /decoder_worker/.test(path)) && files.filter((path) => /\.wasm$/.test(path)).length === 2, files.join(', '));
        assert.ok(!files.some((path) => /german|french|japanese|markdown/.test(path)), files.join(', '));
        assert.ok(total <= most, `${total} bytes`);
        await page.close();
    });
});
