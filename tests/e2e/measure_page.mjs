// node tests/e2e/measure_page.mjs FILE.stipple [SCREENSHOT.png]: one cloud in the page of the real server, in headless
// Chromium: when the first picture and the whole one came, what they cost, and how far the canvas is from the native
// OpenGL ES and software pictures of the same camera. Prints JSON. No test: times depend on the machine.
import { rm } from 'node:fs/promises';
import { join, resolve } from 'node:path';

import { launch, openPage, readPixels, settleWithPoints } from './support/browser.mjs';
import { compare, readPng } from './support/picture.mjs';
import { scratchFolder, serve, stipple } from './support/program.mjs';

const [file, screenshot] = process.argv.slice(2);
if (!file) {
    console.error('usage: node tests/e2e/measure_page.mjs FILE.stipple [SCREENSHOT.png]');
    process.exit(2);
}
const size = { width: 1280, height: 720 };
const pointBudget = 1_000_000;
const style = { colourMode: 'rgb', sizePixels: 3 };

const folder = await scratchFolder();
const server = await serve(resolve(file));
const browser = await launch();
const { page, complaints } = await openPage(browser, size);
page.setDefaultTimeout(120_000);
const start = performance.now();
await page.goto(server.address);
await page.waitForFunction(() => window.stipple?.counters().frame.pointsDrawn > 0);
const firstPictureMs = Math.round(performance.now() - start);
await page.evaluate((limits) => window.stipple.setLimits(limits), { pointBudget });
await page.evaluate((look) => window.stipple.setStyle(look), style);
const { frame, session } = await settleWithPoints(page);
const wholePictureMs = Math.round(performance.now() - start);
if (screenshot) await page.screenshot({ path: screenshot });

const drawn = await readPixels(page);
const camera = await page.evaluate(() => window.stipple.camera());
const differences = {};
for (const backend of ['gles', 'software']) {
    const output = join(folder.path, `${backend}.png`);
    await stipple('render', resolve(file), '-o', output, '--backend', backend, '--budget', String(pointBudget),
        '--size', `${drawn.width}x${drawn.height}`, '--view', JSON.stringify(camera), '--style', JSON.stringify(style));
    differences[backend] = compare(drawn, await readPng(output));
}
console.log(JSON.stringify({
    firstPictureMs, wholePictureMs, pointsDrawn: frame.pointsDrawn, nodesDrawn: frame.nodesDrawn,
    requests: session.requests, bytesReceived: session.bytesReceived, differences, complaints,
}, null, 2));
await browser.close();
await server.stop();
await rm(folder.path, { recursive: true, force: true });
