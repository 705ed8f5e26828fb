import type { Annotation } from '../annotations/annotation.ts';
import type { Measurement } from '../measuring/measurement.ts';
import type { Model } from '../model.ts';
import type { ClipBox, ClipRegion, Keyframe, Vector } from '../wasm/values.ts';

/** What a person has made with the tools, at a moment: values that are never altered, but replaced. What is still being drawn is not among them. */
export interface Snapshot {
    boxes: ClipBox[];
    regions: ClipRegion[];
    measured: Measurement[];
    annotations: Annotation[];
    keyframes: Keyframe[];
    /** The profile that is open. */
    profile: { line: Vector[]; width: number } | undefined;
}

export function snapshot({ style, measuring, annotations, film, profile }: Model): Snapshot {
    const { line, width, isOpen } = profile;
    return {
        boxes: style.clipBoxes,
        regions: style.clipRegions,
        measured: measuring.kept(),
        annotations: annotations.items,
        keyframes: film.keyframes,
        profile: isOpen ? { line, width } : undefined,
    };
}
