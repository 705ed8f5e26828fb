// node tests/e2e/measure_start.mjs [LOADS]: how long until the page obeys, from an empty browser, over loopback; a town of 20,000 points.
// Prints milliseconds from the navigation's start until the viewer is ready and until it draws first: median, least, most.
import { launch, openPage } from './support/browser.mjs';
import { makeTown, scratchFolder, serve } from './support/program.mjs';

const loads = Number(process.argv[2] ?? 11);
const folder = await scratchFolder();
const server = await serve(await makeTown(folder.path, { points: 20_000 }));
const times = { ready: [], drawn: [] };
for (let i = 0; i < loads; i++) {
    const browser = await launch(); // nothing is cached, nothing compiled
    const { page } = await openPage(browser, { width: 1280, height: 720 });
    await page.addInitScript(() => {
        window.times = {};
        const look = () => {
            const viewer = document.querySelector('stipple-viewer');
            if (!viewer?.whenReady) return requestAnimationFrame(look);
            viewer.addEventListener('camera-change', () => (window.times.drawn ??= performance.now()));
            viewer.whenReady().then(() => (window.times.ready = performance.now()));
        };
        look();
    });
    await page.goto(server.address);
    await page.waitForFunction(() => window.times.ready && window.times.drawn);
    const { ready, drawn } = await page.evaluate(() => window.times);
    times.ready.push(ready);
    times.drawn.push(drawn);
    await browser.close();
}
for (const [what, values] of Object.entries(times)) {
    const sorted = values.map(Math.round).sort((a, b) => a - b);
    console.log(`${what}: ${sorted[Math.floor(sorted.length / 2)]} ms (${sorted[0]}-${sorted.at(-1)})`);
}
await server.stop();
await folder.cleanUp();
