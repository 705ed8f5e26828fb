import createViewer from '@programs/stipple_viewer.mjs';
import viewerUrl from '@programs/stipple_viewer.wasm?url';

import { Said } from '../texts/said.ts';
import { compiledOnce } from './compiled.ts';
import type { Heap } from './heap.ts';
import { Host } from './host.ts';
import type { Address, ProgramOptions, ViewerProgram } from './program.ts';
import type { Requests } from './requests.ts';
import type {
    Bounds,
    Camera,
    CloudFacts,
    CloudState,
    Counters,
    Gradients,
    HistogramRequest,
    Keyframe,
    Limits,
    MeasureAnswer,
    MeasureRequest,
    NamedView,
    PickAnswer,
    Projection,
    RegionScan,
    RegionScanProgress,
    ScreenPolygon,
    Style,
    Vector,
    ViewCounts,
} from './values.ts';

const nowhere: Bounds = { min: [1, 1, 1], max: [0, 0, 0] };

type Partially<T> = { [K in keyof T]?: T[K] extends unknown[] ? T[K] : T[K] extends object ? Partial<T[K]> : T[K] };
export type StyleChange = Partially<Style>;

/** The viewer's program (client/web/viewer.hpp) in TypeScript's types. Calls that fail throw the sentence. */
export class Viewer {
    private constructor(
        private readonly program: ViewerProgram,
        private readonly heap: Heap,
        private readonly host: Host,
    ) {}

    /** `wake` is called when something arrived (load() and a frame are due); `requests` is how clouds are asked for. */
    static async create(canvas: HTMLCanvasElement, wake: () => void, requests: Requests): Promise<Viewer> {
        const host = new Host(wake, requests);
        try {
            const program = await instantiate(canvas, host);
            const viewer = new Viewer(program, host.attach(program), host);
            viewer.expect(program._stipple_create());
            return viewer;
        } catch (error) {
            host.dispose();
            throw error;
        }
    }

    dispose(): void {
        this.program._stipple_dispose();
        this.host.dispose();
    }

    /** With `bounds` it is opened when they come into view (ViewSession::addCloud). */
    addUrl(url: string, name: string, bounds?: Bounds | null): number {
        const { min, max } = bounds ?? nowhere;
        return this.heap.lendTexts([url, name], (a, b) => this.program._stipple_add_url(a!, b!, ...min, ...max));
    }
    /** One that waits. */
    openNow(id: number): void {
        this.program._stipple_open_now(id);
    }
    addFile(file: File): number {
        const kept = this.host.keepFile(file);
        return this.heap.lendTexts([file.name], (at) => this.program._stipple_add_file(kept, at!, file.size));
    }
    removeCloud(id: number): void {
        this.program._stipple_remove_cloud(id);
    }
    /** Asks again for what could not be had; of all clouds without an id. */
    retry(id = 0): void {
        this.program._stipple_retry(id);
    }
    setVisible(id: number, visible: boolean): void {
        this.program._stipple_set_visible(id, visible ? 1 : 0);
    }
    clouds(): CloudState[] {
        return this.json<CloudState[]>(this.program._stipple_clouds());
    }
    /** Null unless the cloud is ready. */
    cloudFacts(id: number): CloudFacts | null {
        return this.json<CloudFacts | null>(this.program._stipple_cloud_facts(id));
    }

    /** `inParts`: frames draw nothing, and drawPart() does. */
    resize(width: number, height: number, inParts = false): void {
        this.program._stipple_resize(width, height, inParts ? 1 : 0);
    }
    /** Pixels of the picture: four bytes each, rows from the bottom. From the first part on it stays as it is until resize(). */
    drawPart(left: number, bottom: number, width: number, height: number): Uint8Array<ArrayBuffer> {
        this.expect(this.program._stipple_draw_part(left, bottom, width, height));
        return this.heap.copy(this.program._stipple_part_pixels(), 4 * width * height);
    }
    setCamera(camera: Partial<Camera>): void {
        this.change(camera, (at) => this.program._stipple_set_camera(at));
    }
    setStyle(style: StyleChange): void {
        this.change(style, (at) => this.program._stipple_set_style(at));
    }
    setLimits(limits: Partial<Limits>): void {
        this.change(limits, (at) => this.program._stipple_set_limits(at));
    }
    camera(): Camera {
        return this.json<Camera>(this.program._stipple_camera());
    }
    style(): Style {
        return this.json<Style>(this.program._stipple_style());
    }
    limits(): Limits {
        return this.json<Limits>(this.program._stipple_limits());
    }
    /** With the ranges that the style leaves to the clouds. */
    drawnStyle(): Style {
        return this.json<Style>(this.program._stipple_drawn_style());
    }
    gradients(): Gradients {
        return this.json<Gradients>(this.program._stipple_gradients());
    }

