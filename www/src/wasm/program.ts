// The exports of the WebAssembly programs: client/web/viewer_exports.cpp and decoder_exports.cpp say what
// each call does. Numbers are 32-bit addresses, sizes or ids, unless the C++ says double.

export type Address = number;

export interface Program {
    /** All of the program's memory. Replaced when it grows: ask for it at each use, through Heap. */
    readonly HEAPU8: Uint8Array;
    _malloc(size: number): Address;
    _free(at: Address): void;
}

export interface ProgramOptions {
    canvas?: HTMLCanvasElement;
    host?: unknown;
    instantiateWasm?: (
        imports: WebAssembly.Imports,
        receive: (instance: WebAssembly.Instance) => void,
    ) => object;
}

export interface ViewerProgram extends Program {
    _stipple_create(): Address;
    _stipple_dispose(): void;
    _stipple_add_url(url: Address, name: Address, ...box: number[]): number;
    _stipple_open_now(id: number): void;
    _stipple_add_file(file: number, name: Address, sizeBytes: number): number;
    _stipple_remove_cloud(id: number): void;
    _stipple_retry(id: number): void;
    _stipple_set_visible(id: number, visible: number): void;
    _stipple_clouds(): Address;
    _stipple_cloud_facts(id: number): Address;
    _stipple_resize(width: number, height: number, inParts: number): void;
    _stipple_draw_part(left: number, bottom: number, width: number, height: number): Address;
    _stipple_part_pixels(): Address;
    _stipple_set_camera(json: Address): Address;
    _stipple_set_style(json: Address): Address;
    _stipple_set_limits(json: Address): Address;
    _stipple_camera(): Address;
    _stipple_style(): Address;
    _stipple_limits(): Address;
    _stipple_orbit(dx: number, dy: number): void;
    _stipple_pan(dx: number, dy: number): void;
    _stipple_zoom(factor: number, x: number, y: number): void;
    _stipple_orbit_about(x: number, y: number, z: number, dx: number, dy: number): void;
    _stipple_drag_ground(x: number, y: number, z: number, toX: number, toY: number): void;
    _stipple_drag_at_depth(x: number, y: number, z: number, toX: number, toY: number): void;
    _stipple_zoom_to_point(x: number, y: number, z: number, factor: number): void;
    _stipple_look_around(dx: number, dy: number): void;
    _stipple_walk(forward: number, right: number, up: number, level: number): void;
    _stipple_fly_to_camera(json: Address): Address;
    _stipple_fly_to_point(x: number, y: number, z: number, part: number): number;
    _stipple_fly_to_cloud(id: number): number;
    _stipple_fly(t: number): number;
    _stipple_set_track(json: Address): Address;
    _stipple_follow_track(seconds: number): number;
    _stipple_show_view(name: Address): Address;
    _stipple_set_projection(name: Address): Address;
    _stipple_pick(x: number, y: number, radius: number): Address;
    _stipple_take_pick(): Address;
    _stipple_take_place(): Address;
    _stipple_count(json: Address): Address;
    _stipple_take_counts(): Address;
    _stipple_drawn_style(): Address;
    _stipple_gradients(): Address;
    _stipple_measure(json: Address): Address;
    _stipple_region_metadata(cloud: number): number;
    _stipple_region_scan(json: Address): Address;
    _stipple_region_take(scan: number): number;
    _stipple_region_message(): Address;
    _stipple_region_bytes(): Address;
    _stipple_region_bytes_size(): number;
    _stipple_region_progress(scan: number): Address;
    _stipple_region_end(scan: number): void;
    _stipple_project(json: Address): Address;
    _stipple_load(): void;
    _stipple_screen_polygon(json: Address): Address;
    _stipple_frame(): number;
    _stipple_frame_took(seconds: number): void;
    _stipple_refine_at_rest(): void;
    _stipple_redraw(): void;
    _stipple_settled(): number;
    _stipple_counters(): Address;
    _stipple_errors(): Address;
    _stipple_context_lost(): void;
    _stipple_context_restored(): Address;
    _stipple_read_headers(
        request: number,
        status: number,
        contentRange: Address,
        etag: Address,
        lastModified: Address,
        contentLength: number,
        retryAfter: Address,
    ): number;
    _stipple_read_is_stored(request: number): void;
    _stipple_read_buffer(request: number, size: number): Address;
    _stipple_read_done(request: number): void;
    _stipple_read_failed(request: number, failure: number, detail: Address): void;
    _stipple_decode_answer(job: number, message: Address, size: number): number;
    _stipple_decode_array(job: number, index: number, sizeBytes: number): Address;
    _stipple_decode_done(job: number): void;
    _stipple_decode_failed(job: number, detail: Address): void;
}

/** client/web/region_exports.cpp. */
export interface RegionProgram extends Program {
    _stipple_region_open(metadata: Address, size: number, request: Address): Address;
    _stipple_region_node(message: Address, messageSize: number, bytes: Address, size: number): Address;
    _stipple_region_finish(): Address;
    _stipple_region_points(): number;
    _stipple_region_piece(): number;
    _stipple_region_patch(): number;
    _stipple_region_bytes(): Address;
    _stipple_region_bytes_size(): number;
}

export interface DecoderProgram extends Program {
    _stipple_describe_cloud(cloud: number, at: Address, size: number): void;
    _stipple_forget_cloud(cloud: number): void;
    _stipple_decode(
        message: Address,
        messageSize: number,
        picture: Address,
        pictureSize: number,
        attributes: Address,
        attributesSize: number,
    ): number;
    _stipple_answer_message(): Address;
    _stipple_answer_array(index: number): Address;
    _stipple_answer_array_size(index: number): number;
}
