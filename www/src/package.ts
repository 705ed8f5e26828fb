// What the npm package gives: importing it defines the element <stipple-viewer>.
export { StippleViewer } from './component/stipple_viewer.ts';
export type { StippleViewerEventName, StippleViewerEvents } from './component/events.ts';
export type { Measurement } from './measuring/measurement.ts';
export type { Scene } from './scene/scene.ts';
export type { PreparedRequest, PrepareRequest } from './wasm/requests.ts';
export type { Camera, CloudState, Limits, PickedPoint, Style, Vector } from './wasm/values.ts';
