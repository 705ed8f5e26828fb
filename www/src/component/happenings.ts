import type { Model } from '../model.ts';
import type { TellingElement } from './telling_element.ts';

/** Tells the page around a viewer what happens in it. */
export function tellWhatHappens(model: Model, viewer: TellingElement): void {
    let camera = '', clouds = '', notices: string[] = [];
    model.addEventListener('frame', () => {
        const now = model.camera.read(), text = JSON.stringify(now);
        if (text !== camera) viewer.tell('camera-change', { camera: now });
        camera = text;
    });
    model.addEventListener('change', () => {
        const text = JSON.stringify(model.clouds);
        if (text !== clouds) viewer.tell('cloud-change', { clouds: model.clouds });
        clouds = text;
        const told = [...model.notices, ...model.shownProblems().flatMap(({ kind, sentence }) => (kind === 'retrying' ? [] : [sentence]))];
        const fresh = told.filter((notice) => !notices.includes(notice));
        notices = told;
        for (const sentence of fresh) viewer.tell('problem', { sentence });
    });
    model.measuring.addEventListener('change', () =>
        viewer.tell('measurement-change', { measurements: model.measuring.items }),
    );
    model.picking.addEventListener('pick', () => viewer.tell('pick', { point: model.picking.point }));
    model.addEventListener('context', () =>
        viewer.tell(model.isContextLost ? 'context-lost' : 'context-restored', undefined),
    );
}
