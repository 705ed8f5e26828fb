import type { ReactiveController } from 'lit';

import type { Histogram, HistogramRequest } from '../wasm/values.ts';
import type { ModelElement } from './model_element.ts';

/** Has values counted among the points in view as long as its element is seen, and shows the element again with new counts. */
export class Counted implements ReactiveController {
    private isSeen = false;
    private readonly sight = new IntersectionObserver((entries) => {
        this.isSeen = entries.at(-1)?.isIntersecting ?? false;
        this.hostUpdated();
    });
    private readonly follow = (): void => this.host.requestUpdate();

    constructor(
        private readonly host: ModelElement,
        private readonly request: () => HistogramRequest,
    ) {
        host.addController(this);
    }

    /** Undefined as long as it has not been counted. */
    get histogram(): Histogram | undefined {
        return this.host.model.counting.histogram(this.request());
    }

    hostConnected(): void {
        this.host.model.counting.addEventListener('change', this.follow);
        this.sight.observe(this.host);
    }
    hostDisconnected(): void {
        this.sight.disconnect();
        this.isSeen = false;
        this.hostUpdated();
        this.host.model.counting.removeEventListener('change', this.follow);
    }
    hostUpdated(): void {
        if (this.isSeen) this.host.model.counting.want(this, this.request());
        else this.host.model.counting.forget(this);
    }
}
