import { StippleViewer } from './component/stipple_viewer.ts';
import { fromFragment, isSceneFragment } from './scene/share_link.ts';
import { installTestHook } from './test_hook.ts';

/** The page around the viewer: what its address names is opened. */
async function start(): Promise<void> {
    const query = new URLSearchParams(location.search);
    const viewer = document.createElement('stipple-viewer');
    const attributes = { server: './', share: location.href.replace(/#.*/, ''), lang: query.get('lang'), theme: query.get('theme'), controls: '' };
    for (const [name, value] of Object.entries(attributes)) if (value !== null) viewer.setAttribute(name, value);
    viewer.storeBytes = Number(query.get('store')) * 2 ** 20; // given in MiB
    const main = document.createElement('main');
    main.append(viewer);
    document.body.append(main);
    await viewer.whenReady();
    const model = StippleViewer.modelOf(viewer);
    document.documentElement.lang = model.texts.locale;
    // While nothing on the page has the focus.
    addEventListener('keydown', (event) => void (event.target === document.body && viewer.dispatchEvent(new KeyboardEvent('keydown', event))));
    installTestHook(model);
    const tiles = query.get('tiles');
    if (tiles !== null) model.baseLayer = { template: tiles, attribution: query.get('tileAttribution') ?? '' };
    addEventListener('hashchange', () => void openLinkedScene(viewer));
    if (!(await openLinkedScene(viewer))) await openClouds(viewer);
}

/** The scene in the address's fragment, if there is one. */
async function openLinkedScene(viewer: StippleViewer): Promise<boolean> {
    if (!isSceneFragment(location.hash)) return false;
    const model = StippleViewer.modelOf(viewer);
    try {
        model.scenes.open(await fromFragment(location.hash));
        return true;
    } catch (error) {
        model.tell(error);
        return false;
    }
}

/** Those that the address names (`?cloud=URL`, several times if need be; `?cloud=*`: all of the server's), else the server's first. */
async function openClouds(viewer: StippleViewer): Promise<void> {
    const named = new URLSearchParams(location.search).getAll('cloud');
    const addresses = named.filter((address) => address && address !== '*'); // `?cloud=` names none
    addresses.forEach((address) => viewer.addCloud(address));
    const [first] = await viewer.serverClouds();
    if (named.includes('*')) await StippleViewer.modelOf(viewer).listing.openAll();
    if (named.length === 0 && first) viewer.addCloud(first.address, first.name);
}

start().catch(() => {}); // the viewer says why it can't
