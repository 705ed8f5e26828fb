import type { Model } from './model.ts';
import { type CloudPage, listClouds, type ListedCloud } from './server_clouds.ts';

/** The clouds that the page's server offers, as far as its list was read. */
export class CloudListing {
    clouds: ListedCloud[] = [];
    /** Why there is no more of it; may be empty. */
    error = '';
    private next: string | undefined;

    constructor(private readonly model: Model) {}

    get goesOn(): boolean {
        return this.next !== undefined;
    }

    /** The first page of it, in place of what is here. */
    async take(page: Promise<CloudPage>): Promise<void> {
        await this.add(page, []);
    }
    async anew(): Promise<void> {
        const { server, requests } = this.model;
        if (server) await this.take(listClouds(server, requests));
    }
    async more(): Promise<void> {
        const { next } = this, { server, requests } = this.model;
        this.next = undefined;
        if (next !== undefined && server) await this.add(listClouds(server, requests, next), this.clouds);
    }

    /** All of them: those in view are opened, the others when they come into view. */
    async openAll(): Promise<void> {
        while (this.goesOn && !this.model.isDisposed) await this.more();
        if (this.model.isDisposed) return;
        for (const { address, name, bounds } of this.clouds) this.model.opened.openAddress(address, name, bounds);
    }

    private async add(page: Promise<CloudPage>, before: ListedCloud[]): Promise<void> {
        const { access, texts } = this.model;
        this.error = '';
        try {
            const { clouds, next } = await page;
            this.clouds = [...before, ...clouds];
            this.next = next;
            access.granted('list');
        } catch (error) {
            if (!access.takes(error, 'list', () => void this.anew())) this.error = texts.sentenceOf(error);
        }
        this.model.changed();
    }
}
