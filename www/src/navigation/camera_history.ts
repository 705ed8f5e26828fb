import type { Camera } from '../wasm/values.ts';

/** Where the camera has rested, for going back and forth. */
export class CameraHistory {
    private places: Camera[] = [];
    private at = -1;
    private static readonly most = 100;

    get canGoBack(): boolean {
        return this.at > 0;
    }
    get canGoForward(): boolean {
        return this.at < this.places.length - 1;
    }

    /** Where it rested last, or has gone back or forth to. */
    get here(): Camera | undefined {
        return this.places[this.at];
    }

    /** The camera rests here. What was ahead is forgotten, unless it came here by going back or forth. */
    rest(camera: Camera): void {
        if (this.at >= 0 && same(this.places[this.at]!, camera)) return;
        this.places = [...this.places.slice(0, this.at + 1), camera].slice(-CameraHistory.most);
        this.at = this.places.length - 1;
    }

    back(): Camera | undefined {
        return this.canGoBack ? this.places[--this.at] : undefined;
    }
    forward(): Camera | undefined {
        return this.canGoForward ? this.places[++this.at] : undefined;
    }
}

function same(a: Camera, b: Camera): boolean {
    return JSON.stringify(a) === JSON.stringify(b);
}
