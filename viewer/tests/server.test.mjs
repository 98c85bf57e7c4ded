// SPDX-License-Identifier: Apache-2.0
// The program around the page: who may ask, what cannot be opened, a job that is still running.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { copyFileSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import http from 'node:http';
import net from 'node:net';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { writeResult } from './fixture.mjs';
import { browse, open, serve, versine } from './support.mjs';

const folder = mkdtempSync(path.join(os.tmpdir(), 'versine-view-'));
const place = (...names) => path.join(folder, ...names);
const servers = [];
let server;
before(async () => {
  writeResult(place('result'), { count: 401 });
  servers.push((server = await serve(place('result'))));
});
after(() => {
  for (const s of servers) s.stop();
  rmSync(folder, { recursive: true, force: true });
});

const ask = (target, { method = 'GET', headers = {}, token = server.token, body } = {}) =>
  new Promise((resolve, reject) => {
    const all = { Host: `127.0.0.1:${server.port}`, ...(token ? { 'X-Versine-Token': token } : {}), ...headers };
    const request = http.request({ host: '127.0.0.1', port: server.port, path: target, method, headers: all, setHost: false }, (response) => {
      let text = '';
      response.on('data', (part) => (text += part));
      response.on('end', () => resolve({ status: response.statusCode, headers: response.headers, text }));
    });
    request.on('error', reject);
    request.end(body);
  });
const status = async (...what) => (await ask(...what)).status;

test('the own page is served, and nothing may frame or sniff it', async () => {
  assert.equal(await status('/api/result'), 200);
  const { headers } = await ask('/', { token: null });
  assert.match(headers['content-security-policy'], /default-src 'none'.*frame-ancestors 'none'/);
  assert.equal(headers['x-content-type-options'], 'nosniff');
  assert.equal(headers['referrer-policy'], 'no-referrer');
});

test('without the token, or with another: 401', async () => {
  for (const token of [null, '0'.repeat(64), server.token.slice(0, 63)]) {
    for (const target of ['/api/result', '/api/progress', '/api/values?x=0', '/api/marks', '/api/report', '/api/series/gauge_deviation_mm']) {
      assert.equal(await status(target, { token }), 401, target);
    }
  }
});

test('a foreign Host: 421', async () => {
  for (const host of ['example.org', 'localhost', `localhost:${server.port}`, '127.0.0.1', `127.0.0.1.example.org:${server.port}`]) {
    assert.equal(await status('/api/result', { headers: { Host: host } }), 421, host);
  }
});

test('another site: 403', async () => {
  assert.equal(await status('/api/result', { headers: { Origin: 'http://example.org' } }), 403);
  assert.equal(await status('/api/result', { headers: { Origin: 'null' } }), 403);
  assert.equal(await status('/api/result', { headers: { 'Sec-Fetch-Site': 'cross-site' } }), 403);
  assert.equal(await status('/', { headers: { 'Sec-Fetch-Site': 'same-site' } }), 403);
});

test('other methods: 405; only marks may be written, as JSON', async () => {
  for (const method of ['POST', 'PUT', 'DELETE', 'PATCH', 'OPTIONS']) assert.equal(await status('/api/result', { method }), 405, method);
  const json = { 'Content-Type': 'application/json' };
  assert.equal(await status('/api/marks', { method: 'POST', headers: json, body: '[]' }), 204);
  assert.equal(await status('/api/marks', { method: 'POST', headers: json, body: '{}' }), 422);
  assert.equal(await status('/api/marks', { method: 'POST', headers: { 'Content-Type': 'text/plain' }, body: '[]' }), 415);
  assert.equal(await status('/api/marks', { method: 'POST', headers: json, body: '[]', token: null }), 401);
});

test('no path leads to a file', async () => {
  for (const target of ['/../run.json', '/..%2frun.json', '/%2e%2e/run.json', '//etc/passwd', '/run.json', '/app.js/../run.json', '/api/series/..%2f..%2fetc%2fpasswd', '/api/series/geometry.csv']) {
    assert.equal(await status(target), 404, target);
  }
});

