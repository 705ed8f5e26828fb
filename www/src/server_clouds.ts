import type { Bounds } from './wasm/values.ts';
import { Problem } from './texts/message.ts';
import type { Requests } from './wasm/requests.ts';

/** A cloud that the server offers, as GET api/v1/clouds lists it. */
export interface ListedCloud {
    id: string;
    name: string;
    /** Of the file, absolute or relative to the page. */
    address: string;
    pointCount: number;
    /** World box of its points. */
    bounds?: Bounds | null;
}

/** Some of the clouds, and where the list goes on. */
export interface CloudPage {
    clouds: ListedCloud[];
    /** Address; absent: these are the last. */
    next?: string;
}

/** What a server has; nothing where it is a plain file host. `next` of the page before. */
export async function listClouds(server: URL, requests: Requests, next = 'api/v1/clouds'): Promise<CloudPage> {
    const response = await requests.fetch(new URL(next, server).href, { cache: 'no-store' });
    if (response.status === 404) return { clouds: [] };
    if (!response.ok) throw new Problem('clouds.listFailed', { status: String(response.status) });
    if (!response.headers.get('content-type')?.includes('json')) return { clouds: [] };
    const page = (await response.json()) as CloudPage;
    return { ...page, clouds: page.clouds.map((cloud) => ({ ...cloud, address: fromPage(cloud.address, server) })) };
}

/** Addresses of the page's own server stay relative, so that scenes work where the page is moved to. */
function fromPage(address: string, server: URL): string {
    const absolute = new URL(address, server).href;
    return new URL(address, document.baseURI).href === absolute ? address : absolute;
}
