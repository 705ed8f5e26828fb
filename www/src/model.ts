import { Annotations } from './annotations/annotations.ts';
import { Clipping } from './clipping/clipping.ts';
import { Measuring } from './measuring/measuring.ts';
import { messageOf } from './messages.ts';
import { type NavigationMode, Navigator } from './navigation/navigator.ts';
import { Profile } from './profile/profile.ts';
import { Questions, type Reply } from './questions.ts';
import { mostSceneBytes, readScene } from './scene/read_scene.ts';
import { differences, type Scene, type SceneCloud, sceneMeasurement, sceneVersion } from './scene/scene.ts';
import { listClouds, type CloudPage, type ListedCloud } from './server_clouds.ts';
import type {
    Camera,
    CloudState,
    Counters,
    Limits,
    MeasureAnswer,
    MeasureRequest,
    NamedView,
    PickedPoint,
    Projection,
    Style,
    Vector,
} from './wasm/values.ts';
import { type StyleChange, Viewer } from './wasm/viewer.ts';

/** What failed is tried again after a pause, and no arrival tells when that is over: so look now and then. */
const retryPauseMs = 200;
/** So long after the last frame the camera is at rest. */
const restPauseMs = 250;
/** A camera that has rested so long can be gone back to. */
const rememberPauseMs = 500;
/** How long a flight takes. */
const flightMs = 800;

/**
 * What the page shows and the elements change: the viewer's state as last read, and the frame loop. The loop
 * runs only after something was changed or arrived; a still picture costs nothing.
 */
export class Model extends EventTarget {
    listed: ListedCloud[] = [];
    /** Where the server's list goes on. */
    nextOfList: string | undefined;
    listError = '';
    clouds: CloudState[] = [];
    style!: Style;
    limits!: Limits;
    projection: Projection = 'perspective';
    counters!: Counters;
    /** The point that was asked about last. */
    picked: PickedPoint | null = null;
    /** Sentences for the person, newest last. */
    notices: string[] = [];

    /** How pointer and keys move the camera. */
    readonly navigator = new Navigator(this);
    readonly annotations = new Annotations(this);
    readonly clipping = new Clipping(this);
    readonly profile = new Profile(this);
    /** What was measured, and the tool in hand. */
    readonly measuring = new Measuring(this);

    /** As the program has them at first. */
    private defaults!: { style: Style; limits: Limits };
    private viewer!: Viewer;
    private readonly questions = new Questions();
    private frameIsDue = false;
    private reportIsDue = false;
    /** The camera has not moved for a while. */
    private atRest = true;
    private rememberTimer: ReturnType<typeof setTimeout> | undefined;
    private restTimer: ReturnType<typeof setTimeout> | undefined;
    private lookAgainTimer: ReturnType<typeof setTimeout> | undefined;
    private settledWaiters: (() => void)[] = [];
    private readonly toldErrors = new Set<string>();
    private readonly addresses = new Map<string, number>(); // address → cloud id

    private constructor(readonly canvas: HTMLCanvasElement) {
        super();
    }

    static async create(canvas: HTMLCanvasElement): Promise<Model> {
        const model = new Model(canvas);
        model.viewer = await Viewer.create(canvas, () => model.wake());
        model.read();
        model.defaults = { style: model.style, limits: model.limits };
        model.followCanvas();
        return model;
    }

    // Clouds

    /** What the server has; a plain file host has no list, which is no error. */
    async takeList(list: Promise<CloudPage>): Promise<void> {
        try {
            const { clouds, next } = await list;
            this.listed = [...this.listed, ...clouds];
            this.nextOfList = next;
        } catch (error) {
            this.listError = messageOf(error);
        }
        this.changed();
    }

    /** The next page of the server's list. */
    async listMore(): Promise<void> {
        const next = this.nextOfList;
        this.nextOfList = undefined;
        if (next !== undefined) await this.takeList(listClouds(next));
    }

    isOpen(address: string): boolean {
        return this.addresses.has(address);
    }

