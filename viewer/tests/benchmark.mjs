// SPDX-License-Identifier: Apache-2.0
// How fast the viewer is on 400,001 points, and with VERSINE_DATA on the Dutch network: node benchmark.mjs [POINTS], with
// the environment of support.mjs.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, statSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { columns, writeResult } from './fixture.mjs';
import { writeGeorefResult } from './georef_fixture.mjs';
import { browse, loaded, open, serve } from './support.mjs';

const count = Number(process.argv[2] ?? 400001);
const folder = mkdtempSync(path.join(os.tmpdir(), 'versine-bench-'));
// Twelve strips on the first tab: with two more bases of twist.
const only = [...columns.filter((c) => !['cross_level_mm', 'gradient_permille', 'height_axis_m'].includes(c)), 'twist_6m_mm_per_m', 'twist_9m_mm_per_m'];
writeResult(path.join(folder, 'result'), { count, only });
const size = statSync(path.join(folder, 'result', 'geometry.csv')).size;
const browser = await browse();
const median = (a) => [...a].sort((x, y) => x - y)[a.length >> 1];

/** CPU seconds so far of a process and all below it: what a loaded machine cannot stretch. */
function cpu(root) {
  const all = readdirSync('/proc').filter((n) => /^\d+$/.test(n)).flatMap((n) => {
    try {
      const text = readFileSync(`/proc/${n}/stat`, 'utf8');
      const rest = text.slice(text.lastIndexOf(')') + 2).split(' ');
      return [{ id: Number(n), parent: Number(rest[1]), ticks: Number(rest[11]) + Number(rest[12]) }];
    } catch {
      return [];
    }
  });
  const below = new Set([root]);
  for (let size = 0; size !== below.size; ) {
    size = below.size;
    for (const p of all) if (below.has(p.parent)) below.add(p.id);
  }
  return all.filter((p) => below.has(p.id)).reduce((sum, p) => sum + p.ticks, 0) / 100;
}

const rounds = { serving: [], 'serving, CPU': [], 'empty page, CPU': [], interactive: [], 'interactive, CPU': [], loaded: [] };
let page;
let server;
for (let round = 0; round < 5; ++round) {
  server?.stop();
  await page?.context().close();
  const start = performance.now();
  server = await serve(path.join(folder, 'result'));
  rounds.serving.push(performance.now() - start);
  rounds['serving, CPU'].push(1000 * cpu(server.child.pid));
  const start0 = cpu(process.pid);
  const empty = await browser.newPage();
  await empty.goto('about:blank');
  rounds['empty page, CPU'].push(1000 * (cpu(process.pid) - start0));
  await empty.close();
  const before = cpu(process.pid);
  page = await open(browser, server);
  rounds['interactive, CPU'].push(1000 * (cpu(process.pid) - before));
  rounds.interactive.push(await page.evaluate(() => performance.getEntriesByName('versine-ready')[0].startTime));
  await loaded(page);
  rounds.loaded.push(await page.evaluate(() => performance.now()));
}
const strips = await page.$$eval('.strip', (all) => all.length);

/** Wheel events, one a frame; frame times in ms. */
async function frames(name, event) {
  await page.evaluate(() => (location.hash = 'from=20000&to=60000&at=40000'));
  await page.waitForTimeout(500);
  const before = cpu(process.pid);
  const times = await page.evaluate(
    (init) =>
      new Promise((resolve) => {
        const target = document.querySelector('.strip-box');
        const box = target.getBoundingClientRect();
        const times = [];
        let last = 0;
        let n = 0;
        const frame = (now) => {
          if (last > 0) times.push(now - last);
          last = now;
          if (++n > 120) return resolve(times);
          const sign = n <= 60 ? 1 : -1;
          target.dispatchEvent(new WheelEvent('wheel', { bubbles: true, cancelable: true, clientX: box.left + box.width / 2, clientY: box.top + 5, ...init, deltaY: sign * init.deltaY }));
          requestAnimationFrame(frame);
        };
        requestAnimationFrame(frame);
      }),
    event,
  );
  const spent = (1000 * (cpu(process.pid) - before)) / times.length;
  const sorted = times.sort((a, b) => a - b);
  console.log(`${name}: median ${median(sorted).toFixed(1)} ms a frame, 95 % below ${sorted[Math.floor(0.95 * sorted.length)].toFixed(1)} ms; CPU of all processes ${spent.toFixed(1)} ms a frame`);
}

console.log(`${count} points, ${strips} strips seen, geometry.csv ${(size / 1e6).toFixed(0)} MB; load ${os.loadavg()[0].toFixed(1)} on ${os.cpus().length} cores`);
for (const [name, times] of Object.entries(rounds)) console.log(`${name}: median ${median(times).toFixed(0)} ms of ${times.map((t) => t.toFixed(0)).join(', ')}`);
await frames('pan', { deltaY: 40, shiftKey: true });
await frames('zoom', { deltaY: -12 });
if (page.faults.length > 0) console.error(page.faults);
server.stop();

/** The network of a country, opened at a journey, then seen as a whole. Kilometres are kept, the datum is not. */
async function network(file) {
  const { features } = JSON.parse(execFileSync('zstd', ['-dc', file], { maxBuffer: 1 << 28 }));
  const lines = features.filter((f) => f.geometry?.type === 'LineString').map((f) => f.geometry.coordinates);
  const more = lines.map((line) => line.map(([e, n]) => [5.387 + (e - 155000) / 68400, 52.155 + (n - 463000) / 111200]));
  writeGeorefResult(path.join(folder, 'network'), { more });
  const times = { serving: [], painted: [] };
  for (let round = 0; round < 5; ++round) {
    const start = performance.now();
    const server = await serve(path.join(folder, 'network'));
    times.serving.push(performance.now() - start);
    const page = await open(browser, server);
    times.painted.push(await page.evaluate(() => performance.getEntriesByName('versine-ready')[0].startTime));
    await page.context().close();
    server.stop();
  }
  console.log(`network of ${lines.length} lines, ${lines.reduce((n, l) => n + l.length, 0)} vertices`);
  for (const name of ['serving', 'painted']) console.log(`${name}: median ${median(times[name]).toFixed(0)} ms of ${times[name].map((t) => t.toFixed(0)).join(', ')}`);
  const server = await serve(path.join(folder, 'network'));
  page = await open(browser, server);
  await page.waitForTimeout(1500);
  const frames = await page.evaluate(
    () =>
      new Promise((resolve) => {
        const target = document.querySelector('.georef-map canvas');
        const box = target.getBoundingClientRect();
        const times = [];
        let last = 0;
        const frame = (now) => {
          if (last > 0) times.push(now - last);
          last = now;
          if (times.length > 150) return resolve(times);
          // Out to the whole country and in again.
          target.dispatchEvent(new WheelEvent('wheel', { bubbles: true, cancelable: true, clientX: box.left + box.width / 2, clientY: box.top + box.height / 2, deltaY: times.length < 75 ? 60 : -60 }));
          requestAnimationFrame(frame);
        };
        requestAnimationFrame(frame);
      }),
  );
  const sorted = frames.sort((x, y) => x - y);
  console.log(`map zoomed out to the country and in again: median ${median(sorted).toFixed(1)} ms a frame, 95 % below ${sorted[Math.floor(0.95 * sorted.length)].toFixed(1)} ms`);
  server.stop();
}
const data = path.join(process.env.VERSINE_DATA ?? '', 'dutch-network', 'netherlands.geojson.zst');
if (process.env.VERSINE_DATA && existsSync(data)) await network(data);
await browser.close();
rmSync(folder, { recursive: true });
