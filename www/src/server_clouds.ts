import { Problem } from './texts/message.ts';

/** A cloud that the server offers, as GET api/v1/clouds lists it. */
export interface ListedCloud {
    id: string;
    name: string;
    /** Of the file, absolute or relative to the page. */
    address: string;
    pointCount: number;
}

/** Some of the clouds, and where the list goes on. */
export interface CloudPage {
    clouds: ListedCloud[];
    /** Address; absent: these are the last. */
    next?: string;
}

/** What the server that delivered this page has; nothing where it is a plain file host. `next` of the page before. */
export async function listClouds(next = 'api/v1/clouds'): Promise<CloudPage> {
    const response = await fetch(new URL(next, document.baseURI), { cache: 'no-store' });
    if (response.status === 404) return { clouds: [] };
    if (!response.ok) throw new Problem('clouds.listFailed', { status: String(response.status) });
    if (!response.headers.get('content-type')?.includes('json')) return { clouds: [] };
    return (await response.json()) as CloudPage;
}
