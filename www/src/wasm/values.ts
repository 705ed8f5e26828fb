// The values that cross into C++ as JSON; client/core/json.hpp is their manual, and the names are the same.

export type Vector = [number, number, number];
export type Projection = 'perspective' | 'orthographic';
export type NamedView = 'top' | 'front' | 'iso';

export interface Camera {
    projection: Projection;
    position: Vector;
    target: Vector;
    up: Vector;
    fovYDegrees: number;
    orthoHeight: number;
}

export interface Style {
    colourMode: 'rgb' | 'intensity' | 'elevation';
    gradient: 'viridis' | 'turbo' | 'inferno' | 'spectral' | 'grey' | 'terrain';
    intensityRange: [number, number] | null;
    elevationRange: [number, number] | null;
    sizeMode: 'fixed' | 'world' | 'spacing' | 'adaptive';
    sizePixels: number;
    sizeWorld: number;
    sizeSpacings: number;
    minSizePixels: number;
    maxSizePixels: number;
    shape: 'square' | 'circle' | 'paraboloid';
    delayedExpansion: 'off' | 'on' | 'auto';
    splats: { enabled: boolean; hardness: number; depthFactor: number };
    detail: {
        mode: 'discrete' | 'continuous';
        spacingPixels: number;
        growthRange: number;
        peripheralFalloff: number;
        peripheralDensity: number;
    };
    edl: { enabled: boolean; neighbours: number; radiusPixels: number; strength: number };
    background: Vector;
}

export interface Limits {
    pointBudget: number;
    minNodePixels: number;
    frameMilliseconds: number;
    leastCentreWeight: number;
    leastDepthWeight: number;
    cacheBytes: number;
    requestsInFlight: number;
    bytesInFlight: number;
    mergeGapBytes: number;
    mergedRequestBytes: number;
}

export interface CloudError {
    code: string;
    what: string;
    where: string;
    advice: string;
    sentence: string;
}

export interface CloudState {
    id: number;
    name: string;
    stage: 'opening' | 'ready' | 'failed';
    visible: boolean;
    error?: CloudError;
    pointCount?: number;
    bounds?: { min: Vector; max: Vector } | null;
    crs?: string;
    attributes?: string[];
}

/** A point of a cloud, exactly as its file has it. */
export interface PickedPoint {
    integers: Vector;
    position: Vector;
    values: Record<string, number | number[]>;
    point: { cloud: number; node: string; index: number };
    pixelsAway: number;
    distance: number;
    cloudName: string;
    crs: string;
}

export interface PickAnswer {
    pending: boolean;
    point?: PickedPoint | null;
    error?: string;
}

/** FrameCounters and SessionCounters of client/core/counters.hpp. */
export interface Counters {
    frame: Record<string, number | boolean>;
    session: Record<string, number>;
    gpuBytes: number;
    heapBytes: number;
    decodesPending: number;
    settled: boolean;
}
