import { defineConfig, mergeConfig } from 'vite';

import page from './vite.config.ts';

// The npm package: the element without the page around it. What it loads lies beside it, found from its own address.
export default mergeConfig(
    page,
    defineConfig({
        publicDir: false,
        build: {
            outDir: 'package/dist',
            license: { fileName: 'THIRD_PARTY.md' },
            copyPublicDir: false,
            rollupOptions: {
                input: { 'stipple-viewer': 'src/package.ts' },
                preserveEntrySignatures: 'strict',
                output: { entryFileNames: '[name].js' },
            },
        },
    }),
);
