// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from 'vite';

// Plain names: the server embeds exactly these files and knows each by its path.
export default defineConfig({
  base: './',
  build: {
    target: 'es2022',
    modulePreload: false,
    assetsInlineLimit: 0,
    rollupOptions: {
      output: {
        entryFileNames: 'app.js',
        chunkFileNames: '[name].js',
        assetFileNames: 'app[extname]',
      },
    },
  },
});
