// The page's tools, driven by real events: mouse, fingers and keys. Each hand takes a tool, points and drags in its own way, and says which
// points the page showed where it pointed.
import { settle } from './browser.mjs';
import { focused, tabTo } from './keyboard.mjs';

/** Whole numbers below `below`, the same for the same seed (Park and Miller's generator). */
export function randomFrom(seed) {
    let state = seed;
    return (below) => (state = (state * 48271) % 2147483647) % below;
}

export const measurements = (page) => page.evaluate(() => window.stipple.measurements());
const key = ({ point }) => `${point.cloud} ${point.node} ${point.index}`;

/** The point that the picture shows at a place, if the canvas is on top there. */
function shownAt(page, { x, y }) {
    return page.evaluate(async ([x, y]) => {
        let at = document.elementFromPoint(x, y);
        while (at?.shadowRoot?.elementFromPoint(x, y) && at.shadowRoot.elementFromPoint(x, y) !== at) at = at.shadowRoot.elementFromPoint(x, y);
        return at?.tagName === 'CANVAS' ? window.stipple.pick(x, y) : null;
    }, [x, y]);
}

/** Waits until the newest measurement has `count` points. */
const taken = (page, count) => page.waitForFunction((n) => window.stipple.measurements().at(-1)?.points.length === n, count);

/** Somewhere in the picture, far from `before`, where there is a point. */
async function findPlace(page, random, before) {
    const { width, height } = page.viewportSize();
    for (let tries = 0; tries < 200; tries++) {
        const place = { x: Math.round(0.33 * width) + random(Math.round(0.62 * width)), y: 40 + random(height - 80) };
        if (before.some((other) => Math.hypot(other.x - place.x, other.y - place.y) < 60)) continue;
        const shown = await shownAt(page, place);
        if (shown && !before.some((other) => key(other.shown) === key(shown))) return { ...place, shown };
    }
    throw new Error('no point was found in the picture');
}

/** Corners around the middle of the free part of the picture, in turn, so that no edge crosses another on the screen; a point shows at each. */
async function findCorners(page, random, count) {
    const { width, height } = page.viewportSize(), middle = { x: 0.64 * width, y: 0.5 * height }, corners = [];
    for (let tries = 0; corners.length < count && tries < 400; tries++) {
        const angle = (2 * Math.PI * (corners.length + random(70) / 100)) / count, part = (35 + random(55)) / 100;
        const place = { x: Math.round(middle.x + part * 0.3 * width * Math.cos(angle)), y: Math.round(middle.y + part * (middle.y - 40) * Math.sin(angle)) };
        const shown = await shownAt(page, place);
        if (shown && !corners.some((other) => key(other.shown) === key(shown))) corners.push({ ...place, shown });
    }
    if (corners.length < count) throw new Error('no points were found around the middle of the picture');
    return corners;
}

/** Waits until a clip polygon that is being drawn has `count` corners. */
const drawn = (page, count) => page.locator(`stipple-clip-overlay [data-drawn="${count}"]`).waitFor({ state: 'attached' });

/** Points by pointing at them. `press`, `point`: a button, a place of the picture; `finish`: ends a polygon whose last corner is at a place. */
const pointing = (page, random, press, point, finish) => ({
    press,
    enter: (locator) => press(locator),
    /** [{x, y, shown}]: the corners of a polygon that is drawn with a button's tool. */
    async polygon(name, count) {
        const button = page.getByRole('button', { name, exact: true });
        const corners = await findCorners(page, random, count);
        await press(button);
        await drawn(page, 0);
        for (const [i, corner] of corners.entries()) {
            await point(corner);
            await drawn(page, i + 1);
        }
        await finish(corners.at(-1), button);
        return corners;
    },
    async measure(name, count) {
        await press(page.getByRole('button', { name, exact: true }));
        const places = [];
        while (places.length < count) {
            places.push(await findPlace(page, random, places));
            await point(places.at(-1));
            await taken(page, places.length);
        }
        const tool = page.getByRole('button', { name, exact: true, pressed: true });
        if ((await tool.count()) > 0) await press(tool); // puts a tool away that takes any number
        return places.map(({ shown }) => shown);
    },
});

export function mouseHand(page, random) {
    const hand = pointing(page, random, (locator) => locator.click(), ({ x, y }) => page.mouse.click(x, y), ({ x, y }) => page.mouse.dblclick(x, y));
    hand.drag = async (locator, dx, dy) => {
        const { x, y } = await middleOf(locator);
        await page.mouse.move(x, y);
        await page.mouse.down();
        await page.mouse.move(x + dx, y + dy, { steps: 6 });
        await page.mouse.up();
    };
    return hand;
}