    openAddress(address: string, name = address): void {
        if (this.addresses.has(address)) return;
        const url = new URL(address, document.baseURI).href;
        this.addresses.set(address, this.viewer.addUrl(url, name));
        this.wake();
    }

    openFile(file: File): void {
        this.viewer.addFile(file);
        this.wake();
    }

    close(id: number): void {
        this.viewer.removeCloud(id);
        for (const [address, opened] of this.addresses) if (opened === id) this.addresses.delete(address);
        this.wake();
    }

    setVisible(id: number, visible: boolean): void {
        this.viewer.setVisible(id, visible);
        this.wake();
    }

    // Looks

    changeStyle(change: StyleChange): void {
        this.act(() => this.viewer.setStyle(change));
    }
    changeLimits(change: Partial<Limits>): void {
        this.act(() => this.viewer.setLimits(change));
    }
    changeCamera(change: object): void {
        this.atRest = false;
        this.act(() => this.viewer.setCamera(change));
        this.rememberSoon();
    }
    showView(view: NamedView): void {
        this.act(() => this.viewer.showView(view));
        this.rememberSoon();
    }
    setProjection(projection: Projection): void {
        this.act(() => this.viewer.setProjection(projection));
        this.rememberSoon();
    }

    // Steps of the camera, in CSS pixels of the canvas.

    orbit(dx: number, dy: number): void {
        this.step(() => this.viewer.orbit(dx * this.pixelRatio, dy * this.pixelRatio));
    }
    pan(dx: number, dy: number): void {
        this.step(() => this.viewer.pan(dx * this.pixelRatio, dy * this.pixelRatio));
    }
    zoom(factor: number, x: number, y: number): void {
        this.step(() => this.viewer.zoom(factor, x * this.pixelRatio, y * this.pixelRatio));
    }

    orbitAbout(pivot: Vector, dx: number, dy: number): void {
        this.step(() => this.viewer.orbitAbout(pivot, dx * this.pixelRatio, dy * this.pixelRatio));
    }
    dragGround(grabbed: Vector, x: number, y: number): void {
        this.step(() => this.viewer.dragGround(grabbed, x * this.pixelRatio, y * this.pixelRatio));
    }
    dragAtDepth(grabbed: Vector, x: number, y: number): void {
        this.step(() => this.viewer.dragAtDepth(grabbed, x * this.pixelRatio, y * this.pixelRatio));
    }
    zoomToPoint(point: Vector, factor: number): void {
        this.step(() => this.viewer.zoomToPoint(point, factor));
    }
    lookAround(dx: number, dy: number): void {
        this.step(() => this.viewer.lookAround(dx * this.pixelRatio, dy * this.pixelRatio));
    }
    /** World units; `level`: forward along the ground. */
    walk(forward: number, right: number, up: number, level: boolean): void {
        this.step(() => this.viewer.walk(forward, right, up, level));
    }

    setNavigation(mode: NavigationMode): void {
        this.navigator.mode = mode;
        this.changed();
    }

    // Flights

    isFlying = false;
    private lastFlight = 0;

    /** To where the point is in the middle, at a part of the distance. */
    flyToPoint(point: Vector, part: number): Promise<void> {
        this.rememberNow();
        return this.fly(this.viewer.flyToPoint(point, part));
    }
    /** To where all of the cloud shows; of all clouds without an id. */
    flyToCloud(id = 0): Promise<void> {
        this.rememberNow();
        return this.fly(this.viewer.flyToCloud(id));
    }
    flyToCamera(camera: object): Promise<void> {
        this.viewer.flyToCamera(camera);
        return this.fly(1);
    }

