const table = new Uint32Array(256).map((_, value) => {
    for (let bit = 0; bit < 8; bit++) value = value & 1 ? 0xedb88320 ^ (value >>> 1) : value >>> 1;
    return value;
});

/** The check sum of PNG's chunks (PNG, annex D). */
export function crc32(bytes: Uint8Array): number {
    let sum = 0xffffffff;
    for (let i = 0; i < bytes.length; i++) sum = table[(sum ^ bytes[i]!) & 255]! ^ (sum >>> 8);
    return ~sum >>> 0;
}
