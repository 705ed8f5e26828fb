// Runs of the page's tools by every hand (tool_driver.mjs), and what came of them against what is right (tool_checks.mjs).
import { settle } from './browser.mjs';
import { tabTo } from './keyboard.mjs';
import { bound, clipDifferences, differenceFromNative, errorsOf, nativeAnswers, profileDifferences, recordDifferences, requestOf } from './tool_checks.mjs';
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
        await hand.press(page.getByRole('button', { name: 'Close the profile' }));
        await this.#clear();
    }

    /** A new box that is changed by hand: the points inside, as the file that the panel offers. `turn`: degrees that are typed. */
    async clip(input, hand, turn) {
        const { page } = this, row = this.#row('Clip export', input);
        await hand.press(page.getByRole('button', { name: 'New box' }));
        await page.locator('[data-box="0"]').waitFor();
        await settle(page);
        if (hand.drag) {
            await hand.drag(page.locator('stipple-clip-overlay [data-face="x+"]'), 35, 14);
            await hand.drag(page.locator('stipple-clip-overlay [data-handle=centre]'), -25, 12);
            if (turn === undefined) await hand.drag(page.locator('stipple-clip-overlay [data-handle=turn]'), 30, 40);
        } else {
            await tabTo(page, 'Size x of Box 1');
            await this.#type(String(20 + row.tries * 7.25));
        }
        if (turn !== undefined) {
            if (hand.drag) await page.getByLabel('Heading of Box 1').focus();
            else await tabTo(page, 'Heading of Box 1');
            await this.#type(String(turn));
        }
        await settle(page);
        const box = (await page.evaluate(() => window.stipple.style())).clipBoxes[0];
        const address = await page.locator('[data-box="0"] a', { hasText: /^LAS$/ }).getAttribute('href');
        const { points, off, native } = await clipDifferences(address, box, this.scan, this.cloud, this.folder);
        row.tries++;
        row.points += points;
        row.native = Math.max(row.native, native);
        this.#take(row, [
            { field: 'points', off, bound: 0 },
            { field: 'native', off: native, bound: 0 },
        ]);
        await hand.press(page.getByRole('button', { name: 'Delete Box 1' }));
        await settle(page);
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
