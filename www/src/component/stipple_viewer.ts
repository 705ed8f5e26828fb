import { followDrops, followInput } from '../input.ts';
import type { Measurement } from '../measuring/measurement.ts';
import { Model } from '../model.ts';
import type { Scene } from '../scene/scene.ts';
import { type CloudPage, listClouds, type ListedCloud } from '../server_clouds.ts';
import { loadTexts, Texts } from '../texts/texts.ts';
import { App } from '../ui/app.ts';
import type { Camera, CloudState, Limits, PickedPoint, Style, Vector } from '../wasm/values.ts';
import { type PrepareRequest, Requests } from '../wasm/requests.ts';
import type { StyleChange } from '../wasm/viewer.ts';
import type { StippleViewerEventName, StippleViewerEvents } from './events.ts';
import { Run } from './run.ts';
import { viewerStyles } from './viewer_styles.ts';

const observed = ['src', 'budget', 'controls', 'lang', 'share'] as const;

/**
 * `<stipple-viewer>`: point clouds, and the tools for them, in a box of a page. Any number on one page; each has a program, a
 * graphics context and workers of its own, which it gives back when it is removed or disposed of. Keys go to the one
 * that has the focus. It asks no host but those of its clouds and of the package itself.
 *
 * Attributes:
 *   src       addresses of .stipple files, separated by spaces (spaces within one are written %20)
 *   budget    how many points are drawn at most
 *   controls  present: panels and tools are shown; absent: the picture alone
 *   lang      the language it speaks (en, de, fr, ja); absent: the browser's
 *   theme     dark or light; absent: as the browser prefers
 *   server    address of a Stipple server, whose clouds are offered and who cuts profiles; read when it starts
 *   share     address of a page that opens scenes of its fragment (#scene=…): links to it are offered
 */
export class StippleViewer extends HTMLElement {
    static readonly observedAttributes: readonly string[] = observed;

    private readonly requests = new Requests();
    private readonly root: ShadowRoot;
    private model: Model | undefined;
    private app: App | undefined;
    /** Of the present start; another once it is disposed of. */
    private run: Run | undefined;
    /** Address → id, of what `src` names. */
    private readonly fromSrc = new Map<string, number>();

    constructor() {
        super();
        this.root = this.attachShadow({ mode: 'open' });
        this.root.adoptedStyleSheets = [viewerStyles.styleSheet!];
    }

    connectedCallback(): void {
        if (!this.run) void this.start();
    }
    /** What is only moved on the page goes on. */
    disconnectedCallback(): void {
        queueMicrotask(() => {
            if (!this.isConnected) this.dispose();
        });
    }
    attributeChangedCallback(name: (typeof observed)[number]): void {
        const { model } = this;
        if (!model) return; // read when it starts
        if (name === 'src') this.openSrc(model);
        else if (name === 'budget') this.takeBudget(model);
        else if (name === 'lang') void this.takeLanguage(model);
        else this.show(model);
    }

    // Clouds

    /** Resolves when methods may be called; rejects if the viewer can't start, or is disposed of first. */
    whenReady(): Promise<void> {
        if (!this.run) return Promise.reject(new Error('the viewer is not in a document'));
        return this.run.ready;
    }

    /**
     * Called before each request for bytes of a cloud; may be set before there is a document. Requests carry what it
     * makes of them: another address, for example a signed one, headers, credentials.
     */
    get prepareRequest(): PrepareRequest | undefined {
        return this.requests.prepare;
    }
    set prepareRequest(prepare: PrepareRequest | undefined) {
        this.requests.prepare = prepare;
    }

    /** What came of clouds may stay in the browser for the next visit, up to so many bytes; 0: nothing. */
    get storeBytes(): number {
        return this.requests.storeBytes;
    }
    set storeBytes(bytes: number) {
        this.requests.storeBytes = Number.isFinite(bytes) ? bytes : 0;
    }

    /** Asks again for what a cloud could not have, or all of them. What is here stays, and the camera. */
    retry(id = 0): void {
        this.get().model.problems.retry(id);
    }

    /** Opens a cloud by its address or as a file; its id. Whether that works is told by `cloud-change` and `problem`. */
    addCloud(source: string | File, name?: string): number {
        const { model } = this.get();
        return typeof source === 'string' ? model.openAddress(source, name) : model.openFile(source);
    }
    removeCloud(id: number): void {
        this.get().model.close(id);
    }
    getClouds(): CloudState[] {
        return this.get().model.readClouds();
    }
    /** The clouds that the server of the attribute `server` offers (the first of them, if there are many). */
    async serverClouds(): Promise<ListedCloud[]> {
        await this.whenReady();
        const { model, run } = this.get();
        await run.listed;
        return model.listed;
    }

