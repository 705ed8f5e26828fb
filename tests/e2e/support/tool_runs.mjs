// Runs of the page's tools by every hand (tool_driver.mjs), and what came of them against what is right (tool_checks.mjs).
import { settle } from './browser.mjs';
import { between, pointsInFootprint, pointsShownIn, projection } from './exact_polygons.mjs';
import { pointsInBox, pointsInCorridor } from './exact_regions.mjs';
import {
    bound,
    differenceFromNative,
    errorsOf,
    exportDifferences,
    nativeAnswers,
    profileDifferences,
    recordDifferences,
    requestOf,
} from './tool_checks.mjs';
import { measurements } from './tool_driver.mjs';

/** Points of each tool, by pointers; keys take three where any number goes. */
const corners = { Point: 1, Distance: 3, Height: 2, Angle: 3, Area: 4, Circle: 3, Azimuth: 2, Volume: 4 };
export const tools = Object.keys(corners);

const identity = ({ integers, point }) => JSON.stringify([integers, point]);

/** Of one cloud on one page. `scan`: its LAS file, read by readScan(). */
export class ToolRuns {
    /** {tool, input, tries, off, field, bound, native}: the worst of each tool and input. */
    rows = [];
    /** What is beyond its bound, in words. */
    faults = [];
    #measured = [];

    constructor({ page, scan, cloud, folder }) {
        Object.assign(this, { page, scan, cloud, folder });
    }

