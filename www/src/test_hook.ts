import type { Annotation } from './annotations/annotation.ts';
import type { Measurement } from './measuring/measurement.ts';
import type { Model } from './model.ts';
import type { PrepareRequest } from './wasm/requests.ts';
import type { Bounds, CloudState, Counters, PickedPoint } from './wasm/values.ts';

/**
 * `window.stipple`: the page for programs. Tests and measurements in a browser use it; so may whoever embeds the
 * page. Everything else goes through the controls.
 */
export interface TestHook {
    /** Opens a cloud by its address, absolute or relative to the page. */
    open(address: string, name?: string, bounds?: Bounds): void;
    /** Called before each request for bytes of a cloud: headers, credentials, signed addresses. */
    prepareRequest: PrepareRequest | undefined;
    /** Resolves when everything that the picture wants has arrived and is drawn. */
    settled(): Promise<void>;
    counters(): Counters;
    /** What is open, how far it is and what is wrong with it. */
    clouds(): CloudState[];
    /** The fields of client/core/camera.hpp; absent ones stay. Throws the sentence of a bad one. */
    setCamera(camera: object): void;
    camera(): object;
    setStyle(style: object): void;
    style(): object;
    setLimits(limits: object): void;
    /** The point shown at a place of the canvas, in CSS pixels; null if there is none. */
    pick(x: number, y: number, radius?: number): Promise<PickedPoint | null>;
    annotations(): Annotation[];
    /** What was measured, oldest first. */
    measurements(): Measurement[];
    /** Draws once more and reads the canvas back: rows from the top, four bytes a pixel, as base64. */
    readPixels(): { width: number; height: number; base64: string };
}

declare global {
    interface Window {
        stipple?: TestHook;
    }
}

export function installTestHook(model: Model): void {
    window.stipple = {
        open: (address, name, bounds) => void model.opened.openAddress(address, name, bounds),
        get prepareRequest() {
            return model.requests.prepare;
        },
        set prepareRequest(prepare) {
            model.requests.prepare = prepare;
        },
        settled: () => model.frames.settled(),
        counters: () => model.readCounters(),
        clouds: () => model.clouds,
        setCamera: (camera) => model.camera.change(camera),
        camera: () => model.camera.read(),
        setStyle: (style) => model.changeStyle(style),
        style: () => model.style,
        setLimits: (limits) => model.changeLimits(limits),
        pick: (x, y, radius) => model.picking.pick(x, y, radius),
        annotations: () => model.annotations.items,
        measurements: () => model.measuring.items,
        readPixels: () => {
            const { width, height, rgba } = model.surface.readPixels();
            let binary = '';
            for (let at = 0; at < rgba.length; at += 0x8000)
                binary += String.fromCharCode(...rgba.subarray(at, at + 0x8000));
            return { width, height, base64: btoa(binary) };
        },
    };
}
