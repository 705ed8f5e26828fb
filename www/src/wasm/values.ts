// The values that cross into C++ as JSON; client/core/json.hpp is their manual, and the names are the same.

export type Vector = [number, number, number];
export type Projection = 'perspective' | 'orthographic';
export type NamedView = 'top' | 'front' | 'side' | 'iso';

export interface Camera {
    projection: Projection;
    position: Vector;
    target: Vector;
    up: Vector;
    fovYDegrees: number;
    orthoHeight: number;
}

export type ColourMode =
    | 'rgb'
    | 'intensity'
    | 'elevation'
    | 'classification'
    | 'returnNumber'
    | 'numberOfReturns'
    | 'pointSourceId'
    | 'gpsTime'
    | 'level'
    | 'attribute'
    | 'mix';

export interface MixedColour {
    colourMode: ColourMode;
    attribute?: string;
    range?: [number, number] | null;
    weight?: number;
}

export interface AttributeFilter {
    attribute: string;
    min: number | null;
    max: number | null;
}

export interface ClipBox {
    mode: 'highlight' | 'hideInside' | 'hideOutside';
    centre: Vector;
    halfSize: Vector;
    axes?: [Vector, Vector, Vector];
    rotation?: [number, number, number, number];
}

/** What lies in a region (shared/select/region_json.hpp) is hidden or highlighted. */
export interface ClipRegion {
    mode: ClipBox['mode'];
    region: RegionOf;
}

/** A polygon on the screen, as what it reaches into: shared/geometry/screen_prism.hpp. */
export interface ScreenPolygon {
    eye: Vector | null;
    forward: Vector;
    corners: Vector[];
}

export interface Style {
    colourMode: ColourMode;
    gradient: 'viridis' | 'turbo' | 'inferno' | 'spectral' | 'grey' | 'terrain';
    intensityRange: [number, number] | null;
    elevationRange: [number, number] | null;
    levelRange: [number, number] | null;
    attribute: string;
    attributeRange: [number, number] | null;
    mix: MixedColour[];
    hiddenClasses: number[];
    filters: AttributeFilter[];
    clipBoxes: ClipBox[];
    clipRegions: ClipRegion[];
    highlight: Vector;
    sizeMode: 'fixed' | 'world' | 'spacing' | 'adaptive';
    sizePixels: number;
    sizeWorld: number;
    sizeSpacings: number;
    minSizePixels: number;
    maxSizePixels: number;
    growsWhileLoading: boolean;
    shape: 'square' | 'circle' | 'paraboloid' | 'disc';
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
    compressedBytes: number;
    gpuBytes: number;
    uploadBytes: number;
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
    /** For Texts.said(). */
    said: string;
}

/** A class of points: client/core/json.hpp, names and colours of shared/points/point_classes.hpp. */
export interface CloudClass {
    class: number;
    name: string;
    colour: Vector;
    points: number;
}

/** A box in world coordinates. */
export interface Bounds {
    min: Vector;
    max: Vector;
}

export interface CloudState {
    id: number;
    name: string;
    /** waiting: nothing was asked for yet, since it is hidden or out of view. */
    stage: 'waiting' | 'opening' | 'ready' | 'failed';
    visible: boolean;
    error?: CloudError;
    /** Nothing more is asked of its server until somebody says so. */
    interrupted?: CloudError;
    /** Failed a moment ago and is tried again by itself, in so many seconds. */
    retrying?: CloudError;
    retrySeconds?: number;
    /** Nodes and pieces of the hierarchy that were given up. */
    missing?: { nodes: number; chunks: number; last: CloudError };
    /** How often its file was replaced by another, which is shown now. */
    reloads?: number;
    /** What may go wrong later. */
    caution?: string;
    pointCount?: number;
    /** Of its points; of one that is not open yet, as it was said. */
    bounds?: Bounds | null;
    crs?: string;
    attributes?: string[];
    classes?: CloudClass[];
    hasNormals?: boolean;
}

/** client/core/cloud_facts.hpp. */
export interface CloudFacts {
    crs: CrsFacts;
    attributes: AttributeFacts[];
}
export interface CrsFacts {
    name: string;
    epsg: number | null;
    wkt: string;
    proj: string;
    unit: string;
    unitMeters: number;
    vertical: string;
    geocentric: boolean;
}
export interface AttributeFacts {
    name: string;
    type: string;
    components: number;
    unit: string;
    description: string;
    isWhole: boolean;
    min: number | null;
    max: number | null;
    mean: number | null;
    deviation: number | null;
}

