import type { Model } from '../model.ts';
import { Problem } from '../texts/message.ts';
import type { Keyframe } from '../wasm/values.ts';

const defaultSeconds = 2;
export const mostKeyframes = 1000;
/** More pictures are a matter for `stipple render`. */
const mostFrames = 20_000;

export interface FrameExport {
    width: number;
    height: number;
    framesPerSecond: number;
}

/** A camera path through keyframes: set up, played, and written as pictures. 'change' says that something of it is another. */
export class Film extends EventTarget {
    keyframes: Keyframe[] = [];
    isPlaying = false;
    /** Where one is, in seconds. */
    time = 0;
    /** Pictures that are written, and of how many; while they are. */
    progress: { done: number; of: number } | undefined;
    private run = 0;
    private abort: AbortController | undefined;

    constructor(private readonly model: Model) {
        super();
    }

    get duration(): number {
        return this.keyframes.slice(1).reduce((sum, { seconds }) => sum + seconds, 0);
    }

    /** The present camera is the last keyframe. */
    add(): void {
        this.set([...this.keyframes, { camera: this.model.camera.read(), seconds: defaultSeconds }]);
    }
    /** The present camera in place of a keyframe's. */
    retake(index: number): void {
        this.change(index, { camera: this.model.camera.read() });
    }
    setSeconds(index: number, seconds: number): void {
        if (seconds > 0) this.change(index, { seconds });
    }
    remove(index: number): void {
        this.set(this.keyframes.filter((_, at) => at !== index));
    }
    moveUp(index: number): void {
        const moved = [...this.keyframes];
        moved.splice(index - 1, 0, ...moved.splice(index, 1));
        this.set(moved);
    }
    show(index: number): void {
        void this.model.camera.flyToCamera(this.keyframes[index]!.camera);
    }
    /** Of a scene, which was looked at already. */
    replace(keyframes: Keyframe[]): void {
        this.stop();
        this.time = 0;
        this.set(keyframes);
    }

    play(): void {
        if (this.keyframes.length < 2) return;
        const run = ++this.run;
        this.isPlaying = true;
        if (this.time >= this.duration) this.time = 0;
        let last = performance.now();
        const go = (now: number): void => {
            if (run !== this.run) return;
            this.time = Math.min(this.duration, this.time + Math.max(0, now - last) / 1000);
            last = now;
            this.model.camera.followTrack(this.time);
            if (this.time >= this.duration) this.stop();
            else requestAnimationFrame(go);
            this.changed();
        };
        requestAnimationFrame(go);
        this.changed();
    }
    stop(): void {
        this.run++;
        this.abort?.abort();
        this.isPlaying = false;
        this.changed();
    }
    seek(seconds: number): void {
        this.stop();
        this.time = Math.min(this.duration, Math.max(0, seconds));
        if (this.keyframes.length > 0) this.model.camera.followTrack(this.time);
        this.changed();
    }

    /** All pictures of the path as PNG files in a ZIP file, each drawn with all that it shows, unless it is given up. */
    async write(options: FrameExport): Promise<void> {
        const of = Math.floor(this.duration * options.framesPerSecond + 1e-9) + 1;
        if (!(options.framesPerSecond > 0) || of > mostFrames) throw new Problem('film.tooMany', { most: mostFrames });
        this.stop();
        const abort = (this.abort = new AbortController());
        const show = (progress: Film['progress']): void => {
            this.progress = progress;
            this.changed();
        };
        show({ done: 0, of });
        try {
            const { writeFrames } = await import('../pictures/film_writer.ts');
            await writeFrames(this.model, { ...options, of }, { signal: abort.signal, done: (done) => show({ done, of }) });
        } finally {
            show(undefined);
        }
    }

    private change(index: number, change: Partial<Keyframe>): void {
        this.set(this.keyframes.map((keyframe, at) => (at === index ? { ...keyframe, ...change } : keyframe)));
    }
    /** What the program refuses is told, and changes nothing. */
    private set(keyframes: Keyframe[]): void {
        try {
            if (keyframes.length > 0) this.model.camera.setTrack(keyframes);
            this.keyframes = keyframes;
            this.time = Math.min(this.time, this.duration);
        } catch (error) {
            this.model.tell(error);
        }
        this.changed();
    }
    private changed(): void {
        this.dispatchEvent(new Event('change'));
    }
}
