import type { Model } from '../model.ts';
import type { ClipBox, ClipRegion, CloudState, Vector } from '../wasm/values.ts';
import { ComingTool } from './coming_tool.ts';
import type { PolygonKind, PolygonTool } from './polygon_tool.ts';

/** Of a region that is edited, or of a box. */
export type Selected = { box: number } | { region: number };

/** The clip boxes and regions of the style, which of them is being edited, and the tool that draws polygons. */
export class Clipping {
    /** What has handles. */
    selected: Selected | undefined;
    /** In hand. */
    tool: PolygonTool | undefined;
    /** In hand until it is loaded. */
    coming: ComingTool | undefined;

    constructor(private readonly model: Model) {}

    get boxes(): ClipBox[] {
        return this.model.style.clipBoxes;
    }
    get regions(): ClipRegion[] {
        return this.model.style.clipRegions;
    }
    /** There is something to show. */
    get isInUse(): boolean {
        return this.boxes.length + this.regions.length > 0 || this.tool !== undefined;
    }

    /** A box around the point in the middle of the picture, or what the camera turns about; a third as high as the view there. */
    async add(): Promise<void> {
        const { canvas } = this.model;
        const middle = await this.model.picking.place(canvas.clientWidth / 2, canvas.clientHeight / 2, 60);
        const { target, position, projection, orthoHeight, fovYDegrees } = this.model.camera.read();
        const centre = middle ?? target;
        const distance = Math.hypot(...centre.map((value, axis) => value - position[axis]!));
        const height =
            projection === 'orthographic' ? orthoHeight : 2 * distance * Math.tan((fovYDegrees * Math.PI) / 360);
        const half = height / 6;
        const axes: [Vector, Vector, Vector] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
        this.selected = { box: this.boxes.length };
        this.set([...this.boxes, { mode: 'hideOutside', centre, halfSize: [half, half, half], axes }]);
    }

    /** Takes the tool for a polygon in hand; a second time, keeps what is drawn. */
    async draw(kind: PolygonKind): Promise<void> {
        if (this.tool?.kind === kind) return this.tool.finishInTurn();
        this.model.putAway();
        const coming = (this.coming = new ComingTool(this.model, kind === 'screen'));
        const { PolygonTool } = await import('./polygon_tool.ts'); // loaded when it is first wanted
        if (this.coming !== coming) return; // put away meanwhile
        this.coming = undefined;
        this.tool = new PolygonTool(this.model, kind);
        coming.replay(this.tool);
        this.model.changed();
    }
    /** Throws the sentence of what is wrong with it. */
    addRegion(clip: ClipRegion): void {
        this.model.change((viewer) => viewer.setStyle({ clipRegions: [...this.regions, clip] }));
        this.selected = { region: this.regions.length - 1 };
    }
    /** The tool is put away. */
    endTool(): void {
        this.tool = this.coming = undefined;
        this.model.changed();
    }

    change(index: number, box: ClipBox): void {
        if (box.halfSize.every((half: number) => half > 0) && [...box.centre, ...box.halfSize].every(Number.isFinite))
            this.set(this.boxes.map((old, at) => (at === index ? box : old)));
    }
    changeRegion(index: number, clip: ClipRegion): void {
        this.model.changeStyle({ clipRegions: this.regions.map((old, at) => (at === index ? clip : old)) });
    }
    /** False where it would be no region, and stays: what is dragged passes such places. */
    takesRegion(index: number, clip: ClipRegion): boolean {
        try {
            this.model.change((viewer) => viewer.setStyle({ clipRegions: this.regions.map((old, at) => (at === index ? clip : old)) }));
            return true;
        } catch {
            return false;
        }
    }
    remove(index: number): void {
        this.selected = without(this.selected, 'box', index);
        this.set(this.boxes.filter((_, at) => at !== index));
    }
    removeRegion(index: number): void {
        this.selected = without(this.selected, 'region', index);
        this.model.changeStyle({ clipRegions: this.regions.filter((_, at) => at !== index) });
    }
    nameOfRegion(index: number): string {
        const isLine = 'line' in this.regions[index]!.region;
        return this.model.texts.text(isLine ? 'clip.corridor' : 'clip.polygon', { number: index + 1 });
    }
    /** Those of another moment. */
    restore(clipBoxes: ClipBox[], clipRegions: ClipRegion[]): void {
        const { selected } = this;
        const isThere = selected && ('box' in selected ? selected.box < clipBoxes.length : selected.region < clipRegions.length);
        if (!isThere) this.selected = undefined;
        this.model.changeStyle({ clipBoxes, clipRegions });
    }
    isSelected(what: Selected): boolean {
        return JSON.stringify(what) === JSON.stringify(this.selected);
    }
    select(what: Selected): void {
        this.selected = this.isSelected(what) ? undefined : what;
        this.model.changed();
    }

    /** Addresses of the server's points of each cloud, where this page's server has it. */
    apisOfClouds(): { cloud: number; name: string; api: string }[] {
        const { server } = this.model;
        if (!server) return [];
        return this.model.listing.clouds
            .filter((cloud) => this.model.opened.has(cloud.address))
            .map(({ id, name, address }) => ({
                cloud: this.model.opened.idOf(address)!,
                name,
                api: new URL(`api/v1/clouds/${encodeURIComponent(id)}`, server).href,
            }));
    }

    /** Those whose points the page has to read itself: of static hosts, and files. */
    cloudsWithoutApi(): CloudState[] {
        const served = this.model.listing.clouds.map(({ address }) => address);
        return this.model.clouds.filter(
            ({ id, stage }) => stage === 'ready' && !served.includes(this.model.opened.addressOf(id) ?? ''),
        );
    }

    private set(clipBoxes: ClipBox[]): void {
        this.model.changeStyle({ clipBoxes });
    }
}

/** What is selected once the one of that kind and index is gone. */
function without(selected: Selected | undefined, kind: 'box' | 'region', index: number): Selected | undefined {
    const at = (selected as Partial<Record<'box' | 'region', number>> | undefined)?.[kind];
    if (at === undefined || at < index) return selected;
    return at === index ? undefined : kind === 'box' ? { box: at - 1 } : { region: at - 1 };
}