    private async fly(length: number): Promise<void> {
        if (length === 0) return;
        const start = performance.now();
        const duration = matchMedia('(prefers-reduced-motion: reduce)').matches ? 0 : flightMs;
        const flight = ++this.lastFlight; // a later one takes its place
        this.isFlying = true;
        for (let t = 0, goesOn = true; goesOn && t < 1;) {
            const now = await new Promise<number>((resolve) => requestAnimationFrame(resolve));
            if (flight !== this.lastFlight) return;
            t = duration === 0 ? 1 : Math.min(1, Math.max(0, now - start) / duration);
            this.step(() => (goesOn = this.viewer.fly(t)));
        }
        this.isFlying = false;
    }

    // Scenes

    scene(): Scene {
        const addressOf = new Map([...this.addresses].map(([address, id]) => [id, address]));
        const clouds = this.viewer.clouds();
        const indexOfCloud = (id: number): number => clouds.findIndex((cloud) => cloud.id === id);
        const items = this.measuring.items.filter((item) => item.answer ?? item.error);
        return {
            stipple: 'scene',
            version: sceneVersion,
            clouds: clouds.map(({ id, name, visible }) => {
                const address = addressOf.get(id);
                return { ...(address === undefined ? { file: name } : { address }), name, visible };
            }),
            camera: this.viewer.camera(),
            style: differences(this.viewer.style(), this.defaults.style),
            limits: differences(this.viewer.limits(), this.defaults.limits),
            navigation: this.navigator.mode,
            unit: this.measuring.unit,
            measurements: items.map((item) => sceneMeasurement(item, indexOfCloud)),
            annotations: this.annotations.items,
        };
    }

    /** Shows the scene of a text; what is wrong with it is told, and leaves everything as it was. */
    openScene(text: string): void {
        try {
            this.show(readScene(text));
        } catch (error) {
            this.notify(messageOf(error));
        }
        this.read();
        this.changed();
        this.wake();
    }
    async openSceneFile(file: File): Promise<void> {
        if (file.size > mostSceneBytes) this.notify(`${file.name} is too large to be a scene.`);
        else this.openScene(await file.text());
    }

    private show(scene: Scene): void {
        const before = { style: this.viewer.style(), limits: this.viewer.limits() };
        try {
            this.viewer.setStyle({ ...this.defaults.style, ...scene.style });
            this.viewer.setLimits({ ...this.defaults.limits, ...scene.limits });
            this.viewer.setCamera(scene.camera); // the first that may be wrong comes before anything is closed
        } catch (error) {
            this.viewer.setStyle(before.style);
            this.viewer.setLimits(before.limits);
            throw error;
        }
        const ids = this.showClouds(scene.clouds);
        this.viewer.setCamera(scene.camera); // a first cloud would be shown from its side
        this.navigator.mode = scene.navigation;
        this.measuring.unit = scene.unit;
        this.measuring.replace(
            scene.measurements.map((item) => ({
                ...item,
                points: item.points.map((point) => ({
                    ...point,
                    point: { ...point.point, cloud: ids[point.point.cloud] ?? 0 },
                })),
            })),
        );
        this.annotations.replace(scene.annotations);
        this.rememberSoon();
    }

    /** Closes what the scene does not have and opens the rest; the ids, 0 for a file that has to be opened by hand. */
    private showClouds(clouds: SceneCloud[]): number[] {
        const kept = new Map<string, number>();
        for (const { id, name } of this.viewer.clouds()) {
            const address = [...this.addresses].find(([, opened]) => opened === id)?.[0];
            const isWanted = clouds.some((cloud) => (address === undefined ? cloud.file === name : cloud.address === address));
            if (!isWanted) this.close(id);
            else if (address === undefined) kept.set(name, id);
        }
        return clouds.map(({ address, file, name, visible }) => {
            if (address !== undefined) this.openAddress(address, name);
            const id = address === undefined ? kept.get(file!) : this.addresses.get(address);
            if (id !== undefined) this.viewer.setVisible(id, visible);
            else this.notify(`The scene shows a file of this machine, ${file}: open it.`);
            return id ?? 0;
        });
    }

