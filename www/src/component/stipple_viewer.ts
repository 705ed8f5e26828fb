import type { Measurement } from '../measuring/measurement.ts';
import type { Model } from '../model.ts';
import type { PictureOptions } from '../pictures/pictures.ts';
import type { Scene } from '../scene/scene.ts';
import type { ListedCloud } from '../server_clouds.ts';
import { Problem } from '../texts/message.ts';
import type { Bounds, Camera, CloudState, Limits, PickedPoint, Style, Vector } from '../wasm/values.ts';
import { type PrepareRequest, Requests } from '../wasm/requests.ts';
import type { StyleChange } from '../wasm/viewer.ts';
import { type Followed, followed, Life } from './life.ts';
import { TellingElement } from './telling_element.ts';
import { viewerStyles } from './viewer_styles.ts';

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
export class StippleViewer extends TellingElement {
    static readonly observedAttributes: readonly string[] = followed;

    private readonly requests = new Requests();
    private readonly root: ShadowRoot;
    /** The present one; another once it is disposed of. */
    private life: Life | undefined;

    constructor() {
        super();
        this.root = this.attachShadow({ mode: 'open' });
        this.root.adoptedStyleSheets = [viewerStyles.styleSheet!];
    }

    connectedCallback(): void {
        this.life ??= new Life(this, this.root, this.requests);
    }
    /** What is only moved on the page goes on. */
    disconnectedCallback(): void {
        queueMicrotask(() => {
            if (!this.isConnected) this.dispose();
        });
    }
    attributeChangedCallback(name: Followed): void {
        this.life?.take(name);
    }

    // Clouds

    /** Resolves when methods may be called; rejects if the viewer can't start, or is disposed of first. */
    whenReady(): Promise<void> {
        return this.life?.ready ?? Promise.reject(new Error('the viewer is not in a document'));
    }

    /**
     * Called before each request, for a cloud's bytes, a list, a profile or a file; may be set before there is a document. Requests carry
     * what it makes of them: another address, for example a signed one, headers, credentials.
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

    /**
     * Opens a cloud by its address or as a file; its id. Whether that works is told by `cloud-change` and `problem`. Of a
     * cloud whose `bounds` (world coordinates) are given nothing is asked for before they come into view.
     */
    addCloud(source: string | File, name?: string, bounds?: Bounds): number {
        const { model } = this.get();
        return typeof source === 'string' ? model.opened.openAddress(source, name, bounds) : model.opened.openFile(source);
    }
    removeCloud(id: number): void {
        this.get().model.opened.close(id);
    }
    getClouds(): CloudState[] {
        return this.get().model.readClouds();
    }
    /** The clouds that the server of the attribute `server` offers (the first of them, if there are many). */
    async serverClouds(): Promise<ListedCloud[]> {
        await this.whenReady();
        const { model, life } = this.get();
        await life.listed;
        return model.listing.clouds;
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
    /**
     * The picture as a PNG, without panels: as it is, or in another size (up to 65,000 pixels a side; points grow with the height),
     * once all that it shows is here. Rejects with the sentence of what is wrong with the size, or the signal's reason.
     */
    async screenshot(options: PictureOptions = {}): Promise<Blob> {
        const { model } = this.get();
        return this.orSentence(async () => (await import('../pictures/pictures.ts')).pictureBlob(model, options));
    }
    /** The same into a stream, as it is drawn: of no size is more in memory than some rows. The stream is not closed. */
    async writeScreenshot(into: WritableStream<Uint8Array<ArrayBuffer>>, options: PictureOptions = {}): Promise<void> {
        const { model } = this.get(), writer = into.getWriter();
        try {
            await this.orSentence(async () => (await import('../pictures/pictures.ts')).pictureInto(model, (bytes) => writer.write(bytes), options));
        } finally {
            writer.releaseLock();
        }
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
        const { life } = this;
        this.life = undefined;
        life?.end();
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

    private async orSentence<T>(act: () => Promise<T>): Promise<T> {
        const { texts } = this.get().model;
        try {
            return await act();
        } catch (error) {
            throw error instanceof Problem ? new Error(texts.sentenceOf(error), { cause: error }) : error;
        }
    }

    private get(): { model: Model; life: Life } {
        const { life } = this, model = life?.model;
        if (!model) throw new Error('the viewer is not ready: await whenReady()');
        return { model, life: life! };
    }
}

declare global {
    interface HTMLElementTagNameMap {
        'stipple-viewer': StippleViewer;
    }
}

if (!customElements.get('stipple-viewer')) customElements.define('stipple-viewer', StippleViewer);
