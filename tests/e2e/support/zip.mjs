// Entries of a ZIP file that are stored as they are (PKWARE's APPNOTE 6.3, 4.3.12 and 4.3.7), by name in their order.
export function storedEntries(file) {
    const end = file.lastIndexOf(Buffer.from('PK\x05\x06', 'latin1'));
    const entries = new Map();
    let at = file.readUInt32LE(end + 16);
    for (let i = 0; i < file.readUInt16LE(end + 10); i++) {
        const [method, size] = [file.readUInt16LE(at + 10), file.readUInt32LE(at + 24)];
        const [nameSize, extraSize, commentSize] = [28, 30, 32].map((field) => file.readUInt16LE(at + field));
        const name = file.toString('utf8', at + 46, at + 46 + nameSize);
        if (method !== 0) throw new Error(`${name} is not stored`);
        const local = file.readUInt32LE(at + 42);
        const start = local + 30 + file.readUInt16LE(local + 26) + file.readUInt16LE(local + 28);
        entries.set(name, file.subarray(start, start + size));
        at += 46 + nameSize + extraSize + commentSize;
    }
    return entries;
}
