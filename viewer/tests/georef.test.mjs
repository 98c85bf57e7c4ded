// SPDX-License-Identifier: Apache-2.0
// The georeferencing screen in a real browser: on a made result with an ambiguous stretch, on a simulated journey that
// is reviewed and run again, and on a map as large as a country's.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { writeGeorefResult } from './georef_fixture.mjs';
import { browse, open, press, requirePage, run, serve, source, versine } from './support.mjs';

const folder = mkdtempSync(path.join(os.tmpdir(), 'versine-georef-'));
const place = (...names) => path.join(folder, ...names);
const servers = [];
let browser;

async function view(...words) {
  const server = await serve(...words);
  servers.push(server);
  return server;
}

const writeResult = (name, lines, more) => writeGeorefResult(place(name), { lines, ...more });

before(async () => {
  browser = await browse();
});
after(async () => {
  for (const server of servers) server.stop();
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

const read = (page, strip) => page.textContent(`[data-strip="${strip}"] output`);

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

test('exports hold what is seen, of positions and fixes alike', async () => {
  const page = await open(browser, await view(writeResult('exports')), { hash: 'from=2&to=10&at=5' });
  const save = async (label) => {
    await page.keyboard.press('e');
    const [download] = await Promise.all([page.waitForEvent('download'), page.click(`dialog button:has-text("${label}")`)]);
    return readFileSync(await download.path());
  };
  const [head, ...rows] = (await save('CSV')).toString().trim().split('\n').map((line) => line.split(','));
  const row = rows.find((r) => r[0] === '8.000');
  const at = (name) => row[head.indexOf(name)];
  assert.deepEqual(['speed', 'sigma_speed', 'across', 'sigma_across'].map((n) => Number(at(n))), [11, 0.25, -0.5, 2]);
  assert.ok((await save('PNG')).length > 10000);
  await press(page, 'e');
  assert.equal(await page.locator('dialog button:has-text("GPX")').count(), 0);
  assert.deepEqual(page.faults, []);
});

test('two runs: where the same journey is on other tracks', async () => {
  const [now, before] = [writeResult('now'), writeResult('before', 3, { swapped: true, title: 'The run before' })];
  const page = await open(browser, await view(now, '--compare', before));
  assert.match(await page.textContent('.subtitle'), /^against The run before/);
  assert.match(await page.textContent('.differences'), /Differs from The run before \(1\).*run\.h5 · 1, 100 to 200 m: B here, C there/s);
  await page.click('.differences button');
  await page.waitForFunction(() => Math.abs(parseFloat(document.querySelector('.km').textContent.split(' · ')[1]) - 150) < 10);
  assert.match(await page.textContent('.track'), /^Track B/);
  const same = await open(browser, await view(now, writeResult('again')));
  assert.match(await same.textContent('.differences'), /Same tracks as A made journey/);
  assert.deepEqual([...page.faults, ...same.faults], []);
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

test('a georeferencing that is half, cut, or of another version is refused with the cure', () => {
  const spoiled = (name, file, change) => {
    const result = writeResult(name);
    const text = change?.(readFileSync(place(name, file), 'utf8'));
    if (text === undefined) rmSync(place(name, file));
    else writeFileSync(place(name, file), text);
    const { status, stderr } = spawnSync(versine, ['view', '--no-browser', result], { encoding: 'utf8', timeout: 20000 });
    assert.equal(status, 2, `${name}: ${stderr}`);
    return stderr;
  };
  assert.match(spoiled('no-index', 'georef.json'), /georef\.json/);
  assert.match(spoiled('cut', 'georef.json', (t) => t.slice(0, 400)), /georef\.json[^]*run versine georef again/);
  assert.match(spoiled('other', 'georef.json', (t) => t.replace('versine-georef 1', 'versine-georef 9')), /versine-georef 9[^]*with the version that wrote it/);
  assert.match(spoiled('lacking', 'georef.json', (t) => t.replaceAll('"from_m"', '"start_m"')), /from_m/);
  assert.match(spoiled('no-map', 'network.geojson'), /network\.geojson/);
  assert.match(spoiled('no-positions', 'positions.csv'), /positions\.csv/);
  assert.match(spoiled('columns', 'positions.csv', (t) => t.replace('path_distance_m', 'way')), /positions\.csv[^]*path_distance_m[^]*run versine georef again/);
});

test('positions without values are gaps', async () => {
  const result = writeResult('gaps');
  const lines = readFileSync(place('gaps', 'positions.csv'), 'utf8').split('\n');
  lines[9] = lines[9].replace(/,[\d.]+,[\d.]+,[\d.]+$/, ',nan,0.6,nan'); // 8 s: no speed
  writeFileSync(place('gaps', 'positions.csv'), lines.join('\n'));
  const page = await open(browser, await view(result), { hash: 'from=2&to=12&at=8' });
  assert.equal((await read(page, 'speed')).replace('–', ''), '');
  await press(page, 'ArrowRight');
  assert.deepEqual(page.faults, []);
});

test('a map of 11,906 lines is painted within a second, in levels', async () => {
  const server = await view(writeResult('country', 11906));
  const times = [];
  for (let round = 0; round < 3; ++round) {
    const page = await open(browser, server);
    times.push(await page.evaluate(() => performance.getEntriesByName('versine-ready')[0].startTime)); // the map is painted
    assert.deepEqual(page.faults, []);
    await page.context().close();
  }
  console.log(`a country's map is painted after ${times.map(Math.round).join(', ')} ms`);
  assert.ok(Math.min(...times) < 1000, String(times));
  const counts = [];
  for (const level of [0, 1, 2]) {
    const response = await fetch(`${server.base}api/map/${level}`, { headers: { 'X-Versine-Token': server.token } });
    counts.push(new Uint32Array(await response.arrayBuffer(), 16, 2)[1]);
  }
  assert.ok(counts[0] > counts[1] && counts[1] >= counts[2], String(counts));
});

test('a click on the map names the track, and goes to that place of the path', async () => {
  const page = await open(browser, await view(writeResult('click')));
  const box = await page.locator('.georef-map canvas').first().boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await page.waitForFunction(() => /^Track [ABC]/.test(document.querySelector('.track').textContent));
  await page.waitForFunction(() => Math.abs(parseFloat(document.querySelector('.km').textContent.split(' · ')[1]) - 100) < 6);
  assert.deepEqual(page.faults, []);
});