    // Camera and looks

    getCamera(): Camera {
        return this.get().model.camera.read();
    }
    /** Fields that are absent stay. Throws the sentence of what is wrong with it. */
    setCamera(camera: Partial<Camera>): void {
        this.expect((model) => model.camera.set(camera));
    }
    /** Resolves when it is there, or something else has moved the camera. */
    flyTo(target: Partial<Camera> | { cloud: number } | { point: Vector }): Promise<void> {
        const { camera } = this.get().model;
        if ('cloud' in target) return camera.flyToCloud(target.cloud);
        if ('point' in target) return camera.flyToPoint(target.point, 0.35);
        return camera.flyToCamera(target);
    }
    /** docs/STYLE.md. Throws the sentence of what is wrong with it. */
    setStyle(style: StyleChange): void {
        this.expect((model) => model.change((viewer) => viewer.setStyle(style)));
    }
    getStyle(): Style {
        return this.get().model.style;
    }
    setLimits(limits: Partial<Limits>): void {
        this.expect((model) => model.change((viewer) => viewer.setLimits(limits)));
    }
    getLimits(): Limits {
        return this.get().model.limits;
    }

    // What is set up, measured, seen

    getScene(): Scene {
        return this.get().model.scenes.scene();
    }
    /** A scene, or its text. Throws the sentence of what is wrong with it, and then changes nothing. */
    setScene(scene: Scene | string): void {
        this.expect((model) => model.scenes.set(typeof scene === 'string' ? scene : JSON.stringify(scene)));
    }
    getMeasurements(): Measurement[] {
        return this.get().model.measuring.items;
    }
    /** The point shown at a place of the viewer (CSS pixels from its upper left corner), with all its attributes; null: none. */
    pick(x: number, y: number, radius = 8): Promise<PickedPoint | null> {
        return this.get().model.picking.pick(x, y, radius);
    }
    /** The picture as a PNG, without panels. */
    screenshot(): Promise<Blob> {
        return this.get().model.surface.picture();
    }
    /** Resolves when everything that the picture wants has arrived and is drawn. */
    settled(): Promise<void> {
        return this.get().model.frames.settled();
    }

    /**
     * Gives back the program's memory, the graphics context, workers and requests. Put into a document again, it starts
     * anew. Removing it from the document does the same.
     */
    dispose(): void {
        const { run, model } = this;
        this.run = this.model = this.app = undefined;
        this.fromSrc.clear();
        run?.stop();
        this.root.replaceChildren(); // elements let go of the model before it ends
        model?.dispose();
    }

    /** @internal For the full page and its tests. */
    static modelOf(viewer: StippleViewer): Model {
        return viewer.get().model;
    }

    /** What goes wrong is thrown as the sentence that the person would read. */
    private expect(change: (model: Model) => void): void {
        const { model } = this.get();
        try {
            change(model);
        } catch (error) {
            throw new Error(model.texts.sentenceOf(error), { cause: error });
        }
    }

    private get(): { model: Model; run: Run } {
        const { model, run } = this;
        if (!model || !run) throw new Error('the viewer is not ready: await whenReady()');
        return { model, run };
    }

    private async start(): Promise<void> {
        const run = (this.run = new Run());
        let texts = new Texts();
        try {
            const server = this.getAttribute('server');
            const base = server === null ? undefined : new URL(server, document.baseURI);
            const list = base && listClouds(base); // travels while the program loads
            list?.catch(() => {}); // told by the model
            texts = await loadTexts(this.languages());
            const canvas = this.addCanvas();
            const model = await Model.create(canvas, texts, base, this.requests);
            if (run.isStopped) return model.dispose();
            this.begin(model, run, list);
        } catch (error) {
            if (run.isStopped) return;
            const sentence = texts.text('page.cannotStart', { reason: texts.sentenceOf(error) });
            this.showFailure(sentence);
            run.fail(new Error(sentence));
            this.tell('problem', { sentence });
        }
    }

    private addCanvas(): HTMLCanvasElement {
        const canvas = document.createElement('canvas');
        const [ring, cross] = ['ring', 'cross'].map((name) => Object.assign(document.createElement('div'), { className: name }));
        canvas.tabIndex = 0;
        canvas.setAttribute('role', 'application');
        this.root.replaceChildren(canvas, ring!, cross!);
        return canvas;
    }