    /** The picture as a PNG, in the canvas's size. */
    async picture(): Promise<Blob> {
        const { width, height, rgba } = this.readPixels();
        const canvas = new OffscreenCanvas(width, height);
        canvas.getContext('2d')!.putImageData(new ImageData(new Uint8ClampedArray(rgba), width, height), 0, 0);
        return canvas.convertToBlob({ type: 'image/png' });
    }

    // What is under the pointer

    /** The place shown there, in world coordinates, without anything being read; null if there is none. */
    place(x: number, y: number, radius = 8): Promise<Vector | null> {
        return this.questions.ask(() => this.beginPick(x, y, radius), () => this.placeReply());
    }
    /** The same for what the page asks by itself; undefined if a person asked something else meanwhile. */
    placeAside(x: number, y: number, radius = 2): Promise<Vector | null | undefined> {
        return this.questions.askAside(() => this.beginPick(x, y, radius), () => this.placeReply());
    }
    /** The point shown at a place of the canvas (CSS pixels), with all its attributes; null if there is none. */
    pick(x: number, y: number, radius = 8): Promise<PickedPoint | null> {
        return this.questions.ask(
            () => this.beginPick(x, y, radius),
            () => {
                const { pending, point, error } = this.viewer.takePick();
                if (pending) this.wake(); // what has to be read is asked for between frames
                return { pending, ...(point && { value: point }), ...(error !== undefined && { error }) };
            },
        );
    }

    private beginPick(x: number, y: number, radius: number): void {
        const ratio = this.pixelRatio;
        this.viewer.pick(x * ratio, y * ratio, Math.round(radius * ratio));
    }
    private placeReply(): Reply<Vector> {
        const { pending, place, error } = this.viewer.takePlace();
        return { pending, ...(place && { value: place }), ...(error !== undefined && { error }) };
    }

    /** Shows what is known of the point there, or that there is none. */
    async showPoint(x: number, y: number): Promise<void> {
        try {
            this.picked = await this.pick(x, y);
        } catch (error) {
            this.notify(messageOf(error));
        }
        this.changed();
    }
    forgetPoint(): void {
        this.picked = null;
        this.changed();
    }

    // Measuring

    measure(request: MeasureRequest): MeasureAnswer {
        return this.viewer.measure(request);
    }
    /** Where world positions are in the picture, in CSS pixels of the canvas; null for what is behind the camera. */
    project(positions: Vector[]): ({ x: number; y: number } | null)[] {
        const ratio = this.pixelRatio;
        return this.viewer.project(positions).map((at) => at && { x: at[0] / ratio, y: at[1] / ratio });
    }

    // Frames

    /** A frame is due. */
    wake(): void {
        if (this.frameIsDue) return;
        this.frameIsDue = true;
        requestAnimationFrame(() => this.frame());
    }

    /** Resolves when everything wanted has arrived and is drawn. */
    settled(): Promise<void> {
        return new Promise((resolve) => {
            this.settledWaiters.push(resolve);
            this.wake();
        });
    }

    readCamera(): Camera {
        return this.viewer.camera();
    }
    readCounters(): Counters {
        return this.viewer.counters();
    }

