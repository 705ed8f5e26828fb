import type { Model } from '../model.ts';

/** The clouds that an attribute like `src` names: their addresses, separated by spaces. */
export class SrcClouds {
    private readonly ids = new Map<string, number>(); // by address

    /** Opens those that are new in it, and closes those that are no longer there. Others that are open stay. */
    open(src: string | null, model: Model): void {
        const wanted = new Set((src ?? '').split(/\s+/).filter(Boolean));
        for (const [address, id] of this.ids) {
            if (wanted.has(address)) continue;
            this.ids.delete(address);
            model.opened.close(id);
        }
        for (const address of wanted)
            if (!this.ids.has(address)) this.ids.set(address, model.opened.openAddress(address));
    }
}