    orbit(dx: number, dy: number): void {
        this.program._stipple_orbit(dx, dy);
    }
    pan(dx: number, dy: number): void {
        this.program._stipple_pan(dx, dy);
    }
    zoom(factor: number, x: number, y: number): void {
        this.program._stipple_zoom(factor, x, y);
    }
    /** Steps of client/core/navigation.hpp; pixels of the canvas, world units. */
    orbitAbout(pivot: Vector, dx: number, dy: number): void {
        this.program._stipple_orbit_about(...pivot, dx, dy);
    }
    dragGround(grabbed: Vector, x: number, y: number): void {
        this.program._stipple_drag_ground(...grabbed, x, y);
    }
    dragAtDepth(grabbed: Vector, x: number, y: number): void {
        this.program._stipple_drag_at_depth(...grabbed, x, y);
    }
    zoomToPoint(point: Vector, factor: number): void {
        this.program._stipple_zoom_to_point(...point, factor);
    }
    lookAround(dx: number, dy: number): void {
        this.program._stipple_look_around(dx, dy);
    }
    walk(forward: number, right: number, up: number, level: boolean): void {
        this.program._stipple_walk(forward, right, up, level ? 1 : 0);
    }
    /** Each begins a flight; its length, 0 if there is none to fly. */
    flyToCamera(camera: object): void {
        this.change(camera, (at) => this.program._stipple_fly_to_camera(at));
    }
    flyToPoint(point: Vector, part: number): number {
        return this.program._stipple_fly_to_point(...point, part);
    }
    flyToCloud(id: number): number {
        return this.program._stipple_fly_to_cloud(id);
    }
    /** Goes to t (0..1) of the flight; false if it is over. */
    fly(t: number): boolean {
        return this.program._stipple_fly(t) !== 0;
    }
    /** client/core/camera_track.hpp; followTrack() goes along it. */
    setTrack(keyframes: Keyframe[]): void {
        this.change({ keyframes }, (at) => this.program._stipple_set_track(at));
    }
    followTrack(seconds: number): void {
        this.program._stipple_follow_track(seconds);
    }
    showView(view: NamedView): void {
        this.heap.lendTexts([view], (at) => this.expect(this.program._stipple_show_view(at!)));
    }
    setProjection(projection: Projection): void {
        this.heap.lendTexts([projection], (at) => this.expect(this.program._stipple_set_projection(at!)));
    }

    /** Asks what is under the pointer, in pixels of the canvas; takePick() has the answer, frames later. */
    pick(x: number, y: number, radius: number): void {
        this.expect(this.program._stipple_pick(x, y, radius));
    }
    takePick(): PickAnswer {
        return this.json<PickAnswer>(this.program._stipple_take_pick());
    }

    /** The place alone, as soon as the picture has answered. */
    takePlace(): { pending: boolean; place?: Vector | null; error?: string } {
        return this.json(this.program._stipple_take_place());
    }

    /** Asks how often values occur in the picture (client/core/view_counter.hpp); [] ends that. */
    count(requests: HistogramRequest[]): void {
        this.change(requests, (at) => this.program._stipple_count(at));
    }
    /** Counts for a few milliseconds. */
    takeCounts(): { pending: boolean; counts?: ViewCounts } {
        return this.json(this.program._stipple_take_counts());
    }