    /** The picture as it is, drawn once more: rows from the top, four bytes a pixel. */
    readPixels(): { width: number; height: number; rgba: Uint8Array } {
        const { width, height } = this.canvas;
        this.viewer.redraw();
        this.viewer.frame();
        const gl = this.canvas.getContext('webgl2')!;
        const upwards = new Uint8Array(width * height * 4);
        gl.bindFramebuffer(gl.READ_FRAMEBUFFER, null);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, upwards);
        const rgba = new Uint8Array(upwards.length);
        for (let y = 0; y < height; y++)
            rgba.set(upwards.subarray((height - 1 - y) * width * 4, (height - y) * width * 4), y * width * 4);
        return { width, height, rgba };
    }

    notify(sentence: string): void {
        if (this.notices.at(-1) !== sentence) this.notices = [...this.notices.slice(-3), sentence];
        this.changed();
    }
    dismiss(sentence: string): void {
        this.notices = this.notices.filter((notice) => notice !== sentence);
        this.changed();
    }

    get pixelRatio(): number {
        return this.canvas.clientWidth > 0 ? this.canvas.width / this.canvas.clientWidth : 1;
    }

    private frame(): void {
        this.frameIsDue = false;
        const start = performance.now();
        const drew = this.viewer.frame();
        if (drew && !this.atRest && this.limits.frameMilliseconds > 0) this.timeFrame(start);
        if (drew) this.dispatchEvent(new Event('frame'));
        clearTimeout(this.lookAgainTimer);
        if (this.viewer.settled()) this.settledWaiters.splice(0).forEach((resolve) => resolve());
        else this.lookAgainTimer = setTimeout(() => this.wake(), retryPauseMs);
        this.report();
    }

    /**
     * The browser calls for the next frame when it could draw one, so that is how long this one took. Once no
     * further frame comes for a while, the camera rests.
     */
    private timeFrame(start: number): void {
        requestAnimationFrame(() => this.viewer.frameTook((performance.now() - start) / 1000));
        clearTimeout(this.restTimer);
        this.restTimer = setTimeout(() => {
            this.atRest = true; // what is drawn now may take its time
            this.viewer.refineAtRest();
            this.wake();
        }, restPauseMs);
    }

    /** Tells the elements, at most ten times a second. */
    private report(): void {
        if (this.reportIsDue) return;
        this.reportIsDue = true;
        setTimeout(() => {
            this.reportIsDue = false;
            this.read();
            this.changed();
        }, 100);
    }

    private read(): void {
        this.style = this.viewer.style();
        this.limits = this.viewer.limits();
        this.projection = this.viewer.camera().projection;
        this.counters = this.viewer.counters();
        this.clouds = this.viewer.clouds();
        this.tellErrors();
    }

    /** Each error once, also where the list of clouds is out of sight. */
    private tellErrors(): void {
        const failures = this.clouds.flatMap((cloud) => cloud.error?.sentence ?? []);
        for (const sentence of [...failures, ...this.viewer.errors()]) {
            if (this.toldErrors.has(sentence)) continue;
            this.toldErrors.add(sentence);
            this.notify(sentence);
        }
    }

    /** A step of the camera. */
    private step(change: () => void): void {
        this.atRest = false;
        change();
        this.wake();
        this.rememberSoon();
    }

    /** Where one was before a flight can be gone back to, however short one was there. */
    private rememberNow(): void {
        if (!this.isFlying) this.navigator.history.rest(this.viewer.camera());
    }

    /** Once the camera has rested for a while, it can be gone back to. */
    private rememberSoon(): void {
        clearTimeout(this.rememberTimer);
        this.rememberTimer = setTimeout(() => {
            this.navigator.history.rest(this.viewer.camera());
            this.dispatchEvent(new Event('rest'));
            this.changed();
        }, rememberPauseMs);
    }

    private act(change: () => void): void {
        try {
            change();
        } catch (error) {
            this.notify(messageOf(error));
        }
        this.read();
        this.changed();
        this.wake();
    }

    private changed(): void {
        this.dispatchEvent(new Event('change'));
    }

    private followCanvas(): void {
        new ResizeObserver(() => {
            const { clientWidth, clientHeight } = this.canvas;
            const ratio = window.devicePixelRatio || 1;
            this.canvas.width = Math.max(1, Math.round(clientWidth * ratio));
            this.canvas.height = Math.max(1, Math.round(clientHeight * ratio));
            this.viewer.resize(this.canvas.width, this.canvas.height);
            // Setting the size clears the canvas: draw before the browser shows it.
            this.viewer.redraw();
            this.frame();
        }).observe(this.canvas);
        this.canvas.addEventListener('webglcontextlost', (event) => {
            event.preventDefault();
            this.viewer.contextLost();
        });
        this.canvas.addEventListener('webglcontextrestored', () => this.act(() => this.viewer.contextRestored()));
    }
}
