import { Access } from './access.ts';
import { Annotations } from './annotations/annotations.ts';
import { CloudListing } from './cloud_listing.ts';
import { CloudProblems } from './cloud_problems.ts';
import { Clipping } from './clipping/clipping.ts';
import { Frames } from './drawing/frames.ts';
import { Picking } from './drawing/picking.ts';
import { Surface } from './drawing/surface.ts';
import { Looks } from './looks/looks.ts';
import { ViewCounting } from './looks/view_counting.ts';
import type { History } from './history/history.ts';
import { Geography } from './map/geography.ts';
import type { BaseLayer } from './map/shapes.ts';
import { Measuring } from './measuring/measuring.ts';
import { CameraMoves } from './navigation/camera_moves.ts';
import { Film } from './navigation/film.ts';
import { type NavigationMode, Navigator } from './navigation/navigator.ts';
import { OpenClouds } from './open_clouds.ts';
import { Profile } from './profile/profile.ts';
import { RegionFiles } from './regions/region_files.ts';
import { Scenes } from './scene/scenes.ts';
import type { ShownProblem } from './shown_problem.ts';
import { Problem } from './texts/message.ts';
import { Texts } from './texts/texts.ts';
import type { Tool } from './tool.ts';
import type { CloudState, Counters, Limits, MeasureAnswer, MeasureRequest, Projection, Style } from './wasm/values.ts';
import { Requests } from './wasm/requests.ts';
import { type StyleChange, Viewer } from './wasm/viewer.ts';

/**
 * What the page shows and the elements change: the viewer's state as last read, and the parts that do things with it, each
 * of one idea. Events: `change` (something that elements show), `frame` (a new picture), `settled` (it has all that it wants), `rest` (the camera stands still),
 * `context` (the graphics context was lost, or is there again).
 */
export class Model extends EventTarget {
    clouds: CloudState[] = [];
    style!: Style;
    limits!: Limits;
    projection: Projection = 'perspective';
    counters!: Counters;
    /** Sentences for the person, newest last. */
    notices: string[] = [];
    /** What is said, in the person's language. */
    texts: Texts;

    /** Opens clouds and closes them. */
    readonly opened: OpenClouds;
    readonly frames: Frames;
    readonly surface: Surface;
    readonly picking: Picking;
    /** What is wrong with clouds. */
    readonly problems: CloudProblems;
    /** What servers refused else, and the tokens for them. */
    readonly access = new Access(this);
    /** What the server offers. */
    readonly listing = new CloudListing(this);
    readonly camera: CameraMoves;
    /** How pointer and keys move the camera. */
    readonly navigator = new Navigator(this);
    readonly scenes: Scenes;
    /** How often values occur in the picture. */
    readonly counting: ViewCounting;
    readonly looks: Looks;
    readonly geography = new Geography(this);
    isMapOpen = false;
    /** Of the map, where the page names one. */
    baseLayer: BaseLayer | undefined;
    /** A camera path. */
    readonly film = new Film(this);
    /** Of pictures that are written, as far as a person said. */
    /** A picture that is being written: how much of it is (0..1). */
    making: { share: number; cancel(): void } | undefined;
    wantedSize: { width?: number | undefined; height?: number | undefined } = {};
    readonly annotations = new Annotations(this);
    readonly clipping = new Clipping(this);
    readonly profile: Profile;
    /** What was measured, and the tool in hand. */
    readonly measuring: Measuring;
    /** What was done with the tools, to be taken back; here once something may have been. */
    history: History | undefined;
    /** Files of regions that the page makes itself. */
    readonly regionFiles: RegionFiles;

    /** The browser has taken the graphics context away. */
    isContextLost = false;
    /** Of a page that opens scenes of its fragment; none: links are not offered. */
    shareAddress: string | undefined;
    isDisposed = false;

    private reportIsDue = false;
    /** Something was drawn since the picture was whole. */
    private isUnsettled = false;
    private readonly toldErrors = new Set<string>();

    private constructor(
        readonly canvas: HTMLCanvasElement,
        private readonly viewer: Viewer,
        texts: Texts,
        /** Whose clouds are listed, and who cuts profiles. */
        readonly server: URL | undefined,
        /** How all is asked for; whoever embeds the page sets its `prepare`. */
        readonly requests: Requests,
    ) {
        super();
        this.texts = texts;
        this.frames = new Frames(viewer, (drew) => this.drawn(drew));
        this.opened = new OpenClouds(viewer, this.frames);
        this.surface = new Surface(canvas, viewer);
        this.picking = new Picking(this, viewer);
        this.camera = new CameraMoves(this, viewer);
        this.scenes = new Scenes(this, viewer);
        this.counting = new ViewCounting(this, viewer);
        this.looks = new Looks(this, viewer, this.counting);
        this.problems = new CloudProblems(this, viewer, requests);
        this.measuring = new Measuring(this, viewer);
        this.profile = new Profile(this, viewer);
        this.regionFiles = new RegionFiles(this, viewer);
        this.read();
        this.surface.follow(this.frames, {
            lost: () => this.setContextLost(true),
            restored: () => {
                this.act(() => viewer.contextRestored());
                this.setContextLost(false);
            },
        });
    }

