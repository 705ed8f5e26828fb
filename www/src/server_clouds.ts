/** A cloud that the server offers, as GET api/v1/clouds lists it. */
export interface ListedCloud {
    id: string;
    name: string;
    /** Of the file, absolute or relative to the page. */
    address: string;
    pointCount: number;
}

/** What the server that delivered this page has; empty where it is a plain file host. */
export async function listClouds(): Promise<ListedCloud[]> {
    const response = await fetch(new URL('api/v1/clouds', document.baseURI), { cache: 'no-store' });
    if (response.status === 404) return [];
    if (!response.ok) throw new Error(`The server's list of clouds can't be had: status ${response.status}.`);
    if (!response.headers.get('content-type')?.includes('json')) return [];
    return ((await response.json()) as { clouds: ListedCloud[] }).clouds;
}
