// Every tool by mouse, fingers and keys, many times, on a town and on scans: the worst differences from the exact answers (support/
// exact_*.mjs) and from the native program's, as a Markdown table (docs/MEASUREMENTS.md).
//   node tests/e2e/measure_tools.mjs [TRIES] [SCAN …]      after the build of native_answers and scripts/build_web.sh; 5 tries unless told
// SCAN: LAS or LAZ. Exit status 1 if anything is beyond its bound.
import { basename, extname, join } from 'node:path';

import { launch, settle, settleWithPoints } from './support/browser.mjs';
import { readScan } from './support/exact_regions.mjs';
import { scratchFolder, serve, stipple } from './support/program.mjs';
import { keyHand, mouseHand, randomFrom, touchHand } from './support/tool_driver.mjs';
import { tools, ToolRuns } from './support/tool_runs.mjs';

const tries = Number(process.argv[2] ?? 5), scans = process.argv.slice(3);
const headings = [undefined, 90, 33, 180, 12.5];

/** A .stipple file and a LAS file of the same points. */
async function prepared(scan, folder) {
    const name = basename(scan, extname(scan)), cloud = join(folder, `${name}.stipple`);
    await stipple('convert', scan, '-o', cloud);
    const las = extname(scan) === '.las' ? scan : join(folder, `${name}.las`);
    if (las !== scan) await stipple('export', cloud, '-o', las);
    return { name, cloud, las };
}

/** A place in the middle, near enough for polygons to hold some ten thousand points. */
async function comeNear(page) {
    await page.evaluate(() => {
        const [{ bounds, pointCount }] = window.stipple.clouds(), middle = bounds.min.map((low, i) => (low + bounds.max[i]) / 2);
        const area = (bounds.max[0] - bounds.min[0]) * (bounds.max[1] - bounds.min[1]);
        const reach = 0.6 * Math.sqrt((area / pointCount) * Math.min(pointCount, 150_000));
        window.stipple.setCamera({ target: middle, position: middle.map((value, i) => value + [0.2, -0.8, 0.8][i] * reach) });
        window.stipple.setLimits({ pointBudget: 300_000 });
        window.stipple.setStyle({ sizePixels: 3, shape: 'square' });
    });
    await settle(page);
}

async function runAll(browser, folder, scan) {
    const { name, cloud, las } = await prepared(scan, folder), server = await serve(cloud);
    const page = await browser.newPage({ viewport: { width: 1280, height: 720 }, deviceScaleFactor: 1 });
    page.setDefaultTimeout(60_000);
    await page.goto(server.address);
    await settleWithPoints(page);
    await comeNear(page);
    const random = randomFrom(17), runs = new ToolRuns({ page, scan: await readScan(las), cloud, folder });
    const hands = { mouse: mouseHand(page, random), fingers: await touchHand(page, random), keys: keyHand(page, random) };
    for (const [input, hand] of Object.entries(hands)) {
        for (let i = 0; i < tries; i++) {
            for (const tool of tools) await runs.measure(tool, input, hand);
            await runs.profile(input, hand);
            await runs.clip(input, hand, headings[i % headings.length]);
            await runs.footprint(input, hand);
            await runs.screenPolygon(input, hand);
            process.stderr.write(`${name}, ${input}: ${i + 1} of ${tries}\n`);
        }
        await comeNear(page);
    }
    await runs.askNatively();
    await page.close();
    await server.stop();
    return { name, points: runs.scan.count, rows: runs.rows, faults: runs.faults };
}

const number = (value) => (value === 0 ? '0' : value.toExponential(1));

/** The worst of all inputs of each tool: tries of each, where it was worst, from the native answer. */
function table(results) {
    console.log('| tool | cloud | tries by mouse, fingers, keys | worst difference from the exact answer | of | from the native one |');
    console.log('|---|---|---|---|---|---|');
    for (const { name, rows } of results)
        for (const tool of new Set(rows.map((row) => row.tool))) {
            const own = rows.filter((row) => row.tool === tool), worst = own.reduce((a, b) => (b.off > a.off ? b : a));
            const points = own.reduce((sum, row) => sum + row.points, 0), what = points > 0 ? `${worst.field}; ${points.toLocaleString('en')} points in all` : worst.field;
            const native = Math.max(...own.map((row) => row.native));
            console.log(`| ${tool} | ${name} | ${own.map((row) => row.tries).join(', ')} | ${number(worst.off)} | ${what} | ${number(native)} |`);
        }
}

const folder = await scratchFolder(), browser = await launch(), results = [];
try {
    const town = join(folder.path, 'town.las');
    await stipple('synth', town, '--points', '300000', '--scene', 'town', '--seed', '1');
    for (const scan of [town, ...scans]) results.push(await runAll(browser, folder.path, scan));
} finally {
    await browser.close();
    await folder.cleanUp();
}
table(results);
const faults = results.flatMap(({ name, faults: own }) => own.map((fault) => `${name}: ${fault}`));
for (const fault of faults) console.error(fault);
process.exitCode = faults.length > 0 ? 1 : 0;
