import type { ClipRegion, CloudState, RegionOf, Vector } from '../wasm/values.ts';

/** Clip regions as a person edits them. Values, never changed: each step gives another one. World units. */

/** A server takes no longer address (docs/API.md). */
const longestAddress = 8000;

/** `end`: 0 low, 1 high; null: open. Undefined where the heights would be none. */
export function withHeight(clip: ClipRegion, end: 0 | 1, height: number | null): ClipRegion | undefined {
    const heights: [number | null, number | null] = [...(clip.region.heights ?? [null, null])];
    heights[end] = height;
    if (heights[0] !== null && heights[1] !== null && heights[0] > heights[1]) return undefined;
    const { heights: _, ...rest } = clip.region;
    const region = heights[0] === null && heights[1] === null ? rest : { ...rest, heights };
    return { ...clip, region: region as RegionOf };
}

/** What lies between: the region's own heights, and where these are open, what the clouds have. */
export function heightsShown({ heights }: RegionOf, clouds: CloudState[]): [number, number] {
    const bounds = clouds.flatMap(({ visible, bounds }) => (visible && bounds ? [bounds] : []));
    const low = Math.min(...bounds.map(({ min }) => min[2])), high = Math.max(...bounds.map(({ max }) => max[2]));
    const shown = (end: number | null | undefined, otherwise: number): number =>
        end ?? (Number.isFinite(otherwise) ? otherwise : 0);
    return [shown(heights?.[0], low), shown(heights?.[1], high)];
}

export function atHeight(corners: [number, number][], z: number): Vector[] {
    return corners.map(([x, y]) => [x, y, z]);
}

/** Where the server's points inside it are (docs/API.md); undefined where it has too many corners for an address. */
export function pointsAddress(apiOfCloud: string, region: RegionOf, format: string): string | undefined {
    const query = new URLSearchParams({ region: JSON.stringify(region), format });
    const address = `${apiOfCloud}/points?${query}`;
    return address.length <= longestAddress ? address : undefined;
}
