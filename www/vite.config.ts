import { defineConfig } from 'vite';

// The WebAssembly programs as the CMake preset `wasm` leaves them.
const programs = decodeURI(new URL('../build/wasm/client/web', import.meta.url).pathname);

export default defineConfig({
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
