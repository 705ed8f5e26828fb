/** A cloud that the server offers, as GET api/v1/clouds lists it. */
export interface ListedCloud {
    id: string;
    name: string;
    /** Of the file, relative to the page. */
    address: string;
    pointCount: number;
}

/** What the server that delivered this page has; empty where it is a plain file host. */
export async function listClouds(): Promise<ListedCloud[]> {
    const response = await fetch(new URL('api/v1/clouds', document.baseURI), { cache: 'no-store' });
    if (response.status === 404) return [];
    if (!response.ok) throw new Error(`The server's list of clouds can't be had: status ${response.status}.`);
    if (!response.headers.get('content-type')?.includes('json')) return [];
    const list = (await response.json()) as ListedCloud[] | { clouds: ListedCloud[] };
    return Array.isArray(list) ? list : list.clouds;
}
