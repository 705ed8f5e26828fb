import { defineConfig, type Plugin } from 'vite';

// The WebAssembly programs as the CMake preset `wasm` leaves them.
const programs = decodeURI(new URL('../build/wasm/client/web', import.meta.url).pathname);

/** Elements and styles are templates, whose indentation minifiers leave: 1 % of what is loaded first. */
const withoutIndentation: Plugin = {
    name: 'without-indentation',
    enforce: 'pre',
    transform: (code, id) => (/\/src\/.*\.ts$/.test(id) ? { code: code.replace(/\n[ \t]+/g, '\n'), map: null } : undefined),
};

export default defineConfig({
    plugins: [withoutIndentation],
    base: './', // the page works under any path
    resolve: { alias: { '@programs': programs } },
    worker: { format: 'es' },
    build: {
        target: 'es2022',
        assetsInlineLimit: 0, // a content security policy may forbid data: addresses
        modulePreload: { polyfill: false },
    },
    server: { fs: { allow: ['.', programs] } },
});
