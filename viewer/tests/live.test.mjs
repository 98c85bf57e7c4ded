// SPDX-License-Identifier: Apache-2.0
// A survey that is still running, in a real browser: what it has so far, its verdict for who wants to pack up, its result.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { browse, open, run, serve, source, versine } from './support.mjs';

const folder = mkdtempSync(path.join(os.tmpdir(), 'versine-live-'));
const place = (...names) => path.join(folder, ...names);
let browser;
const ends = [];
before(async () => {
  browser = await browse();
  run('simulate', path.join(source, 'examples/scenarios/slab-1km.toml'), '-o', place('recording'), '--quiet');
});
after(async () => {
  for (const end of ends) end();
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** Starts a survey; `at(stage)` halts it as soon as it has published that stage, and answers with the folder of it. */
function survey(result) {
  const job = spawn(versine, ['survey', place('recording', 'survey.toml'), '-o', place(result), '--quiet'], { stdio: 'ignore' });
  const done = new Promise((resolve) => job.on('exit', resolve));
  ends.push(() => job.kill('SIGKILL'));
  const published = () => {
    const sibling = readdirSync(folder).find((name) => name.startsWith(`.${result}.new-`));
    const parts = sibling ? place(sibling, 'partial') : '';
    if (!existsSync(parts)) return [];
    return readdirSync(parts).map((n) => path.join(parts, n)).filter((f) => existsSync(path.join(f, 'run.json')));
  };
  const at = async (stage) => {
    for (let i = 0; i < 6000; ++i) {
      for (const part of published()) {
        try {
          if (JSON.parse(readFileSync(path.join(part, 'run.json'), 'utf8')).results.partial !== stage) continue;
        } catch {
          continue; // it has been replaced just now
        }
        job.kill('SIGSTOP');
        return published().at(-1);
      }
      await new Promise((resolve) => setTimeout(resolve, 5));
    }
    throw new Error(`${stage} has not come`);
  };
  return { job, done, at, go: () => job.kill('SIGCONT') };
}

async function look(result) {
  const server = await serve(place(result));
  ends.push(server.stop);
  return open(browser, server, { hash: '' });
}
const text = (page, selector) => page.textContent(selector);
const seconds = async (page) => Number(/^(\d+):(\d+):(\d+)/.exec(await text(page, '.km')).slice(1).reduce((s, n) => 60 * s + Number(n), 0));

test('trajectory, landmarks and verdict of a survey that runs, then its result', async () => {
  const { done, at, go } = survey('soon');
  const part = await at('forward pass');
  const page = await look('soon');
  assert.match(await text(page, '.verdict'), /^SO FAR · forward pass/);
  // The last point is that of the file.
  const rows = readFileSync(path.join(part, 'trajectory.csv'), 'utf8').trim().split('\n').filter((l) => !l.startsWith('#')).map((l) => l.split(','));
  const [head, first, last] = [rows[0], rows[1], rows.at(-1)];
  await page.keyboard.press('End');
  for (let i = 0; i < 3; ++i) await page.keyboard.press('Shift+ArrowRight');
  await page.waitForFunction((t) => document.querySelector('[data-strip="height_m"] output').title.startsWith(t), String(Number(Number(last[head.indexOf('height_m')]).toFixed(3))).slice(0, 5));
  assert.ok(Math.abs((await seconds(page)) - (Number(last[0]) - Number(first[0]))) < 60);
  assert.match(await text(page, '.packup'), /Can I pack up\?.*so far yes.*gaps in the recording: none.*standstills: \d+ times, \d+ s at the start/s);
  assert.ok(await page.getAttribute('.packup', 'open') !== null);
  // The smoothed trajectory takes its place, the open tab stays, and the control points are there.
  await page.click('[data-tab=notes]');
  go();
  await at('smoothed');
  await page.waitForFunction(() => /SO FAR · smoothed/.test(document.querySelector('.verdict').textContent), null, { timeout: 15000 });
  assert.equal(await page.getAttribute('[aria-selected=true]', 'data-tab'), 'notes');
  await page.keyboard.press('End');
  await page.waitForFunction(() => document.querySelector('.km').textContent > '0:30:00'); // the whole run is seen
  assert.match(await text(page, '.packup'), /control points: 17 used, 0 rejected, at most \d+ m without/);
  assert.ok(await page.locator('[data-tab=control]').count());
  await page.waitForFunction(() => /^running: \S/.test(document.querySelector('.progress').textContent));
  if (process.env.VERSINE_SHOT) await page.screenshot({ path: process.env.VERSINE_SHOT });
  go();
  assert.equal(await done, 0);
  await page.waitForFunction(() => !/SO FAR/.test(document.querySelector('.verdict').textContent), null, { timeout: 15000 });
  assert.ok(await page.locator('[data-strip="gauge_deviation_mm"]').count());
  assert.ok(!existsSync(place('soon', 'partial')) && !existsSync(place('soon', 'progress.json')));
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test('a job that ends without a result says so', async () => {
  const { job, done, at } = survey('never');
  await at('forward pass');
  const page = await look('never');
  job.kill('SIGKILL');
  await done;
  await page.waitForSelector('[role=alert]', { timeout: 15000 });
  assert.match(await text(page, '[role=alert]'), /ended without a result/);
  const again = survey('never');
  assert.equal(await again.done, 0);
  await page.waitForSelector('[data-strip="gauge_deviation_mm"]', { timeout: 15000 });
  await page.context().close();
});
