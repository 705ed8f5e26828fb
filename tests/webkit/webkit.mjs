// WebKitGTK's MiniBrowser, driven over WebDriver. It draws on the display that DISPLAY names.
import { spawn } from 'node:child_process';
import { existsSync } from 'node:fs';
import { createServer } from 'node:net';
import { Builder, Capabilities, Key, Origin } from 'selenium-webdriver';

const driver = process.env.STIPPLE_WEBKIT_DRIVER ?? 'WebKitWebDriver';
const miniBrowser = ['4.1', '4.0'].map((abi) => `/usr/lib/${process.arch === 'arm64' ? 'aarch64' : 'x86_64'}-linux-gnu/webkit2gtk-${abi}/MiniBrowser`).find(existsSync);

/** A browser with one window; `close()` ends it and its driver. */
export async function launch() {
    if (!miniBrowser) throw new Error('MiniBrowser of WebKitGTK is missing: scripts/install_dependencies.sh --with-webkit');
    const port = await freePort();
    // Its sandbox needs a namespace of users, which containers do not allow.
    const process_ = spawn(driver, [`--port=${port}`], { stdio: ['ignore', 'ignore', 'inherit'], env: { ...process.env, WEBKIT_DISABLE_SANDBOX_THIS_IS_DANGEROUS: '1' } });
    const capabilities = new Capabilities({ browserName: 'MiniBrowser', 'webkitgtk:browserOptions': { binary: miniBrowser, args: ['--automation'] } });
    const session = await retried(() => new Builder().usingServer(`http://127.0.0.1:${port}`).withCapabilities(capabilities).build());
    await session.manage().setTimeouts({ script: 60_000 });
    const close = async () => {
        await session.quit();
        process_.kill();
    };
    return { page: new Page(session), close };
}

/** The driver listens a moment after it has started. */
async function retried(connect) {
    for (let tries = 0; ; tries++)
        try {
            return await connect();
        } catch (error) {
            if (tries === 50 || !/ECONNREFUSED/.test(String(error))) throw error;
            await new Promise((resolve) => setTimeout(resolve, 100));
        }
}

function freePort() {
    return new Promise((resolve, reject) => {
        const server = createServer().once('error', reject);
        server.listen(0, '127.0.0.1', () => {
            const { port } = server.address();
            server.close(() => resolve(port));
        });
    });
}

class Page {
    constructor(session) {
        this.session = session;
    }

    goto(address) {
        return this.session.get(address);
    }

    /** What an (async) function answers in the page. */
    async evaluate(call, ...values) {
        const answer = await this.session.executeAsyncScript(
            `const done = arguments[arguments.length - 1];
             Promise.resolve((${call})(...[].slice.call(arguments, 0, -1))).then((value) => done({ value }), (error) => done({ error: String(error) }));`,
            ...values,
        );
        if (answer.error) throw new Error(answer.error);
        return answer.value ?? null;
    }

    async waitFor(call, ...values) {
        for (const end = Date.now() + 60_000; ; ) {
            const answer = await this.evaluate(call, ...values);
            if (answer) return answer;
            if (Date.now() > end) throw new Error(`it did not happen: ${call}`);
            await new Promise((resolve) => setTimeout(resolve, 50));
        }
    }

    /** The middle of a button of that name, in its shadow roots; it has to be what a click there meets. */
    async press(name) {
        const [x, y] = await this.evaluate((text) => {
            const all = (root) => [...root.querySelectorAll('*')].flatMap((element) => [element, ...(element.shadowRoot ? all(element.shadowRoot) : [])]);
            const button = all(document).find((element) => element.tagName === 'BUTTON' && (element.getAttribute('aria-label') ?? element.textContent.trim()) === text);
            button.scrollIntoView({ block: 'center' });
            const box = button.getBoundingClientRect();
            return [Math.round(box.x + box.width / 2), Math.round(box.y + box.height / 2)];
        }, name);
        await this.click(x, y);
    }

    click(x, y) {
        return this.session.actions().move({ x, y, origin: Origin.VIEWPORT }).click().perform();
    }
    doubleClick(x, y) {
        return this.session.actions().move({ x, y, origin: Origin.VIEWPORT }).press().release().press().release().perform();
    }
    drag([x, y], [toX, toY]) {
        const actions = this.session.actions().move({ x, y, origin: Origin.VIEWPORT }).press();
        for (let i = 1; i <= 5; i++) actions.move({ x: Math.round(x + ((toX - x) * i) / 5), y: Math.round(y + ((toY - y) * i) / 5), origin: Origin.VIEWPORT, duration: 30 });
        return actions.release().perform();
    }
    key(name) {
        return this.session.actions().sendKeys(Key[name] ?? name).perform();
    }
    async focusPicture() {
        await this.evaluate(() => document.querySelector('stipple-viewer').shadowRoot.querySelector('canvas').focus());
    }

    async resize(width, height) {
        await this.session.manage().window().setRect({ width, height });
    }
    async screenshot() {
        return Buffer.from(await this.session.takeScreenshot(), 'base64');
    }
}