    #row(tool, input) {
        const known = this.rows.find((row) => row.tool === tool && row.input === input);
        const row = known ?? { tool, input, tries: 0, off: 0, field: '', native: 0, points: 0 };
        if (!known) this.rows.push(row);
        return row;
    }
    #take(row, errors) {
        for (const { field, off, bound } of errors) {
            if (off >= row.off) Object.assign(row, { off, field });
            if (!(off <= bound)) this.faults.push(`${row.tool} by ${row.input}, ${field}: off by ${off}, more than ${bound}`);
        }
    }
    async #last(isDone = (item) => item.answer ?? item.error) {
        for (;;) {
            const item = (await measurements(this.page)).at(-1);
            if (item && isDone(item)) return item;
            await this.page.waitForTimeout(30);
        }
    }
    async #clear() {
        for (const { name } of await measurements(this.page)) await this.page.getByRole('button', { name: `Delete ${name}`, exact: true }).click();
    }

    /** Takes the tool, its points; the item. What the page showed at these places is what it has to have taken. */
    async #draw(tool, input, hand) {
        const count = input === 'keys' ? Math.min(3, corners[tool]) : corners[tool];
        for (;;) {
            const shown = await hand.measure(tool, count);
            const item = await this.#last((it) => it.share === undefined && (it.answer ?? it.error));
            const isTaken = item.points.length === count && item.points.every((point, i) => identity(point) === identity(shown[i]));
            if (!isTaken) this.faults.push(`${tool} by ${input}: took other points than the picture showed`);
            if (!item.error) return { item, shown };
            if (!/cross/.test(item.error)) throw new Error(`${tool}: ${item.error}`);
            await this.#clear(); // corners at random; another time they lie better
        }
    }

    async measure(tool, input, hand) {
        const row = this.#row(tool, input);
        const { item, shown } = await this.#draw(tool, input, hand);
        row.tries++;
        this.#take(row, errorsOf(item, this.scan));
        this.#measured.push({ row, request: requestOf(item), answer: item.answer });
        if (tool === 'Point') this.#take(row, [{ field: 'values', off: recordDifferences(shown[0], this.scan), bound: 0 }]);
        if (tool === 'Volume') await this.#overPlane(row);
        await this.#clear();
    }

    /** The same volume over a level plane, at the height of its lowest corner. */
    async #overPlane(row) {
        const before = JSON.stringify((await measurements(this.page)).at(-1).answer), list = this.page.locator('[data-measurement=volume] select');
        await list.focus();
        await this.page.keyboard.press('End');
        const item = await this.#last((it) => it.share === undefined && it.base?.from === 'height' && it.answer && JSON.stringify(it.answer) !== before);
        this.#take(row, errorsOf(item, this.scan));
        this.#measured.push({ row, request: requestOf(item), answer: item.answer });
    }

    /** Along a distance that was measured: the points of the file that the panel offers, and how many it says it shows. */
    async profile(input, hand) {
        const { page } = this, row = this.#row('Profile', input);
        const { item } = await this.#draw('Distance', input, hand);
        await hand.press(page.getByRole('button', { name: 'Profile', exact: true }));
        const panel = page.getByRole('complementary', { name: 'Profile' });
        await panel.getByRole('status').filter({ hasText: 'complete' }).waitFor({ timeout: 120_000 });
        const width = Number(await page.getByLabel('Width of the profile').inputValue());
        const address = await panel.getByRole('link', { name: 'CSV' }).getAttribute('href');
        const shown = Number(await panel.getByRole('status').first().getAttribute('data-points'));
        const line = item.points.map(({ position }) => position);
        const { points, off, offPlace, native } = await profileDifferences(address, line, width, this.scan, this.cloud, this.folder);
        row.tries++;
        row.points += points;
        row.native = Math.max(row.native, native);
        this.#take(row, [
            { field: 'points', off, bound: 0 },
            { field: 'points shown', off: Math.abs(shown - points), bound: 0 },
            { field: 'station, offset', off: offPlace, bound },
            { field: 'native', off: native, bound: 0 },
        ]);
        await this.#corridor(input, hand);
        await hand.press(page.getByRole('button', { name: 'Close the profile' }));
        await this.#clear();
    }

    /** A new box that is changed by hand: the points inside, as the file that the panel offers. `turn`: degrees that are typed. */
    async clip(input, hand, turn) {
        const { page } = this, row = this.#row('Clip box', input);
        await hand.press(page.getByRole('button', { name: 'New box' }));
        await page.locator('[data-box="0"]').waitFor();
        await settle(page);
        if (hand.drag) {
            await hand.drag(page.locator('stipple-clip-overlay [data-face="x+"]'), 35, 14);
            await hand.drag(page.locator('stipple-clip-overlay [data-handle=centre]'), -25, 12);
            if (turn === undefined) await hand.drag(page.locator('stipple-clip-overlay [data-handle=turn]'), 30, 40);
        } else {
            await hand.enter(page.getByLabel('Size x of Box 1'));
            await this.#type(String(20 + row.tries * 7.25));
        }
        if (turn !== undefined) {
            await hand.enter(page.getByLabel('Heading of Box 1'));
            await this.#type(String(turn));
        }
        await settle(page);
        const box = (await this.#style()).clipBoxes[0];
        const { mode, ...inside } = box;
        await this.#export(row, page.locator('[data-box="0"]'), pointsInBox(this.scan, box), { box: inside });
        await hand.press(page.getByRole('button', { name: 'Delete Box 1' }));
        await settle(page);
    }

    /** The corridor of the profile that is open, as a clip between two heights. */
    async #corridor(input, hand) {
        const { page, scan } = this, row = this.#row('Clip corridor', input);
        await page.getByLabel('In the picture').focus();
        await page.keyboard.press('End'); // alone
        const { line, width } = (await this.#region()).region, all = pointsInCorridor(scan, line, width).map(({ index }) => index);
        const heights = await this.#enterHeights('Corridor 1', all, hand);
        await this.#export(row, this.#item(), between(scan, all, heights), { line, width, heights });
    }

    /** A polygon on the ground, between two heights that points have. */
    async footprint(input, hand) {
        const { scan } = this, row = this.#row('Clip footprint', input);
        const corners = await this.#drawPolygon('Polygon on the ground', hand), { polygon } = (await this.#region()).region;
        if (JSON.stringify(polygon) !== JSON.stringify(corners.map(({ shown }) => shown.position.slice(0, 2))))
            this.faults.push(`Clip footprint by ${input}: took other corners than the picture showed`);
        const heights = await this.#enterHeights('Polygon 1', pointsInFootprint(scan, { polygon }), hand);
        await this.#export(row, this.#item(), pointsInFootprint(scan, { polygon, heights }), { polygon, heights });
        await this.#deletePolygon(hand);
    }

    /** A polygon on the screen: what shows in it, as one sees it. */
    async screenPolygon(input, hand) {
        const { page, scan } = this, row = this.#row('Clip screen polygon', input);
        const ring = (await this.#drawPolygon('Polygon on the screen', hand)).map(({ x, y }) => [x, y]);
        const camera = await page.evaluate(() => window.stipple.camera());
        const { inside, unsure } = pointsShownIn(scan, ring, projection(camera, await page.locator('canvas').boundingBox()));
        await this.#export(row, this.#item(), inside, (await this.#region()).region, unsure.length);
        await this.#deletePolygon(hand);
    }

    /** Corners at random; another time they lie better if edges cross in plan. */
    async #drawPolygon(name, hand) {
        for (;;) {
            const corners = await hand.polygon(name, 5), refused = this.page.getByRole('alert').filter({ hasText: 'cross' });
            await this.#item().or(refused).first().waitFor({ state: 'attached' });
            if ((await refused.count()) === 0) return corners;
            await this.page.getByRole('button', { name: 'Dismiss' }).click();
            await this.page.locator('canvas').press('Escape');
        }
    }
    async #deletePolygon(hand) {
        await hand.press(this.page.getByRole('button', { name: 'Delete Polygon 1' }));
        await this.#item().waitFor({ state: 'detached' });
        await settle(this.page);
    }

    /** Those of the points at a quarter and at most of the way up: types them. */
    async #enterHeights(name, points, hand) {
        const all = points.map((i) => this.scan.placeOf(i)[2]).sort((a, b) => a - b);
        const heights = [0.25, 0.95].map((part) => all[Math.floor(part * (all.length - 1))]);
        for (const [i, label] of [`Lowest height of ${name}`, `Highest height of ${name}`].entries()) {
            await hand.enter(this.page.getByLabel(label));
            await this.#type(String(heights[i]));
        }
        const { region } = await this.#region();
        if (JSON.stringify(region.heights) !== JSON.stringify(heights)) this.faults.push(`${name}: heights ${region.heights}, not ${heights}`);
        return heights;
    }
    /** The LAS file that a list entry offers, against the points that are right; `unsure` of all may be in it or not. */
    async #export(row, item, right, region, unsure = 0) {
        await settle(this.page);
        const address = await item.locator('a', { hasText: /^LAS$/ }).getAttribute('href');
        const { points, off, native } = await exportDifferences(address, right, region, this);
        row.tries++;
        row.points += points;
        row.native = Math.max(row.native, native);
        this.#take(row, [
            { field: 'points', off: Math.max(0, off - unsure), bound: 0 },
            { field: 'native', off: native, bound: 0 },
        ]);
        if (points === 0) this.faults.push(`${row.tool} by ${row.input}: no points, nothing was tested`);
    }
    #item() {
        return this.page.locator('li[data-region="0"]');
    }
    async #style() {
        return this.page.evaluate(() => window.stipple.style());
    }
    async #region() {
        await this.#item().waitFor({ state: 'attached' });
        return (await this.#style()).clipRegions[0];
    }
    async #type(text) {
        await this.page.keyboard.press('ControlOrMeta+a');
        await this.page.keyboard.type(text);
        await this.page.keyboard.press('Enter');
    }

    /** Holds what was measured against the native program's answers. */
    async askNatively() {
        const answers = await nativeAnswers(this.cloud, this.#measured.map(({ request }) => request));
        this.#measured.forEach(({ row, answer }, i) => {
            const off = differenceFromNative(answer, answers[i]);
            row.native = Math.max(row.native, off);
            if (!(off <= bound)) this.faults.push(`${row.tool} by ${row.input}: ${off} from the native answer`);
        });
        this.#measured = [];
    }
}