    static async create(
        canvas: HTMLCanvasElement,
        texts: Texts,
        server?: URL,
        requests = new Requests(),
    ): Promise<Model> {
        let model: Model | undefined;
        const viewer = await Viewer.create(canvas, () => model?.frames.loadSoon(), requests).catch((error: unknown) => {
            throw canvas.getContext('webgl2') ? error : new Problem('page.noWebgl');
        });
        return (model = new Model(canvas, viewer, texts, server, requests));
    }

    // Looks

    changeStyle(change: StyleChange): void {
        this.act(() => this.viewer.setStyle(change));
    }
    changeLimits(change: Partial<Limits>): void {
        this.act(() => this.viewer.setLimits(change));
    }
    wantPicture(size: { width?: number | undefined; height?: number | undefined }): void {
        this.wantedSize = size;
        this.changed();
    }
    /** With one side given the other goes with it, as on the page. */
    pictureSize(): { width: number; height: number } {
        const { canvas, wantedSize } = this, aspect = canvas.width / canvas.height;
        const width = wantedSize.width ?? (wantedSize.height ? Math.round(wantedSize.height * aspect) : canvas.width);
        return { width, height: wantedSize.height ?? Math.round(width / aspect) };
    }
    showMap(isOpen: boolean): void {
        this.isMapOpen = isOpen;
        this.changed();
    }
    setNavigation(mode: NavigationMode): void {
        this.navigator.mode = mode;
        this.changed();
    }

    /** That clicks are for. */
    get tool(): Tool | undefined {
        return this.measuring.isDrawing ? this.measuring : this.clipping.tool ?? this.clipping.coming;
    }
    /** Another is taken in hand. */
    putAway(): void {
        this.measuring.finish();
        this.clipping.endTool();
        if (this.annotations.isPlacing) this.annotations.place();
    }
    /** Of the tool in hand, or of the point that is told about. */
    letGo(): void {
        if (this.tool) this.tool.stop();
        else if (this.annotations.isPlacing) this.annotations.place();
        else this.picking.forget();
    }

    measure(request: MeasureRequest): MeasureAnswer {
        return this.viewer.measure(request);
    }

    readClouds(): CloudState[] {
        return this.viewer.clouds();
    }
    readCounters(): Counters {
        return this.viewer.counters();
    }

    // What elements and the other parts are told

    /** A frame is due. */
    wake(): void {
        this.frames.wake();
    }

    /** Something that elements show has changed. */
    changed(): void {
        this.dispatchEvent(new Event('change'));
    }

    /** Changes the viewer; what is wrong with that is thrown. */
    change(change: (viewer: Viewer) => void): void {
        try {
            change(this.viewer);
        } finally {
            this.read();
            this.changed();
            this.wake();
        }
    }
    /** The same; what is wrong is told. */
    act(change: () => void): void {
        try {
            this.change(change);
        } catch (error) {
            this.tell(error);
        }
    }

    /** All that is wrong now. */
    shownProblems(): ShownProblem[] {
        return [...this.problems.list(), ...this.access.problems()];
    }
    notify(sentence: string): void {
        if (this.notices.at(-1) !== sentence) this.notices = [...this.notices.slice(-3), sentence];
        this.changed();
    }
    /** What went wrong. */
    tell(error: unknown): void {
        this.notify(this.texts.sentenceOf(error));
    }
    dismiss(sentence: string): void {
        this.notices = this.notices.filter((notice) => notice !== sentence);
        this.changed();
    }

    /** Gives everything back that the browser lent. Nothing may be asked of it afterwards. */
    dispose(): void {
        this.isDisposed = true;
        this.frames.stop();
        this.camera.stop();
        this.picking.stop();
        this.profile.close();
        this.counting.stop();
        this.film.stop();
        this.annotations.endTour();
        this.problems.stop();
        this.viewer.dispose();
        this.surface.release();
    }

    private setContextLost(isLost: boolean): void {
        this.isContextLost = isLost;
        this.dispatchEvent(new Event('context'));
        this.changed();
    }

    /** Tells the elements, at most ten times a second. */
    private drawn(drew: boolean): void {
        if (drew) this.dispatchEvent(new Event('frame'));
        this.isUnsettled ||= drew;
        if (this.isUnsettled && this.viewer.settled()) {
            this.isUnsettled = false;
            this.dispatchEvent(new Event('settled'));
        }
        if (this.reportIsDue) return;
        this.reportIsDue = true;
        setTimeout(() => {
            this.reportIsDue = false;
            if (this.isDisposed) return;
            this.read();
            this.changed();
        }, 100);
    }

    private read(): void {
        this.style = this.viewer.style();
        this.limits = this.viewer.limits();
        this.frames.isTimed = this.limits.frameMilliseconds > 0;
        this.projection = this.viewer.camera().projection;
        this.counters = this.viewer.counters();
        this.clouds = this.viewer.clouds();
        this.problems.tellReloads();
        this.tellErrors();
    }

    /** What can't be drawn as asked for; each once. */
    private tellErrors(): void {
        for (const said of this.viewer.errors()) {
            if (this.toldErrors.has(said)) continue;
            this.toldErrors.add(said);
            this.notify(this.texts.said(said));
        }
    }
}
