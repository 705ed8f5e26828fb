import { followGestures } from '../history/coming_history.ts';
import { followDrops, followInput } from '../input.ts';
import { Model } from '../model.ts';
import { type CloudPage, listClouds } from '../server_clouds.ts';
import { loadTexts, Texts } from '../texts/texts.ts';
import { App } from '../ui/app.ts';
import type { Requests } from '../wasm/requests.ts';
import { tellWhatHappens } from './happenings.ts';
import { failureBox, pictureParts } from './parts.ts';
import { SrcClouds } from './src_clouds.ts';
import type { TellingElement } from './telling_element.ts';

/** Attributes that are followed. */
export const followed = ['src', 'budget', 'controls', 'lang', 'share'] as const;
export type Followed = (typeof followed)[number];

/** One life of a viewer, from its start until it is disposed of: what lies in its box, as its attributes say. */
export class Life {
    /** Resolves when it runs; rejects if it can't, or is ended first. */
    readonly ready: Promise<void>;
    /** While it runs. */
    model: Model | undefined;
    /** The server's list has come, or failed to. */
    listed: Promise<void> = Promise.resolve();

    private app: App | undefined;
    private readonly fromSrc = new SrcClouds();
    private readonly ending = new AbortController();
    private settle!: { resolve: () => void; reject: (reason: Error) => void };

    constructor(
        private readonly viewer: TellingElement,
        private readonly root: ShadowRoot,
        private readonly requests: Requests,
    ) {
        this.ready = new Promise((resolve, reject) => (this.settle = { resolve, reject }));
        this.ready.catch(() => {}); // also told by the event 'problem'
        void this.start();
    }

    /** An attribute has changed; before it runs all are read when it starts. */
    take(attribute: Followed): void {
        if (attribute === 'src') this.takeSrc();
        else if (attribute === 'budget') this.takeBudget();
        else if (attribute === 'lang') void this.takeLanguage();
        else this.show();
    }

    /** Gives everything back. */
    end(): void {
        const { model } = this;
        this.ending.abort();
        this.model = this.app = undefined;
        this.settle.reject(new Error('the viewer was disposed of before it was ready'));
        this.root.replaceChildren(); // elements let go of the model before it ends
        model?.dispose();
    }

    private get hasEnded(): boolean {
        return this.ending.signal.aborted;
    }

    private async start(): Promise<void> {
        let texts = new Texts();
        try {
            const server = this.viewer.getAttribute('server');
            const base = server === null ? undefined : new URL(server, document.baseURI);
            const list = base && listClouds(base, this.requests); // travels while the program loads
            list?.catch(() => {}); // told by the model
            texts = await loadTexts(this.languages());
            if (this.hasEnded) return;
            const [canvas, ...marks] = pictureParts();
            this.root.replaceChildren(canvas, ...marks);
            const model = await Model.create(canvas, texts, base, this.requests);
            if (this.hasEnded) return model.dispose();
            this.begin(model, list);
        } catch (error) {
            if (this.hasEnded) return;
            const sentence = texts.text('page.cannotStart', { reason: texts.sentenceOf(error) });
            this.root.replaceChildren(failureBox(sentence));
            this.settle.reject(new Error(sentence));
            this.viewer.tell('problem', { sentence });
        }
    }

    private begin(model: Model, list: Promise<CloudPage> | undefined): void {
        this.model = model;
        if (list) this.listed = model.listing.take(list);
        const app = (this.app = new App());
        followInput(model.canvas, model);
        followDrops(this.viewer, model, (isOver) => (app.isDropTarget = isOver), this.ending.signal);
        followGestures(this.viewer, model, this.ending.signal);
        app.model = model;
        this.root.append(app);
        this.show();
        this.takeBudget();
        this.takeSrc();
        tellWhatHappens(model, this.viewer);
        this.settle.resolve();
        this.viewer.tell('ready', undefined);
    }

    /** What attributes say of the controls, and the texts around them. */
    private show(): void {
        const { model, app, viewer } = this;
        if (!model || !app) return;
        model.shareAddress = viewer.getAttribute('share') ?? undefined;
        app.hasControls = viewer.hasAttribute('controls');
        model.canvas.setAttribute('aria-label', model.texts.text('page.canvas'));
        model.canvas.lang = app.lang = model.texts.locale;
        model.changed();
    }

    private languages(): string[] {
        const own = this.viewer.getAttribute('lang');
        return [...(own ? [own] : []), ...navigator.languages];
    }
    private async takeLanguage(): Promise<void> {
        if (!this.model) return;
        const wanted = this.languages(), texts = await loadTexts(wanted);
        if (!this.model || wanted[0] !== this.languages()[0]) return;
        this.model.texts = texts;
        this.show();
    }

    private takeBudget(): void {
        const { model } = this, text = this.viewer.getAttribute('budget');
        if (!model || text === null) return;
        const pointBudget = Number(text);
        if (pointBudget > 0) model.changeLimits({ pointBudget });
        else model.notify(model.texts.text('page.badBudget', { value: text }));
    }
    private takeSrc(): void {
        if (this.model) this.fromSrc.open(this.viewer.getAttribute('src'), this.model);
    }
}
