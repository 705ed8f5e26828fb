// Headless Chromium with a software WebGL2, and the page in it.
import { mkdir } from 'node:fs/promises';
import { join } from 'node:path';
import { chromium, firefox } from 'playwright-core';

/** Of every start: no window, WebGL in software, no outside host. */
export const flags = [
    '--no-sandbox',
    '--headless=new',
    '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
    '--ignore-gpu-blocklist',
    '--disable-background-networking',
    '--no-first-run',
    '--disable-sync',
    '--disable-component-update',
    '--disable-quic',
];

export const executable = process.env.STIPPLE_CHROMIUM ?? '/usr/bin/chromium';

/** Which browser the tests run in: chromium, or firefox (scripts/test_firefox.sh). */
const kind = process.env.STIPPLE_BROWSER ?? 'chromium';
if (!['chromium', 'firefox'].includes(kind)) throw new Error(`STIPPLE_BROWSER is ${kind}; it must be chromium or firefox`);

/**
 * What the tests cannot do in Firefox, for want of a driver: Debian's Firefox is driven over WebDriver BiDi, which tells Playwright nothing of
 * downloads, sends no touches, makes two clicks of a double click, and loses the Tab key to the window's own buttons.
 */
const lacking = { firefox: ['downloads', 'touch', 'double clicks', 'Tab beyond the page', 'the protocol of Chromium'] }[kind] ?? [];

/** For a test's `skip`: a reason if it needs what this browser's driver lacks, false otherwise. */
export function unless(...needs) {
    const missing = needs.filter((need) => lacking.includes(need));
    return missing.length > 0 && `the driver of ${kind} has no ${missing.join(', no ')}`;
}

export async function launch() {
    if (kind === 'chromium') return chromium.launch({ executablePath: executable, args: flags });
    // Without a window it has no WebGL2 in software: it draws on a virtual screen.
    const browser = await firefox.launch({
        channel: 'moz-firefox',
        executablePath: process.env.STIPPLE_FIREFOX ?? '/usr/bin/firefox-esr',
        headless: false,
        firefoxUserPrefs: { 'webgl.force-enabled': true },
    });
    await typeWhatIsFilled(browser);
    return browser;
}

/** Fields that BiDi fills do not know that a person changed them, so no change event follows: they are typed into, but for sliders. */
async function typeWhatIsFilled(browser) {
    const page = await browser.newPage(), locators = Object.getPrototypeOf(page.locator('input')), { fill } = locators;
    locators.fill = async function (text) {
        if ((await this.getAttribute('type')) === 'range') return fill.call(this, text);
        await this.focus();
        await this.selectText();
        await this.page().keyboard.press('Delete');
        await this.page().keyboard.type(text);
    };
    await page.close();
}

/** A page of its own; `complaints` collects what it logs as an error and every uncaught exception. */
export async function openPage(browser, { width = 640, height = 480 } = {}) {
    const page = await browser.newPage({ viewport: { width, height }, deviceScaleFactor: 1 });
    page.setDefaultTimeout(20_000);
    // Nobody answers a picker: files are downloaded, as in browsers without one (files.mjs has one that answers).
    await page.addInitScript(() => (window.showSaveFilePicker = undefined));
    const complaints = [];
    page.on('console', (message) => {
        if (message.type() === 'error' || message.type() === 'warning') complaints.push(message.text());
    });
    page.on('pageerror', (error) => complaints.push(String(error)));
    return { page, complaints };
}

/** Waits until everything the picture wants is drawn. */
export async function settle(page) {
    await page.waitForFunction(() => window.stipple !== undefined);
    await page.evaluate(() => window.stipple.settled());
    return counters(page);
}

/** Waits until a cloud is open and drawn whole. */
export async function settleWithPoints(page) {
    await page.waitForFunction(() => {
        const counters = window.stipple?.counters();
        return counters?.settled && counters.frame.pointsDrawn > 0;
    });
    return counters(page);
}

export function counters(page) {
    return page.evaluate(() => window.stipple.counters());
}

export async function readPixels(page) {
    const { width, height, base64 } = await page.evaluate(() => window.stipple.readPixels());
    return { width, height, rgba: Buffer.from(base64, 'base64') };
}

/** Keeps a screenshot where STIPPLE_E2E_PICTURES says, if it does. */
export async function keepScreenshot(page, name) {
    const folder = process.env.STIPPLE_E2E_PICTURES;
    if (!folder) return;
    await mkdir(folder, { recursive: true });
    // Hiding the caret would take a style that the page's policy forbids.
    await page.screenshot({ path: join(folder, `${name}.jpg`), type: 'jpeg', quality: 82, caret: 'initial' });
}
