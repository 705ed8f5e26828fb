import type { Measurement } from '../measuring/measurement.ts';
import type { Camera, CloudState, PickedPoint } from '../wasm/values.ts';

/** What a viewer tells, each as a CustomEvent that does not bubble, with this detail. */
export interface StippleViewerEvents {
    /** The program runs; methods may be called. */
    'ready': void;
    /** A frame with another camera was drawn. */
    'camera-change': { camera: Camera };
    /** Clouds were added, removed, opened, shown, hidden, or failed. */
    'cloud-change': { clouds: CloudState[] };
    /** Something was measured, changed, renamed, hidden, deleted. */
    'measurement-change': { measurements: Measurement[] };
    /** A person asked what is at a place; null where no point is. */
    'pick': { point: PickedPoint | null };
    /** Something went wrong, as the person is told. */
    'problem': { sentence: string };
    /** The browser took the graphics context away; `context-restored` follows when it gives it back. */
    'context-lost': void;
    'context-restored': void;
}
export type StippleViewerEventName = keyof StippleViewerEvents;