/** client/core/gradients.hpp: colours from low values to high. */
export type Gradients = Record<Style['gradient'], { colours: Vector[]; isColourBlindSafe: boolean }>;

/** client/core/camera_track.hpp. */
export interface Keyframe {
    camera: Camera;
    /** Since the keyframe before. */
    seconds: number;
}

/** client/core/view_counter.hpp. */
export interface HistogramRequest {
    colourMode: ColourMode;
    attribute?: string;
    bins?: number;
    range?: [number, number] | null;
}
export interface Histogram {
    range: [number, number] | null;
    bins: number[];
    below: number;
    above: number;
    points: number;
    without: number;
    coarse: number;
    min: number;
    max: number;
    mean: number;
    deviation: number;
}
export interface ViewCounts {
    points: number;
    nodes: number;
    nodesMissing: number;
    histograms: Histogram[];
}

/** A region of a cloud: shared/select/region_json.hpp. */
export type RegionOf = (
    | { box: Omit<ClipBox, 'mode'> }
    | { polygon: [number, number][]; holes?: [number, number][][] }
    | { line: [number, number][]; width: number }
    | { prism: ScreenPolygon }
) & { heights?: [low: number | null, high: number | null] };
export type RegionFormat = 'las' | 'laz' | 'csv';

/** Corners, or the place, of what is measured: client/survey/measure_json.hpp. */
export type RequestPoint = Pick<PlacedPoint, 'integers' | 'scale' | 'offset' | 'spacing'>;

/** What is made of a region's points: client/region/region_work.hpp. */
export type RegionRequest =
    | { make: 'file'; format: RegionFormat; region: RegionOf; attributes?: string[]; mostPoints?: number }
    | { make: 'profile'; region: RegionOf; mostPoints?: number }
    | { make: 'count'; region: RegionOf }
    | {
          make: 'volume';
          points: RequestPoint[];
          geocentric: boolean;
          base: 'rim' | { height: number } | { point: RequestPoint };
          cell?: number;
      };
export type RegionAnswer = Record<string, number | string | string[]>;
export interface RegionScan {
    region: object;
    attributes: number[];
}
export interface RegionScanProgress {
    nodesDone: number;
    nodesToDo: number;
    pointsDone: number;
    pointsToDo: number;
    nodesOutside: number;
    chunksToDo: number;
    bytesRead: number;
    hierarchyKnown: boolean;
    complete: boolean;
    error: string | null;
}

/** Where a point of a cloud is, exactly as its file has it, and what measuring from it needs. */
export interface PlacedPoint {
    integers: Vector;
    position: Vector;
    point: { cloud: number; node: string; index: number };
    cloudName: string;
    crs: string;
    epsg: number | null;
    /** Of the coordinates; metres in one: 0 where unknown, or an angle. */
    unit: string;
    unitMeters: number;
    geocentric: boolean;
    /** position = offset + scale × integers. */
    scale: Vector;
    offset: Vector;
    /** How far apart points of its node are. */
    spacing: number;
}

/** A point that was asked about, with all its attributes. */
export interface PickedPoint extends PlacedPoint {
    values: Record<string, number | number[]>;
    pixelsAway: number;
    distance: number;
}

export type MeasureKind = 'point' | 'distance' | 'height' | 'azimuth' | 'angle' | 'area' | 'circle' | 'volume' | 'box';

/** client/survey/measure_json.hpp. */
export interface MeasureRequest {
    kind: MeasureKind;
    closed?: boolean;
    geocentric?: boolean;
    points: { integers: Vector; scale: Vector; offset: Vector; spacing: number }[];
}

export interface MeasuredSegment {
    distance: number;
    horizontal: number;
    vertical: number;
    azimuth: number | null;
    gradient: number | null;
}

/** Values by name, each with its standard deviation as `±name` where it depends on the places picked. */
export interface MeasureAnswer {
    kind: MeasureKind;
    [value: string]: number | null | boolean | string | Vector | MeasuredSegment[];
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
