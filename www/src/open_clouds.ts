import type { Frames } from './drawing/frames.ts';
import type { Bounds } from './wasm/values.ts';
import type { Viewer } from './wasm/viewer.ts';

/** The clouds that were opened, by their addresses and as files; how they are is `Model.clouds`. */
export class OpenClouds {
    private readonly ids = new Map<string, number>(); // address → cloud

    constructor(
        private readonly viewer: Viewer,
        private readonly frames: Frames,
    ) {}

    has(address: string): boolean {
        return this.ids.has(address);
    }
    idOf(address: string): number | undefined {
        return this.ids.get(address);
    }
    /** Of a cloud that was opened by one. */
    addressOf(id: number): string | undefined {
        return [...this.ids].find(([, opened]) => opened === id)?.[0];
    }

    /** The cloud's id; that of the open one if it is. With `bounds` nothing is asked for before they are in view. */
    openAddress(address: string, name = address, bounds?: Bounds | null): number {
        const opened = this.ids.get(address);
        if (opened !== undefined) return opened;
        const id = this.viewer.addUrl(new URL(address, document.baseURI).href, name, bounds);
        this.ids.set(address, id);
        this.frames.loadSoon();
        return id;
    }

    /** A cloud that waits until it is in view. */
    openNow(id: number): void {
        this.viewer.openNow(id);
        this.frames.loadSoon();
    }

    openFile(file: File): number {
        const id = this.viewer.addFile(file);
        this.frames.loadSoon();
        return id;
    }

    close(id: number): void {
        this.viewer.removeCloud(id);
        const address = this.addressOf(id);
        if (address !== undefined) this.ids.delete(address);
        this.frames.wake();
    }

    setVisible(id: number, visible: boolean): void {
        this.viewer.setVisible(id, visible);
        this.frames.wake();
    }
}