    /** client/survey/measure_json.hpp. Throws the sentence of what can't be measured. */
    measure(request: MeasureRequest): MeasureAnswer {
        return this.heap.lendTexts([JSON.stringify(request)], (at) => {
            const { answer, error } = this.json<{ answer?: MeasureAnswer; error?: string }>(
                this.program._stipple_measure(at!),
            );
            if (!answer) throw new Said(error!);
            return answer;
        });
    }
    /** Of an open cloud, as in its file. */
    cloudMetadata(id: number): Uint8Array<ArrayBuffer> {
        const size = this.program._stipple_region_metadata(id);
        return this.heap.copy(this.program._stipple_region_message(), size);
    }
    /** Begins to read all nodes of a region (client/core/region_scan.hpp); its number. */
    scanRegion(request: RegionScan & { cloud: number }): number {
        const answer = this.heap.lendTexts([JSON.stringify(request)], (at) =>
            this.heap.text(this.program._stipple_region_scan(at!)),
        );
        if (!/^\d+$/.test(answer)) throw new Said(answer);
        return Number(answer);
    }
    /** The next node that was read. */
    takeRegionNode(scan: number): { message: Uint8Array<ArrayBuffer>; bytes: Uint8Array<ArrayBuffer> } | undefined {
        const size = this.program._stipple_region_take(scan);
        if (size === 0) return undefined;
        return {
            message: this.heap.copy(this.program._stipple_region_message(), size),
            bytes: this.heap.copy(this.program._stipple_region_bytes(), this.program._stipple_region_bytes_size()),
        };
    }
    regionProgress(scan: number): RegionScanProgress {
        return this.json(this.program._stipple_region_progress(scan));
    }
    endRegionScan(scan: number): void {
        this.program._stipple_region_end(scan);
    }
    /** Where world positions are in the present picture, in pixels of the canvas; null for what is behind the camera. */
    project(positions: Vector[]): (Vector | null)[] {
        return this.heap.lendTexts([JSON.stringify(positions)], (at) =>
            this.json<(Vector | null)[]>(this.program._stipple_project(at!)),
        );
    }

    /** What a polygon on the present picture reaches into; corners in pixels of the canvas. */
    screenPolygon(corners: [number, number][]): ScreenPolygon {
        return this.heap.lendTexts([JSON.stringify(corners)], (at) =>
            this.json<ScreenPolygon>(this.program._stipple_screen_polygon(at!)),
        );
    }

    /** Works off what arrived and asks for more, without drawing. */
    load(): void {
        this.program._stipple_load();
    }
    /** The same, and draws what is new; true if anything was. */
    frame(): boolean {
        return this.program._stipple_frame() !== 0;
    }
    /** How long a frame took until the next one could be drawn. */
    frameTook(seconds: number): void {
        this.program._stipple_frame_took(seconds);
    }
    /** What was coarser while the camera moved is drawn as fine as asked for. */
    refineAtRest(): void {
        this.program._stipple_refine_at_rest();
    }
    /** Has the next frame draw, also when nothing changed. */
    redraw(): void {
        this.program._stipple_redraw();
    }
    settled(): boolean {
        return this.program._stipple_settled() !== 0;
    }
    counters(): Counters {
        return this.json<Counters>(this.program._stipple_counters());
    }
    errors(): string[] {
        return this.json<string[]>(this.program._stipple_errors());
    }
    contextLost(): void {
        this.program._stipple_context_lost();
    }
    contextRestored(): void {
        this.expect(this.program._stipple_context_restored());
    }

    private change(value: object, call: (at: Address) => Address): void {
        this.heap.lendTexts([JSON.stringify(value)], (at) => this.expect(call(at!)));
    }
    private json<T>(at: Address): T {
        return JSON.parse(this.heap.text(at)) as T;
    }
    private expect(at: Address): void {
        const sentence = this.heap.text(at);
        if (sentence !== '') throw new Said(sentence);
    }
}

async function instantiate(canvas: HTMLCanvasElement, host: Host): Promise<ViewerProgram> {
    const compiled = await compiledOnce(viewerUrl);
    return new Promise((resolve, reject) => {
        const options: ProgramOptions = {
            canvas,
            host,
            instantiateWasm: (imports, receive) => {
                WebAssembly.instantiate(compiled, imports).then(receive, reject); // out of memory, for one
                return {};
            },
        };
        createViewer(options).then((made) => resolve(made as ViewerProgram), reject);
    });
}
