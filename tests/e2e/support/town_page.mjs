// A page with a small town in large points, for a whole test file: its browser, server and files with it.
import { launch, openPage, settle, settleWithPoints } from './browser.mjs';
import { makeTown, scratchFolder, serve } from './program.mjs';

/** `town`: of makeTown(). {page, complaints, folder (of the clouds), address, browser, close()}. */
export async function openTownPage(size, town = {}) {
    const folder = await scratchFolder();
    const server = await serve(await makeTown(folder.path, town));
    const browser = await launch();
    const close = async () => {
        await browser.close();
        await server.stop();
        await folder.cleanUp();
    };
    const { page, complaints } = await openPage(browser, size);
    await page.goto(server.address);
    await settleWithPoints(page);
    await page.evaluate(() => window.stipple.setStyle({ sizePixels: 4, shape: 'square' }));
    await settle(page);
    return { page, complaints, folder: folder.path, address: server.address, browser, close };
}

// Arithmetic of vectors, as the tests need it to check what the page says.
export const minus = (a, b) => a.map((value, axis) => value - b[axis]);
export const dot = (a, b) => a.reduce((sum, value, axis) => sum + value * b[axis], 0);
export const norm = (a) => Math.hypot(...a);
export const cross = ([a, b, c], [x, y, z]) => [b * z - c * y, c * x - a * z, a * y - b * x];
