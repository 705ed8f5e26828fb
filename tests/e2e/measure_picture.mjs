// One large picture on the page: how long it takes, and the memory of the page's and the GPU's process meanwhile.
//   node tests/e2e/measure_picture.mjs FILE.stipple WIDTH HEIGHT OUT.png [--download]      after scripts/build_web.sh
// It goes to the browser's own file system as it comes; with --download it is kept by the page until it is whole.
import { spawn } from 'node:child_process';
import { mkdtemp, open, readdir, readFile, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

import { chromium } from 'playwright-core';

import { executable, flags, openPage, settleWithPoints } from './support/browser.mjs';
import { answerPicker } from './support/files.mjs';
import { serve } from './support/program.mjs';

const [file, width, height, output] = process.argv.slice(2), downloads = process.argv.includes('--download');
const profile = await mkdtemp(join(tmpdir(), 'stipple-picture-'));
const chromiumProcess = spawn(executable, [...flags, '--remote-debugging-port=0', `--user-data-dir=${profile}`], { stdio: ['ignore', 'ignore', 'pipe'] });
const endpoint = await new Promise((resolve) => {
    let text = '';
    chromiumProcess.stderr.on('data', (data) => {
        text += data;
        const found = /DevTools listening on (\S+)/.exec(text);
        if (found) resolve(found[1]);
    });
});
const browser = await chromium.connectOverCDP(endpoint), server = await serve(file);

/** Resident bytes of the largest page process and of the GPU's. */
async function memory() {
    const most = { renderer: 0, 'gpu-process': 0 };
    for (const id of (await readdir('/proc')).filter((name) => /^\d+$/.test(name))) {
        const read = (what) => readFile(`/proc/${id}/${what}`, 'utf8').catch(() => '');
        const command = await read('cmdline'), kind = /--type=(renderer|gpu-process)/.exec(command)?.[1];
        if (!kind || !command.includes(profile)) continue;
        most[kind] = Math.max(most[kind], Number(/VmRSS:\s+(\d+)/.exec(await read('status'))?.[1] ?? 0) / 1024);
    }
    return most;
}

try {
    const { page } = await openPage(browser, { width: 1280, height: 960 });
    page.setDefaultTimeout(0);
    await page.goto(server.address);
    await settleWithPoints(page);
    await page.evaluate(() => window.stipple.settled());
    const before = await memory(), most = { ...before };
    for (const [label, value] of [['Width of the picture', width], ['Height of the picture', height]]) {
        await page.getByLabel(label).fill(value);
        await page.getByLabel(label).press('Tab');
    }
    if (!downloads) await answerPicker(page);
    const start = performance.now(), picture = page.getByRole('button', { name: 'Picture', exact: true });
    const download = downloads ? page.waitForEvent('download') : undefined;
    await picture.click();
    let isOver = false;
    const watched = (async () => {
        while (!isOver) {
            for (const [kind, size] of Object.entries(await memory())) most[kind] = Math.max(most[kind], size);
            await new Promise((resolve) => setTimeout(resolve, 200));
        }
    })();
    await page.getByRole('button', { name: /^Give up/ }).waitFor();
    await picture.waitFor();
    if (download) await (await download).saveAs(output);
    const seconds = (performance.now() - start) / 1000;
    isOver = true;
    await watched;
    if (!download) await copyOut(page);
    const mb = (sizes) => Object.entries(sizes).map(([kind, size]) => `${kind} ${size.toFixed(0)} MB`).join(', ');
    console.log(`${width} x ${height} pixels in ${seconds.toFixed(1)} s; before: ${mb(before)}; at most: ${mb(most)}`);
    console.log(`notices: ${JSON.stringify(await page.getByRole('alert').allTextContents())}`);
} finally {
    await browser.close();
    await server.stop();
    chromiumProcess.kill();
    await new Promise((resolve) => chromiumProcess.once('exit', resolve));
    await rm(profile, { recursive: true, force: true, maxRetries: 20, retryDelay: 200 });
}

/** From the browser's file system. */
async function copyOut(page) {
    const to = await open(output, 'w'), pieceBytes = 3 << 20;
    for (let at = 0; ; at += pieceBytes) {
        const base64 = await page.evaluate(async ([from, end]) => {
            const handle = await (await navigator.storage.getDirectory()).getFileHandle('picture.png');
            const bytes = new Uint8Array(await (await handle.getFile()).slice(from, end).arrayBuffer());
            let binary = '';
            for (let i = 0; i < bytes.length; i += 0x8000) binary += String.fromCharCode(...bytes.subarray(i, i + 0x8000));
            return btoa(binary);
        }, [at, at + pieceBytes]);
        if (base64 === '') break;
        await to.write(Buffer.from(base64, 'base64'));
    }
    await to.close();
}
