import { Problem } from '../texts/message.ts';

/** Scenes in the fragment of an address, which no server gets to see: deflated (RFC 1951), in base64url (RFC 4648 §5). */

const prefix = '#scene=';
/** A link can't make the page unpack more. */
const mostUnpackedBytes = 1 << 20;

export function isSceneFragment(fragment: string): boolean {
    return fragment.startsWith(prefix);
}

export async function toFragment(text: string): Promise<string> {
    const packed = await collect(new Blob([text]).stream().pipeThrough(new CompressionStream('deflate-raw')));
    let binary = '';
    for (const byte of packed) binary += String.fromCharCode(byte);
    return prefix + btoa(binary).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
}

/** Throws a sentence for a fragment that is cut or damaged. */
export async function fromFragment(fragment: string): Promise<string> {
    try {
        const binary = atob(fragment.slice(prefix.length).replaceAll('-', '+').replaceAll('_', '/'));
        const packed = Uint8Array.from(binary, (c) => c.charCodeAt(0));
        const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate-raw'));
        return new TextDecoder('utf-8', { fatal: true }).decode(await collect(stream));
    } catch {
        throw new Problem('scene.linkDamaged');
    }
}

async function collect(stream: ReadableStream<Uint8Array>): Promise<Uint8Array> {
    const parts: Uint8Array[] = [];
    let size = 0;
    const reader = stream.getReader();
    for (;;) {
        const { done, value } = await reader.read();
        if (done) break;
        parts.push(value);
        size += value.length;
        if (size > mostUnpackedBytes) {
            await reader.cancel();
            throw new Error('it is too large');
        }
    }
    const whole = new Uint8Array(size);
    let at = 0;
    for (const part of parts) {
        whole.set(part, at);
        at += part.length;
    }
    return whole;
}
