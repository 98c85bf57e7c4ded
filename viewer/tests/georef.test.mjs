// SPDX-License-Identifier: Apache-2.0
// The georeferencing screen in a real browser: on a made result with an ambiguous stretch, on a simulated journey that
// is reviewed and run again, and on a map as large as a country's.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { browse, open, requirePage, run, serve, source } from './support.mjs';

const folder = mkdtempSync(path.join(os.tmpdir(), 'versine-georef-'));
const place = (...names) => path.join(folder, ...names);
const servers = [];
let browser;

async function view(result) {
  const server = await serve(result);
  servers.push(server);
  return server;
}

/** A journey of 20 s over tracks A and B, which may have gone over C instead of B; and lines around it. */
function writeResult(name, lines = 3) {
  mkdirSync(place(name));
  const write = (file, text) => writeFileSync(place(name, file), text);
  const line = [[9, 52, 0], [9, 52.0009, 100], [9, 52.0018, 200]];
  const other = [[9, 52, 0], [9, 52.0009, 100], [9.0002, 52.0018, 200]];
  const track = (id, from_m, to_m) => ({ id, line: id, reversed: false, from_m, to_m });
  const hypothesis = (n, probability, second, places) => ({ path: n, probability, log_likelihood: -n, log_prior: 0, from_m: 5, to_m: 195, line: places, evidence: {}, tracks: [track('A', 0, 100), track(second, 100, 200)] });
  write('georef.json', JSON.stringify({
    format: 'versine-georef 1',
    network: { file: 'map.gpkg', geojson: 'network.geojson', crs: 'EPSG:25832', tracks: lines, warnings: [] },
    recordings: [{ name: 'run.h5', journeys: [{ journey: 1, from_s: 1000, to_s: 1019, length_m: 190, fixes: 20, rejected: 1, entropy_nat: 0.5, paths: [hypothesis(1, 0.8, 'B', line), hypothesis(2, 0.2, 'C', other)],
      ambiguous: [{ from_s: 1010, to_s: 1019, from_m: 100, to_m: 195, taken: ['B'], alternative: ['C'], paths: [2], probability: 0.2, evidence: { position: 1.4, route: -0.2 } }] }] },
    { name: 'broken.h5', error: 'no fix lies on the map' }],
  }));
  const feature = (id, coordinates) => ({ type: 'Feature', properties: { id }, geometry: { type: 'LineString', coordinates } });
  const features = [feature('A', [[9, 52], [9, 52.0009]]), feature('B', [[9, 52.0009], [9, 52.0018]]), feature('C', [[9, 52.0009], [9.0002, 52.0018]])];
  for (let i = 3; i < lines; ++i) {
    const [east, north] = [7 + 4 * ((i * 0.618) % 1), 50 + 3 * ((i * 0.382) % 1)];
    features.push(feature(`T${i}`, Array.from({ length: 17 }, (_, k) => [east + 0.001 * k, north + 0.0003 * Math.sin(k)])));
  }
  write('network.geojson', JSON.stringify({ type: 'FeatureCollection', features }));
  const times = Array.from({ length: 20 }, (_, k) => k);
  write('positions.csv', ['recording,journey,time_s,track,path_distance_m,speed_mps,sigma_m,sigma_speed_mps', ...times.map((t) => `1,1,${1000 + t},${t < 10 ? 'A' : 'B'},${5 + 10 * t},${10 + 0.125 * t},${0.5 + 0.01 * t},0.25`)].join('\n') + '\n');
  write('fixes.csv', ['recording,journey,time_s,latitude_deg,longitude_deg,sigma_m,status,along_m,across_m,sigma_along_m,sigma_across_m,nis,path_distance_m', ...times.map((t) => `1,1,${1000 + t},${52 + 0.00009 * t},9,1.5,${t === 7 ? 'rejected' : 'used'},0.25,-0.5,1,2,${t === 7 ? 99 : 0.5},${5 + 10 * t}`)].join('\n') + '\n');
  write('run.json', JSON.stringify({ format: 'versine run 1', command: 'georef', version: 'test', settings: { title: 'A made journey' } }));
  return place(name);
}

