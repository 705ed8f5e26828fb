import type { Model } from './model.ts';
import { reasonOf } from './problem_document.ts';
import { Problem } from './texts/message.ts';
import { download, follow } from './ui/download.ts';

/**
 * Saves the file that a server makes under that address. The browser does that by itself, as the bytes come, once the server was asked whether it
 * would; where requests carry what a link can't (tokens, headers), the page fetches it whole first. What goes wrong is told.
 */
export async function saveServed(model: Model, href: string, name: string): Promise<void> {
    const { requests, access } = model;
    try {
        const isLink = !requests.addTo(href);
        const answer = await requests.fetch(href, { method: isLink ? 'HEAD' : 'GET' });
        access.granted('file');
        if (!answer.ok) throw await refusalOf(isLink ? await requests.fetch(href) : answer, name);
        if (isLink) follow(href, name);
        else download(await answer.blob(), name);
    } catch (error) {
        if (!access.takes(error, 'file', () => void saveServed(model, href, name))) model.tell(error);
    }
}

async function refusalOf(response: Response, name: string): Promise<Error> {
    const reason = (await reasonOf(response)) ?? String(response.status);
    return new Problem('file.refused', { name, reason });
}
