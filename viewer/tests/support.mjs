// SPDX-License-Identifier: Apache-2.0
// A browser on `versine view`. VERSINE is the program, VERSINE_PAGE the folder whose node_modules the page was built with.
import { spawn, execFileSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';

export const versine = process.env.VERSINE;
export const source = process.env.VERSINE_SOURCE_DIR;
export const requirePage = createRequire(path.join(process.env.VERSINE_PAGE, 'package.json'));
export const chromium = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(existsSync);

export function run(...parameters) {
  return execFileSync(versine, parameters, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });
}

/** Starts `versine view` and answers with its address and token when it serves. */
export function serve(...parameters) {
  const child = spawn(versine, ['view', '--no-browser', ...parameters], { stdio: ['ignore', 'pipe', 'pipe'] });
  return new Promise((resolve, reject) => {
    let out = '';
    let errors = '';
    child.stderr.on('data', (text) => (errors += text));
    child.on('exit', (code) => reject(new Error(`versine view ended with ${code}: ${errors}`)));
    child.stdout.on('data', (text) => {
      out += text;
      const match = /(http:\/\/127\.0\.0\.1:(\d+)\/)#token=([0-9a-f]{64})/.exec(out);
      if (match) resolve({ url: match[0], base: match[1], port: Number(match[2]), token: match[3], child, stop: () => child.kill('SIGTERM') });
    });
  });
}

export async function browse() {
  const { chromium: engine } = requirePage('playwright-core');
  return engine.launch({ executablePath: chromium, args: ['--no-sandbox', '--disable-gpu', '--font-render-hinting=none'] });
}

/** A page of a served result, as soon as it can be used. */
export async function open(browser, server, { width = 1366, height = 768, theme = 'dark', hash = '' } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, acceptDownloads: true });
  await context.addInitScript((name) => localStorage.getItem('versine-theme') ?? localStorage.setItem('versine-theme', name), theme);
  const page = await context.newPage();
  page.faults = [];
  // A page that is being worked on (npx vite build), instead of the one in the program.
  if (process.env.VERSINE_DIST) {
    await page.route(/\/(app\.\w+)?(#.*)?$/, (route) => route.fulfill({ path: path.join(process.env.VERSINE_DIST, new URL(route.request().url()).pathname.slice(1) || 'index.html') }));
  }
  page.on('pageerror', (error) => page.faults.push(String(error)));
  page.on('console', (message) => message.type() === 'error' && page.faults.push(message.text()));
  await page.goto(server.url + (hash ? `&${hash}` : ''));
  await page.waitForSelector('html[data-ready]', { timeout: 30000 });
  return page;
}

/** Waits until the samples of the open tab are all in the page. */
export const loaded = (page, tab = 'strips') => page.waitForSelector(`html[data-loaded="${tab}"]`, { timeout: 60000 });

/** The page's own clock: a timer that a key has started, the address's above all, has run when a later one has. */
export const settle = (page, ms = 160) => page.evaluate((wait) => new Promise((done) => setTimeout(() => requestAnimationFrame(() => done()), wait)), ms);

export async function press(page, ...keys) {
  for (const key of keys) await page.keyboard.press(key);
  await settle(page);
}