before(async () => {
  browser = await browse();
});
after(async () => {
  for (const server of servers) server.stop();
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

const read = (page, strip) => page.textContent(`[data-strip="${strip}"] output`);
async function press(page, ...keys) {
  for (const key of keys) await page.keyboard.press(key);
  await page.waitForTimeout(120);
}

test('values at the cursor are those of the files, over time and over distance', async () => {
  const page = await open(browser, await view(writeResult('values')));
  await page.keyboard.press('g');
  await page.keyboard.type('0:00:08');
  await press(page, 'Enter');
  assert.equal(await read(page, 'speed'), '11.00');
  assert.match(await page.textContent('[data-strip="speed"] .strip-value span'), /± 0\.49 m\/s/);
  assert.equal(await read(page, 'sigma'), '0.58');
  assert.equal(await read(page, 'across'), '−0.50');
  assert.equal(await read(page, 'probability'), '100%');
  assert.match(await page.textContent('.km'), /85\.0 m/);
  await press(page, 't');
  await page.waitForFunction(() => document.querySelector('.km').textContent.includes('0+085'));
  assert.equal(await read(page, 'speed'), '11.00');
  assert.deepEqual(page.faults, []);
});

test('the stretch is walked to, another path chosen, confirmed, and taken back, with keys alone', async () => {
  const result = writeResult('review');
  const file = `${result}.constraints.toml`;
  const page = await open(browser, await view(result));
  await press(page, 'n');
  assert.equal(await page.getAttribute('.stretches tr[aria-current]', 'aria-current'), 'true');
  assert.match(await page.textContent('.stretches tbody tr'), /20%.*run\.h5.*B.*C.*fixes for 1 by 1\.4/s);
  assert.equal(await read(page, 'probability'), '80%');
  await press(page, '2');
  assert.equal(await page.getAttribute('.choice [data-path="2"]', 'aria-checked'), 'true');
  await press(page, 'Enter');
  await page.waitForSelector('.decisions li');
  const text = readFileSync(file, 'utf8');
  assert.match(text, /recording = ['"]run\.h5['"]/);
  assert.match(text, /tracks = \[ ['"]A['"], ['"]C['"] \]/);
  await press(page, 'u');
  await page.waitForFunction(() => !document.querySelector('.decisions li'));
  assert.doesNotMatch(readFileSync(file, 'utf8'), /run\.h5/);
  // What a session before decided is there again.
  await press(page, 'Enter');
  await page.waitForSelector('.decisions li');
  const again = await open(browser, servers.at(-1));
  assert.equal(await again.locator('.decisions li').count(), 1);
  assert.deepEqual(page.faults, []);
});

test('what a reviewer confirms the next run obeys', async () => {
  run('simulate', path.join(source, 'examples/scenarios/harbour-day.toml'), '-o', place('harbour'), '--quiet');
  const job = place('harbour', 'georef.toml');
  run('georef', job, '-o', place('first'), '--quiet');
  const page = await open(browser, await view(place('first')));
  const before = JSON.parse(readFileSync(place('first', 'georef.json'), 'utf8')).recordings[0].journeys[0];
  await press(page, 'Enter'); // confirms path 1 of the whole first journey
  await page.waitForSelector('.decisions li');
  writeFileSync(job, `constraints = "${place('first.constraints.toml')}"\n${readFileSync(job, 'utf8')}`);
  run('georef', job, '-o', place('second'), '--quiet');
  const now = JSON.parse(readFileSync(place('second', 'georef.json'), 'utf8')).recordings[0].journeys[0];
  assert.deepEqual(now.paths[0].tracks.map((t) => t.id), before.paths[0].tracks.map((t) => t.id));
  assert.ok(readFileSync(place('second', 'run.json'), 'utf8').includes('first.constraints.toml'));
});

test('keyboard and screen reader find everything, contrast holds in every theme', async () => {
  const page = await open(browser, await view(writeResult('accessible')));
  const axe = readFileSync(requirePage.resolve('axe-core/axe.min.js'), 'utf8');
  await press(page, 'n');
  for (let theme = 0; theme < 3; ++theme) {
    await page.evaluate(axe);
    const { violations } = await page.evaluate(() => globalThis.axe.run({ runOnly: ['wcag2a', 'wcag2aa', 'wcag21aa'] }));
    assert.deepEqual(violations.map((v) => [v.id, v.nodes.map((n) => n.html)]), []);
    await press(page, 'd');
  }
  assert.match(await page.textContent('#live'), /track of path 1/);
  assert.match(await page.textContent('.failures'), /broken\.h5: no fix lies on the map/);
});

test('a map of 11,906 lines is drawn in levels', async () => {
  const server = await view(writeResult('country', 11906));
  const begin = performance.now();
  const page = await open(browser, server);
  console.log(`country map ready in ${Math.round(performance.now() - begin)} ms`);
  const counts = [];
  for (const level of [0, 1, 2]) {
    const response = await fetch(`${server.base}api/map/${level}`, { headers: { 'X-Versine-Token': server.token } });
    counts.push(new Uint32Array(await response.arrayBuffer(), 16, 2)[1]);
  }
  assert.ok(counts[0] > counts[1] && counts[1] >= counts[2], String(counts));
  assert.deepEqual(page.faults, []);
});
