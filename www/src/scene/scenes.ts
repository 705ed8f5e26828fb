import { kindOf } from '../measuring/measurement.ts';
import type { Model } from '../model.ts';
import type { Limits, PlacedPoint, Style } from '../wasm/values.ts';
import type { Viewer } from '../wasm/viewer.ts';
import { mostSceneBytes, readScene } from './read_scene.ts';
import { differences, type Scene, type SceneCloud, sceneMeasurement, sceneVersion } from './scene.ts';

/** What the page shows as a scene, and a scene shown. */
export class Scenes {
    /** As the program has them at first: a scene says what differs. */
    private readonly defaults: { style: Style; limits: Limits };

    constructor(
        private readonly model: Model,
        private readonly viewer: Viewer,
    ) {
        this.defaults = { style: viewer.style(), limits: viewer.limits() };
    }

    scene(): Scene {
        const { model, viewer } = this;
        const clouds = viewer.clouds(), profile = model.profile.setting();
        const indexOfCloud = (id: number): number => clouds.findIndex((cloud) => cloud.id === id);
        const items = model.measuring.items.filter(({ kind, points }) => points.length >= kindOf(kind).least);
        return {
            stipple: 'scene',
            version: sceneVersion,
            clouds: clouds.map(({ id, name, visible, bounds }) => {
                const address = model.opened.addressOf(id);
                return { ...(address === undefined ? { file: name } : { address }), name, visible, ...(bounds && { bounds }) };
            }),
            camera: viewer.camera(),
            style: differences(viewer.style(), this.defaults.style),
            limits: differences(viewer.limits(), this.defaults.limits),
            navigation: model.navigator.mode,
            unit: model.measuring.unit,
            measurements: items.map((item) => sceneMeasurement(item, indexOfCloud)),
            annotations: model.annotations.items,
            cameraPath: model.film.keyframes,
            ...(profile && { profile }),
            followsView: model.looks.followsView,
            legend: model.looks.showsLegend,
            map: model.isMapOpen,
        };
    }

    /** Shows the scene of a text; what is wrong with it is thrown, and leaves everything as it was. */
    set(text: string): void {
        this.model.change(() => this.show(readScene(text)));
    }
    /** The same; what is wrong is told. */
    open(text: string): void {
        this.model.act(() => this.show(readScene(text)));
    }
    async openFile(file: File): Promise<void> {
        if (file.size > mostSceneBytes) this.model.notify(this.model.texts.text('scene.fileTooLarge', { name: file.name }));
        else this.open(await file.text());
    }

    private show(scene: Scene): void {
        const { model, viewer } = this, { texts } = model;
        this.setUp(scene);
        const ids = this.showClouds(scene.clouds);
        viewer.setCamera(scene.camera); // a first cloud would be shown from its side
        model.navigator.mode = scene.navigation;
        model.measuring.unit = scene.unit;
        model.measuring.replace(
            scene.measurements.map((item) => ({
                ...item,
                name: item.name || texts.text(`measure.${item.kind}`),
                points: item.points.map((point) => placed(point, ids)),
                ...(item.base?.from === 'point' && { base: { ...item.base, point: placed(item.base.point, ids) } }),
            })),
        );
        model.annotations.replace(
            scene.annotations.map((item) => ({ ...item, title: item.title || texts.text('annotations.one') })),
        );
        model.film.replace(scene.cameraPath);
        model.looks.followsView = scene.followsView;
        model.looks.showsLegend = scene.legend;
        model.isMapOpen = scene.map;
        if (scene.profile) model.profile.show(scene.profile);
        else model.profile.close();
        model.camera.rememberSoon();
        model.history?.restart();
    }

    /** What may be wrong comes before anything is closed, and leaves all as it was. */
    private setUp(scene: Scene): void {
        const { viewer } = this;
        const before = { style: viewer.style(), limits: viewer.limits(), camera: viewer.camera() };
        try {
            viewer.setStyle({ ...this.defaults.style, ...scene.style });
            viewer.setLimits({ ...this.defaults.limits, ...scene.limits });
            viewer.setCamera(scene.camera);
            if (scene.cameraPath.length > 0) viewer.setTrack(scene.cameraPath);
        } catch (error) {
            viewer.setStyle(before.style);
            viewer.setLimits(before.limits);
            viewer.setCamera(before.camera);
            throw error;
        }
    }

    /** Closes what the scene does not have and opens the rest; the ids, 0 for a file that has to be opened by hand. */
    private showClouds(clouds: SceneCloud[]): number[] {
        const { model } = this;
        const kept = new Map<string, number>();
        for (const { id, name } of this.viewer.clouds()) {
            const address = model.opened.addressOf(id);
            const isWanted = clouds.some((cloud) => (address === undefined ? cloud.file === name : cloud.address === address));
            if (!isWanted) model.opened.close(id);
            else if (address === undefined) kept.set(name, id);
        }
        return clouds.map(({ address, file, name, visible, bounds }) => {
            const id = address === undefined ? kept.get(file!) : model.opened.openAddress(address, name, bounds);
            if (id !== undefined) this.viewer.setVisible(id, visible);
            else model.notify(model.texts.text('scene.openByHand', { name: file! }));
            return id ?? 0;
        });
    }
}

/** In the cloud that has the index's place in the scene now. */
function placed(point: PlacedPoint, ids: number[]): PlacedPoint {
    return { ...point, point: { ...point.point, cloud: ids[point.point.cloud] ?? 0 } };
}
