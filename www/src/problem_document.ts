/** What a problem document (RFC 9457) says; undefined where the answer is none. */
export async function reasonOf(response: Response): Promise<string | undefined> {
    try {
        const { detail, title } = (await response.json()) as { detail?: string; title?: string };
        return detail ?? title;
    } catch {
        return undefined;
    }
}
