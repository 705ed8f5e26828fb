// Headless Chromium with a software WebGL2, and the page in it.
import { mkdir } from 'node:fs/promises';
import { join } from 'node:path';
import { chromium } from 'playwright-core';

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

export function launch() {
    return chromium.launch({ executablePath: executable, args: flags });
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
