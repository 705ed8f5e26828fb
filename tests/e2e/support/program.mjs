// Runs the program `stipple`: once, or as a server that a test ends.
import { execFile, spawn } from 'node:child_process';
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';

export const root = fileURLToPath(new URL('../../..', import.meta.url));
const program = process.env.STIPPLE_PROGRAM ?? join(root, 'build/release/client/headless/stipple');

/** Standard output of one run; an exit code other than 0 throws with what it said. */
export async function stipple(...args) {
    const { stdout } = await promisify(execFile)(program, args, { maxBuffer: 1 << 26, timeout: 120_000 });
    return stdout;
}

/** A folder of its own for each test file, removed by `cleanUp`. */
export async function scratchFolder() {
    const path = await mkdtemp(join(tmpdir(), 'stipple-e2e-'));
    return { path, cleanUp: () => rm(path, { recursive: true, force: true }) };
}

/** A small town: enough points for several nodes, few enough for a GL in software. */
export async function makeTown(folder, { points = 150_000, seed = 1, name = 'town', normals = false } = {}) {
    const scan = join(folder, `${name}.las`);
    const cloud = join(folder, `${name}.stipple`);
    const further = normals ? ['--normals'] : [];
    await stipple('synth', scan, '--points', String(points), '--scene', 'town', '--seed', String(seed), ...further);
    await stipple('convert', scan, '-o', cloud);
    return cloud;
}

/** `stipple serve` on a free port; resolves when it has printed its address. */
export async function serve(...paths) {
    const server = spawn(program, ['serve', ...paths, '--port', '0'], {
        cwd: root,
        stdio: ['ignore', 'pipe', 'pipe'],
    });
    let said = '';
    const address = await new Promise((resolve, reject) => {
        const listen = (chunk) => {
            said += chunk;
            const found = said.match(/http:\/\/[\w.:[\]]+:\d+\//);
            if (found) resolve(found[0]);
        };
        server.stdout.on('data', listen);
        server.stderr.on('data', listen);
        server.once('exit', (code) => reject(new Error(`stipple serve ended with ${code}: ${said}`)));
        setTimeout(() => reject(new Error(`stipple serve gave no address: ${said}`)), 10_000).unref();
    });
    const stop = () =>
        new Promise((resolve) => {
            server.removeAllListeners('exit');
            server.once('exit', resolve);
            server.kill('SIGTERM');
            setTimeout(() => server.kill('SIGKILL'), 5_000).unref();
        });
    return { address, stop };
}
