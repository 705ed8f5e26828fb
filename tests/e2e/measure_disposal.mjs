// Two viewers on a page, made, drawn and disposed of, again and again: what is left of memory.
//   node tests/e2e/measure_disposal.mjs [ROUNDS]      after scripts/build_web.sh and scripts/build_package.sh; 100 rounds unless told
// Prints the page's JavaScript heap (collected), its documents and listeners, and the resident memory of the page's and the GPU's process.
import { readFile } from 'node:fs/promises';

import { launch, openPage } from './support/browser.mjs';
import { installPackage } from './support/embedding.mjs';

const rounds = Number(process.argv[2] ?? 100);

const site = await installPackage();
const browser = await launch();
const { page, complaints } = await openPage(browser, { width: 900, height: 700 });
await page.goto(`${site.address}empty.html`);
const session = await page.context().newCDPSession(page);
const whole = await browser.newBrowserCDPSession();

async function residentBytes(kind) {
    const { processInfo } = await whole.send('SystemInfo.getProcessInfo');
    const sizes = await Promise.all(
        processInfo
            .filter(({ type }) => type === kind)
            .map(async ({ id }) => Number(/VmRSS:\s+(\d+)/.exec(await readFile(`/proc/${id}/status`, 'utf8'))?.[1] ?? 0) * 1024),
    );
    return Math.max(0, ...sizes);
}

async function figures() {
    await session.send('HeapProfiler.collectGarbage');
    const { usedSize } = await session.send('Runtime.getHeapUsage');
    const { documents, nodes, jsEventListeners } = await session.send('Memory.getDOMCounters');
    const mega = (bytes) => Number((bytes / 1e6).toFixed(2));
    return { heapMB: mega(usedSize), documents, nodes, jsEventListeners, pageMB: mega(await residentBytes('renderer')), gpuMB: mega(await residentBytes('GPU')), workers: page.workers().length };
}

/** Both viewers open, draw all they want, and are gone again. */
const round = () =>
    page.evaluate(async () => {
        const row = document.querySelector('.row');
        const viewers = ['town.stipple', 'other.stipple'].map((src) => {
            const viewer = document.createElement('stipple-viewer');
            viewer.setAttribute('src', src);
            viewer.setAttribute('controls', '');
            row.append(viewer);
            return viewer;
        });
        await Promise.all(viewers.map((viewer) => viewer.whenReady()));
        for (const viewer of viewers)
            do await viewer.settled();
            while (viewer.getClouds().some(({ stage }) => stage === 'opening'));
        viewers[0].dispose();
        row.replaceChildren();
    });

const lines = [];
for (let i = 1; i <= rounds; i++) {
    await round();
    if (i <= 3 || i % Math.max(1, Math.floor(rounds / 10)) === 0) {
        lines.push({ round: i, ...(await figures()) });
        console.log(JSON.stringify(lines.at(-1)));
    }
}
if (complaints.length > 0) console.log('the page complained:', complaints);
await browser.close();
await site.close();