    private begin(model: Model, run: Run, list: Promise<CloudPage> | undefined): void {
        this.model = model;
        run.listed = list ? model.takeList(list) : Promise.resolve();
        followInput(model.canvas, model);
        followDrops(this, model, (isOver) => this.app && (this.app.isDropTarget = isOver), run.signal);
        this.app = new App();
        this.app.model = model;
        this.root.append(this.app);
        this.show(model);
        this.takeBudget(model);
        this.openSrc(model);
        this.follow(model);
        run.begin();
        this.tell('ready', undefined);
    }

    /** Tells the page what happens. */
    private follow(model: Model): void {
        let camera = '', clouds = '', notices: string[] = [];
        model.addEventListener('frame', () => {
            const now = model.camera.read(), text = JSON.stringify(now);
            if (text !== camera) this.tell('camera-change', { camera: now });
            camera = text;
        });
        model.addEventListener('change', () => {
            const text = JSON.stringify(model.clouds);
            if (text !== clouds) this.tell('cloud-change', { clouds: model.clouds });
            clouds = text;
            const told = [...model.notices, ...model.problems.sentences()];
            const fresh = told.filter((notice) => !notices.includes(notice));
            notices = told;
            for (const sentence of fresh) this.tell('problem', { sentence });
        });
        model.measuring.addEventListener('change', () =>
            this.tell('measurement-change', { measurements: model.measuring.items }),
        );
        model.picking.addEventListener('pick', () => this.tell('pick', { point: model.picking.point }));
        model.addEventListener('context', () => this.tell(model.isContextLost ? 'context-lost' : 'context-restored', undefined));
    }

    private tell<K extends StippleViewerEventName>(name: K, detail: StippleViewerEvents[K]): void {
        this.dispatchEvent(new CustomEvent(name, { detail }));
    }

    /** What attributes say of the controls, and the texts around them. */
    private show(model: Model): void {
        model.shareAddress = this.getAttribute('share') ?? undefined;
        this.app!.hasControls = this.hasAttribute('controls');
        model.canvas.setAttribute('aria-label', model.texts.text('page.canvas'));
        model.canvas.lang = model.texts.locale;
        this.app!.lang = model.texts.locale;
        model.changed();
    }

    private languages(): string[] {
        const own = this.getAttribute('lang');
        return [...(own ? [own] : []), ...navigator.languages];
    }
    private async takeLanguage(model: Model): Promise<void> {
        const wanted = this.languages(), texts = await loadTexts(wanted);
        if (this.model !== model || wanted[0] !== this.languages()[0]) return;
        model.texts = texts;
        this.show(model);
    }

    private takeBudget(model: Model): void {
        const text = this.getAttribute('budget');
        if (text === null) return;
        const pointBudget = Number(text);
        if (pointBudget > 0) model.changeLimits({ pointBudget });
        else model.notify(model.texts.text('page.badBudget', { value: text }));
    }

    private openSrc(model: Model): void {
        const wanted = new Set((this.getAttribute('src') ?? '').split(/\s+/).filter(Boolean));
        for (const [address, id] of this.fromSrc) {
            if (wanted.has(address)) continue;
            this.fromSrc.delete(address);
            model.close(id);
        }
        for (const address of wanted)
            if (!this.fromSrc.has(address)) this.fromSrc.set(address, model.openAddress(address));
    }

    private showFailure(sentence: string): void {
        const box = document.createElement('p');
        box.className = 'failure';
        box.setAttribute('role', 'alert');
        box.textContent = sentence;
        this.root.replaceChildren(box);
    }
}

type Listener<K extends StippleViewerEventName> = (this: StippleViewer, event: CustomEvent<StippleViewerEvents[K]>) => unknown;

export interface StippleViewer {
    addEventListener<K extends StippleViewerEventName>(name: K, listener: Listener<K>, options?: boolean | AddEventListenerOptions): void;
    addEventListener<K extends keyof HTMLElementEventMap>(
        name: K,
        listener: (this: StippleViewer, event: HTMLElementEventMap[K]) => unknown,
        options?: boolean | AddEventListenerOptions,
    ): void;
    removeEventListener<K extends StippleViewerEventName>(name: K, listener: Listener<K>, options?: boolean | EventListenerOptions): void;
    removeEventListener<K extends keyof HTMLElementEventMap>(
        name: K,
        listener: (this: StippleViewer, event: HTMLElementEventMap[K]) => unknown,
        options?: boolean | EventListenerOptions,
    ): void;
}

declare global {
    interface HTMLElementTagNameMap {
        'stipple-viewer': StippleViewer;
    }
}

if (!customElements.get('stipple-viewer')) customElements.define('stipple-viewer', StippleViewer);
