// Files that the page writes to the disk, without a person who says where: in the browser's own file system (OPFS).

/** The picker answers with a file of that file system; `failAfter`: more bytes than that can't be written. */
export function answerPicker(page, failAfter = Infinity) {
    return page.evaluate((most) => {
        window.showSaveFilePicker = async ({ suggestedName }) => {
            const folder = await navigator.storage.getDirectory();
            const handle = await folder.getFileHandle(suggestedName, { create: true });
            handle.remove ??= () => folder.removeEntry(suggestedName);
            window.biggestWrite = 0;
            const create = handle.createWritable.bind(handle);
            handle.createWritable = async () => {
                const to = await create(), write = to.write.bind(to);
                let written = 0;
                to.write = async (chunk) => {
                    const size = (chunk.data ?? chunk).byteLength;
                    written += size;
                    window.biggestWrite = Math.max(window.biggestWrite, size);
                    if (written > most) throw new DOMException('The disk is full.', 'QuotaExceededError');
                    await write(chunk);
                };
                return to;
            };
            return handle;
        };
    }, failAfter);
}

/** What a file there holds; null: there is none. */
export async function pickedFile(page, name) {
    const base64 = await page.evaluate(async (wanted) => {
        const folder = await navigator.storage.getDirectory();
        const handle = await folder.getFileHandle(wanted).catch(() => null);
        if (!handle) return null;
        const bytes = new Uint8Array(await (await handle.getFile()).arrayBuffer());
        let binary = '';
        for (let at = 0; at < bytes.length; at += 0x8000) binary += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
        return btoa(binary);
    }, name);
    return base64 === null ? null : Buffer.from(base64, 'base64');
}
export async function waitForPicked(page, name, isWhole) {
    for (let tries = 0; tries < 200; tries++) {
        const file = await pickedFile(page, name);
        if (file && isWhole(file)) return file;
        await new Promise((resolve) => setTimeout(resolve, 100));
    }
    throw new Error(`${name} did not come`);
}
