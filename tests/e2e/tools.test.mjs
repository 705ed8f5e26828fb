// Every tool by mouse, fingers and keys on a small town, against the exact answer and the native program's. Many tries, on a real scan
// too: scripts/measure_tools.mjs.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';

import { readScan } from './support/exact_regions.mjs';
import { keyHand, mouseHand, randomFrom, touchHand } from './support/tool_driver.mjs';
import { tools, ToolRuns } from './support/tool_runs.mjs';
import { openTownPage } from './support/town_page.mjs';

let town, runs, hands;

before(async () => {
    town = await openTownPage({ width: 700, height: 420 }, { points: 20_000 });
    const { page, folder } = town, cloud = join(folder, 'town.stipple'), random = randomFrom(7);
    runs = new ToolRuns({ page, scan: await readScan(join(folder, 'town.las')), cloud, folder });
    hands = { mouse: mouseHand(page, random), fingers: await touchHand(page, random), keys: keyHand(page, random) };
});

after(() => town?.close());

describe('every tool, by every hand', () => {
    for (const input of ['mouse', 'fingers', 'keys'])
        test(`${input}: what is measured is exact, files have the points of the scan`, async () => {
            for (const tool of tools) await runs.measure(tool, input, hands[input]);
            await runs.profile(input, hands[input]);
            await runs.clip(input, hands[input], { mouse: undefined, fingers: 90, keys: 30 }[input]);
            await runs.footprint(input, hands[input]);
            await runs.screenPolygon(input, hands[input]);
            await runs.askNatively();
            for (const row of runs.rows.filter((row) => row.input === input))
                console.log(`  ${row.tool}: ${row.off.toExponential(1)} (${row.field}), from native ${row.native.toExponential(1)}`);
            assert.deepEqual(runs.faults, []);
            assert.deepEqual(town.complaints, []);
        });
});
