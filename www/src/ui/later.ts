import type { ReactiveController } from 'lit';

import type { ModelElement } from './model_element.ts';

/** Panels that few want at first: each is loaded when its element first asks for it, which is then shown again. */
export class Later implements ReactiveController {
    private readonly loaded = new Map<string, boolean>(); // false: on its way

    constructor(private readonly host: ModelElement) {
        host.addController(this);
    }
    hostConnected(): void {}

    /** Whether it is here. What keeps it from coming is told; the next call tries again. */
    has(panel: string, load: () => Promise<unknown>): boolean {
        if (!this.loaded.has(panel)) {
            this.loaded.set(panel, false);
            void this.fetch(panel, load);
        }
        return this.loaded.get(panel)!;
    }

    private async fetch(panel: string, load: () => Promise<unknown>): Promise<void> {
        try {
            await load();
            this.loaded.set(panel, true);
            this.host.requestUpdate();
        } catch (error) {
            this.loaded.delete(panel);
            this.host.model.tell(error);
        }
    }
}