test('served on the loopback address only', async () => {
  const others = Object.values(os.networkInterfaces()).flat().filter((i) => i.family === 'IPv4' && !i.internal);
  for (const { address } of [...others, { address: '::1' }]) {
    const answered = await new Promise((resolve) => {
      const socket = net.connect({ host: address, port: server.port, timeout: 2000 });
      socket.on('connect', () => resolve(true));
      for (const event of ['error', 'timeout']) socket.on(event, () => resolve(false));
    });
    assert.equal(answered, false, address);
  }
});

/** `versine view` on something that cannot be shown: its words, which name the cure. */
function refused(result, ...more) {
  const { status: code, stderr } = spawnSync(versine, ['view', '--no-browser', result, ...more], { encoding: 'utf8', timeout: 20000 });
  assert.equal(code, 2, stderr);
  return stderr;
}

test('what cannot be opened is refused with the cure', () => {
  assert.match(refused(place('nowhere')), /no such folder[^]*run the job first/);
  mkdirSync(place('empty'));
  assert.match(refused(place('empty')), /a folder without run\.json[^]*give the folder/);
  writeResult(place('cut'), { count: 50 });
  writeFileSync(place('cut', 'run.json'), readFileSync(place('cut', 'run.json'), 'utf8').slice(0, 300));
  assert.match(refused(place('cut')), /cut short[^]*run the job again/);
  writeResult(place('other'), { count: 50, run: { format: 'versine run 9', version: '7.0' } });
  assert.match(refused(place('other')), /'versine run 9', written by version 7\.0[^]*with the version that wrote it/);
  writeResult(place('plan'), { count: 50, run: { command: 'plan' } });
  assert.match(refused(place('plan')), /a result of 'versine plan'/);
  writeResult(place('half'), { count: 50 });
  rmSync(place('half', 'geometry.csv'));
  assert.match(refused(place('half')), /neither geometry\.csv nor trajectory\.h5/);
  writeResult(place('torn'), { count: 50 });
  writeFileSync(place('torn', 'geometry.csv'), readFileSync(place('torn', 'geometry.csv'), 'utf8').slice(0, -20));
  assert.match(refused(place('torn')), /last line without its end[^]*cut short/);
  writeResult(place('letters'), { count: 50 });
  writeFileSync(place('letters', 'geometry.csv'), readFileSync(place('letters', 'geometry.csv'), 'utf8').replace('\n10.000,', '\n1o.000,'));
  assert.match(refused(place('letters')), /geometry\.csv:42: .*'1o\.000' is not a number/);
  writeResult(place('coarse'), { count: 50, run: { results: { step_m: 0.5 } } });
  assert.match(refused(place('result'), '--compare', place('coarse')), /0\.5 m[^]*with the same step/);
});

test('a job that is running: its stages, then its result; a new run replaces the old one', async () => {
  const browser = await browse();
  const job = place(`.soon.new-${process.pid}`); // this process stands for the job
  mkdirSync(job);
  writeFileSync(path.join(job, 'progress.json'), JSON.stringify({ stage: 'smoother', fraction: 0.4, seconds: 3, stages: [{ stage: 'forward pass', seconds: 2.5 }], notes: ['imu: 2 x gap, split'] }));
  const running = await serve(place('soon'));
  servers.push(running);
  const page = await open(browser, running);
  await page.waitForFunction(() => document.body.textContent.includes('smoother'));
  assert.match(await page.textContent('#app'), /forward pass: 2\.5 s[^]*smoother[^]*2 x gap/);
  writeResult(place('soon'), { count: 401, title: 'First run' });
  await page.waitForSelector('.survey', { timeout: 10000 });
  assert.equal(await page.textContent('h1'), 'First run');
  await page.waitForFunction(() => /running: smoother 40 %/.test(document.querySelector('.progress').textContent), null, { timeout: 10000 });
  await page.evaluate(() => (location.hash = 'from=10&to=60&at=33'));
  copyFileSync(place('soon', 'run.json'), place('old.json'));
  writeResult(place('soon'), { count: 401, title: 'Second run' });
  rmSync(job, { recursive: true });
  await page.waitForFunction(() => document.querySelector('h1').textContent === 'Second run', null, { timeout: 10000 });
  assert.match(page.url(), /from=10\.00&to=60\.00&at=33\.00|from=10&to=60&at=33/);
  assert.deepEqual(page.faults, []);
  await browser.close();
});
