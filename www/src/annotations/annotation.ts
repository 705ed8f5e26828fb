import type { Camera, Vector } from '../wasm/values.ts';

/** A remark at a place: a title, a text in Markdown, perhaps a view to fly to; remarks can belong to others. */
export interface Annotation {
    id: number;
    /** Of the annotation that it belongs to; 0: none. */
    parent: number;
    title: string;
    text: string;
    position: Vector;
    camera?: Camera;
    hidden: boolean;
    /** Shown up to so far from the camera, in world units; 0: from everywhere. */
    maxDistance: number;
}