export async function touchHand(page, random) {
    const session = await page.context().newCDPSession(page);
    const touch = (type, ...points) => session.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(({ x, y }) => ({ x, y })) });
    const tap = async (place) => {
        await touch('touchStart', place);
        await touch('touchEnd');
    };
    const press = async (locator) => tap(await middleOf(locator));
    const hand = pointing(page, random, press, tap, (_, button) => press(button));
    hand.drag = async (locator, dx, dy) => {
        const { x, y } = await middleOf(locator);
        await touch('touchStart', { x, y });
        for (let i = 1; i <= 6; i++) await touch('touchMove', { x: x + (dx * i) / 6, y: y + (dy * i) / 6 });
        await touch('touchEnd');
    };
    return hand;
}

async function middleOf(locator) {
    await locator.scrollIntoViewIfNeeded().catch(() => {}); // what is drawn over the picture does not scroll
    const { x, y, width, height } = await locator.boundingBox();
    return { x: x + width / 2, y: y + height / 2 };
}

/** Without a pointer: Tab and arrows to the tool, arrows to bring places to the middle, the space bar to take them. */
export function keyHand(page, random) {
    const middle = () => page.evaluate(() => [window.innerWidth / 2, window.innerHeight / 2]);
    // To the left and up from where it began, in steps; not far, for there the picture is empty.
    const gone = [0, 0];
    const moveOn = async () => {
        const axis = random(2), sign = gone[axis] >= 2 ? -1 : gone[axis] <= -2 ? 1 : 1 - 2 * random(2);
        gone[axis] += sign;
        await page.keyboard.press(`Shift+Arrow${[['Right', 'Left'], ['Down', 'Up']][axis][(sign + 1) / 2]}`);
    };
    const findPoint = async (before) => {
        for (let tries = 0; tries < 100; tries++) {
            const [x, y] = await middle(), shown = await shownAt(page, { x, y });
            if (shown && !before.some((other) => key(other) === key(shown))) return shown;
            await moveOn();
            await settle(page);
        }
        throw new Error('no point came to the middle of the picture');
    };
    const walkTo = async (name) => {
        if ((await focused(page))?.name !== name) await tabTo(page, name);
    };
    const takeTool = async (name) => {
        await tabTo(page, await stopOfToolbar(page, name));
        for (let i = 0; i < 8 && (await focused(page)).name !== name; i++) await page.keyboard.press('ArrowRight');
        await page.keyboard.press('Enter');
    };
    /** Points that come to the middle, one after the other. */
    const takePoints = async (count, isTaken) => {
        const shown = [];
        while (shown.length < count) {
            shown.push(await findPoint(shown));
            await page.keyboard.press(' ');
            await isTaken(page, shown.length);
            for (let i = 0; i < 2; i++) await moveOn();
            await settle(page);
        }
        await page.keyboard.press('Enter');
        return shown;
    };
    /** Corners that the arrows bring the cursor to, from the middle of the picture. */
    const takeCorners = async () => {
        let [x, y] = await middle();
        const corners = [], go = async (arrow, steps, dx, dy) => {
            for (let i = 0; i < steps; i++) await page.keyboard.press(arrow);
            [x, y] = [x + steps * dx, y + steps * dy];
        };
        const ways = [['ArrowUp', 0, -20], ['ArrowRight', 20, 0], ['ArrowDown', 0, 20]];
        for (const [arrow, dx, dy] of ways) {
            await go(arrow, 3 + random(3), dx, dy);
            await go('Shift+ArrowLeft', 1 + random(4), -4, 0);
            await page.keyboard.press(' ');
            corners.push({ x, y });
            await drawn(page, corners.length);
        }
        await page.keyboard.press('Enter');
        return corners;
    };
    return {
        async measure(name, count) {
            await takeTool(name);
            return takePoints(count, taken);
        },
        /** Of three corners: [{x, y}] on the screen, [{shown}] on the ground. */
        async polygon(name) {
            await takeTool(name);
            await drawn(page, 0);
            if (name === 'Polygon on the screen') return takeCorners();
            return (await takePoints(3, drawn)).map((shown) => ({ shown }));
        },
        enter: async (locator) => void (await tabTo(page, await locator.getAttribute('aria-label'))),
        async press(locator) {
            const name = await locator.evaluate((element) => element.getAttribute('aria-label') ?? element.textContent.trim());
            if (await locator.evaluate((element) => element.closest('[role=toolbar]') !== null)) return takeTool(name);
            await walkTo(name);
            await page.keyboard.press('Enter');
        },
    };
}

/** The tool of the row that the Tab key comes to. */
function stopOfToolbar(page, name) {
    return page.getByRole('toolbar').filter({ has: page.getByRole('button', { name, exact: true }) }).locator('button[tabindex="0"]').textContent().then((text) => text.trim());
}
