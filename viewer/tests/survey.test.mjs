// SPDX-License-Identifier: Apache-2.0
// The survey screen in a real browser, on a simulated survey and on fixtures.
import assert from 'node:assert/strict';
import { cpSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { value, sigma, writeResult } from './fixture.mjs';
import { browse, loaded, open, press, requirePage, run, serve, settle, source } from './support.mjs';

const folder = mkdtempSync(path.join(os.tmpdir(), 'versine-view-'));
const place = (...names) => path.join(folder, ...names);
let browser;
const servers = [];

async function view(...results) {
  const server = await serve(...results);
  servers.push(server);
  return server;
}

const exceedances = [
  ['twist_3m_mm_per_m', 'IAL', 3000, 9.5, 0.999],
  ['level_left_d1_mm', 'IL', 3020, -10.5, 0.8], // 5 m on: the same event
  ['level_left_d1_mm', 'AL', 6000, 7.25, 0.97],
  ['level_left_d1_mm', 'IL', 1000, 11.5, 0.99],
];
// A jump back by 15 m at 1000 m: kilometres 12+985 to 13+000 occur twice.
before(async () => {
  browser = await browse();
  writeResult(place('jump'), { jump: 1000, gap: [2000, 2200], exceedances });
});
after(async () => {
  for (const server of servers) server.stop();
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

const read = (page, strip) => page.textContent(`[data-strip="${strip}"] output`);
const half = (page, strip) => page.textContent(`[data-strip="${strip}"] .strip-value span`);
const exact = async (page, strip) => /^(\S+) .*sigma (\S+)$/.exec(await page.getAttribute(`[data-strip="${strip}"] output`, 'title')).slice(1).map(Number);
const km = (page) => page.textContent('.km');
const typed = (text) => Number(text.replace('−', '-').replace(/^[■◆▲] /, ''));
async function goTo(page, text) {
  await page.keyboard.press('g');
  await page.keyboard.type(text);
  await press(page, 'Enter');
}

test('every value is that of the file, with its 95 % interval', async () => {
  run('simulate', path.join(source, 'examples/scenarios/slab-1km.toml'), '-o', place('recording'), '--quiet');
  run('survey', place('recording', 'survey.toml'), '-o', place('survey'), '--quiet', '--set', `geometry.quality.limits=${path.join(source, 'data/limits/china-ballastless.toml')}`, '--set', 'geometry.quality.speed_kmh=300');
  const [head, ...rows] = readFileSync(place('survey', 'geometry.csv'), 'utf8').trim().split('\n').map((line) => line.split(','));
  const server = await view(place('survey'));
  const first = Number(rows[0][0]);
  for (const [i, whole] of [[400, false], [1753, true], [3500, true]]) {
    const page = await open(browser, server, { hash: `from=${first + 50}&to=${first + 900}&at=${first + 0.25 * i}` });
    if (whole) await loaded(page);
    await page.waitForTimeout(200);
    for (const strip of await page.$$eval('.strip', (all) => all.map((s) => s.dataset.strip))) {
      const [v, s] = [Number(rows[i][head.indexOf(strip)]), Number(rows[i][head.indexOf(`sigma_${strip}`)])];
      const [shown, deviation] = await exact(page, strip);
      assert.ok(Math.abs(shown - v) <= 1e-6 * Math.max(1, Math.abs(v)), `${strip}: ${shown} is not ${v}`);
      assert.ok(Math.abs(deviation - s) <= 1e-6, `${strip}: sigma ${deviation} is not ${s}`);
      if (strip === 'curvature_per_km') continue; // shown as a radius
      const [text, interval] = [await read(page, strip), await half(page, strip)];
      const digits = (/\.(\d+)/.exec(text)?.[1] ?? '').length;
      assert.equal(typed(text), Number(v.toFixed(digits)) + 0, strip);
      assert.equal(Number(/± (\S+)/.exec(interval)[1]), Number((1.96 * s).toFixed(digits)), strip);
    }
    assert.deepEqual(page.faults, []);
    await page.context().close();
  }
  // The control points of the other tab, against innovations.csv.
  const page = await open(browser, server);
  await page.click('[data-tab=control]');
  const shown = await page.$$eval('.sheet tbody tr', (all) => all.map((row) => [...row.cells].map((c) => c.textContent)));
  const landmarks = readFileSync(place('survey', 'innovations.csv'), 'utf8').split('\n').map((l) => l.split(',')).filter((l) => l[1] === 'landmark');
  assert.equal(shown.length, landmarks.length / 3);
  for (const [i, row] of shown.entries()) {
    for (const k of [0, 1, 2]) {
      const [innovation, deviation] = [landmarks[3 * i + k][3], landmarks[3 * i + k][4]].map((t) => 1e3 * Number(t));
      assert.equal(row[2 + k], `${(innovation.toFixed(1) === '-0.0' ? '0.0' : innovation.toFixed(1)).replace('-', '−')} ± ${(1.96 * deviation).toFixed(1)}`);
    }
  }
  await page.context().close();
});

test('without track geometry: the trajectory over time, as in trajectory.csv', async () => {
  cpSync(place('survey'), place('trajectory'), { recursive: true });
  rmSync(place('trajectory', 'geometry.csv'));
  const [head, ...rows] = readFileSync(place('trajectory', 'trajectory.csv'), 'utf8').trim().split('\n').filter((l) => !l.startsWith('#')).map((l) => l.split(','));
  const row = rows[9000];
  const at = (name) => Number(row[head.indexOf(name)]);
  const x = Number(row[0]) - Number(rows[0][0]);
  const page = await open(browser, await view(place('trajectory')), { hash: `from=100&to=1900&at=${x.toFixed(2)}` });
  await loaded(page);
  assert.match(await page.textContent('.verdict'), /TRAJECTORY ONLY/);
  for (const [strip, v, s] of [['height_m', at('height_m'), at('sigma_down_m')], ['roll_deg', at('roll_deg'), NaN], ['speed_mps', Math.hypot(at('velocity_north_mps'), at('velocity_east_mps')), NaN]]) {
    const [shown, deviation] = await exact(page, strip);
    assert.ok(Math.abs(shown - v) <= 1e-6 * Math.max(1, Math.abs(v)), `${strip}: ${shown} is not ${v}`);
    if (Number.isFinite(s)) assert.ok(Math.abs(deviation - s) <= 1e-6, `${strip}: sigma ${deviation} is not ${s}`);
  }
  assert.match(await km(page), /^0:\d\d:\d\d$/);
  await goTo(page, '0:10:00');
  assert.equal(await km(page), '0:10:00');
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test('keys move, zoom and fit', async () => {
  const page = await open(browser, await view(place('jump')));
  await loaded(page);
  const range = async () => /from=([\d.]+)&to=([\d.]+)&at=([\d.]+)/.exec(page.url()).slice(1).map(Number);
  await press(page, 'Home');
  await press(page, '+', '+');
  let [from, to, at] = await range();
  assert.ok(Math.abs(to - from - 500) < 0.1 && at === 0);
  await press(page, 'PageDown');
  assert.ok(Math.abs((await range())[0] - from - 450) < 0.1);
  await press(page, 'f');
  assert.deepEqual((await range()).slice(0, 2), [0, 2000]);
  [, , at] = await range();
  await press(page, 'ArrowRight');
  const [, , right] = await range();
  await press(page, 'Shift+ArrowRight');
  const [, , far] = await range();
  assert.ok(right > at && Math.abs(far - right - 10 * (right - at)) < 0.2, `${at}, ${right}, ${far}`);
  await press(page, 'ArrowLeft');
  assert.ok((await range())[2] < far);
  await press(page, 'End');
  assert.equal((await range())[2], 2000);
  assert.equal(await km(page), 'km 13+985');
  await press(page, '?');
  assert.ok(await page.isVisible('dialog[aria-label=Keys]'));
  await press(page, 'Escape');
  // The wheel zooms at the cursor, a drag zooms to what was dragged, a double click shows all.
  const box = await (await page.$('[data-strip="level_left_d1_mm"] .u-over')).boundingBox();
  await page.mouse.move(box.x + box.width / 4, box.y + 10);
  await page.mouse.wheel(0, -400);
  await settle(page);
  [from, to] = await range();
  assert.ok(Math.abs(from + (to - from) / 4 - 500) < 20 && to - from < 1000);
  await page.mouse.dblclick(box.x + 30, box.y + 10);
  await settle(page);
  await page.mouse.move(box.x + 0.25 * box.width, box.y + 10);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 12, { steps: 4 });
  await page.mouse.up();
  await settle(page);
  [from, to] = await range();
  assert.ok(Math.abs(from - 500) < 5 && Math.abs(to - 1000) < 5, `${from} to ${to}`);
  assert.deepEqual(page.faults, []);
  await page.context().close();
});

test('a jump in chainage: posted kilometres, both places of one that is posted twice', async () => {
  const page = await open(browser, await view(place('jump')), { hash: 'from=900&to=1100&at=999' });
  await loaded(page);
  assert.equal(await km(page), 'km 12+999');
  await goTo(page, '12+990');
  assert.match(page.url(), /at=1005\.00/);
  assert.equal(await km(page), 'km 12+990');
  await goTo(page, '12.990');
  assert.match(page.url(), /at=990\.00/);
  await page.keyboard.press('g');
  await page.keyboard.type('99+000');
  await page.keyboard.press('Enter');
  assert.equal(await page.textContent('dialog [role=alert]'), 'This place is not in the result.');
  await press(page, 'Escape');
  await page.context().close();
});

test('a stretch without values is a gap, not a zero', async () => {
  const page = await open(browser, await view(place('jump')), { hash: 'from=400&to=600&at=525' });
  await loaded(page);
  assert.equal(await read(page, 'level_left_d1_mm'), '–');
  // The line's colour is left of the gap and nowhere in it.
  const inked = (from, to) => page.$eval('[data-strip="level_left_d1_mm"] canvas', (canvas, [a, b]) => {
    const { width, height } = canvas;
    const left = 44 * devicePixelRatio;
    const right = width - 26 * devicePixelRatio;
    const at = (x) => Math.round(left + ((x - 400) / 200) * (right - left));
    const { data } = canvas.getContext('2d').getImageData(at(a), 0, at(b) - at(a), height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i + 2] > 180 && data[i] < 120) ++count;
    return count;
  }, [from, to]);
  assert.ok((await inked(450, 495)) > 50);
  assert.equal(await inked(503, 520), 0);
  assert.match(await page.textContent('.packup summary'), /gaps in the trajectory/);
  await page.context().close();
});

test('N and B walk the exceedances, the worst first, events together', async () => {
  const page = await open(browser, await view(place('jump')));
  await loaded(page);
  assert.match(await page.textContent('.verdict'), /NOT ACCEPTED · 1 IAL · 2 IL · 1 AL/);
  const row = () => page.textContent('tr[aria-current]');
  const seen = [];
  for (let i = 0; i < 4; ++i) {
    await press(page, 'n');
    seen.push(await row());
  }
  assert.match(seen[0], /IAL12\+750Twist9\.50>99%/);
  assert.match(seen[1], /IL↳ 12\+755Level left−10\.580%/);
  assert.match(seen[2], /IL12\+250/);
  assert.match(seen[3], /AL13\+485/);
  assert.equal(await km(page), 'km 13+485');
  assert.equal(await read(page, 'level_left_d1_mm'), '▲ 7.3');
  await page.waitForTimeout(300);
  assert.match(await page.textContent('#live'), /Level left 7\.3 ± .* over the AL/);
  await press(page, 'b');
  assert.match(await row(), /12\+250/);
  await page.context().close();
});

test('marks survive page and program', async () => {
  const first = await view(place('jump'));
  const page = await open(browser, first, { hash: 'from=0&to=2000&at=321' });
  await press(page, 'm');
  await page.waitForTimeout(300);
  assert.match(await page.textContent('.marks'), /12\+321/);
  await page.context().close();
  first.child.kill('SIGKILL');
  const again = await open(browser, await view(place('jump')));
  await again.waitForSelector('.marks li');
  assert.match(await again.textContent('.marks'), /Marks \(1\).*12\+321/);
  await again.click('.marks li [aria-label^=Remove]');
  await again.waitForTimeout(300);
  assert.equal(readFileSync(place('jump.marks.json'), 'utf8').trim(), '[]');
  await again.context().close();
});

test('exports hold what is seen', async () => {
  const page = await open(browser, await view(place('jump')), { hash: 'from=480&to=510&at=490' });
  await loaded(page);
  const save = async (label) => {
    await page.keyboard.press('e');
    const [download] = await Promise.all([page.waitForEvent('download'), page.click(`dialog button:has-text("${label}")`)]);
    return readFileSync(await download.path());
  };
  const [head, ...rows] = (await save('CSV')).toString().trim().split('\n').map((l) => l.split(','));
  assert.equal(rows.length, 121);
  const i = rows.findIndex((r) => r[0] === '490.000');
  assert.equal(Number(rows[i][head.indexOf('level_left_d1_mm')]), Number(value('level_left_d1_mm', 1960)));
  assert.equal(Number(rows[i][head.indexOf('sigma_level_left_d1_mm')]), Number(sigma(1960)));
  assert.equal(rows.at(-1)[head.indexOf('level_left_d1_mm')], ''); // in the gap
  const gpx = (await save('GPX')).toString();
  assert.equal(gpx.match(/<wpt /g).length, 4);
  assert.match(gpx, /lat="50\.5\d+" lon="9\.0\d+"><name>IAL Twist 12\+750/);
  assert.ok((await save('PNG')).length > 10000);
  // On paper: light, one page, and the screen comes back as it was.
  await page.evaluate(() => (window.print = () => (document.documentElement.dataset.printed = 'true')));
  await page.keyboard.press('e');
  await page.click('dialog button:has-text("PDF")');
  await page.waitForSelector('html[data-printed]');
  assert.equal(await page.getAttribute('html', 'data-theme'), 'light');
  const pdf = (await page.pdf({ preferCSSPageSize: true, printBackground: true })).toString('latin1');
  assert.equal(pdf.match(/\/Type \/Page\b/g).length, 1);
  await page.evaluate(() => dispatchEvent(new Event('afterprint')));
  assert.equal(await page.getAttribute('html', 'data-theme'), 'dark');
  await page.context().close();
});

test('themes: contrast, names and roles pass axe-core (WCAG 2 AA)', async () => {
  const server = await view(place('jump'));
  const axe = readFileSync(requirePage.resolve('axe-core/axe.min.js'), 'utf8');
  for (const theme of ['dark', 'light', 'red']) {
    const page = await open(browser, server, { theme });
    await loaded(page);
    await press(page, 'n');
    await page.evaluate(axe);
    for (const step of ['strips', 'notes', 'keys', 'export']) {
      if (step === 'notes') await page.click('[data-tab=notes]');
      if (step === 'keys') await press(page, '?');
      if (step === 'export') await press(page, 'Escape', 'e');
      const { violations } = await page.evaluate(() => axe.run({ runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa'] }));
      assert.deepEqual(violations.map((v) => `${theme} ${step} ${v.id}: ${v.nodes.map((n) => n.html).join(' ')}`), []);
    }
    await page.context().close();
  }
  const page = await open(browser, server, { theme: 'dark' });
  await press(page, 'd');
  assert.equal(await page.getAttribute('html', 'data-theme'), 'light');
  await press(page, 'd');
  assert.equal(await page.getAttribute('html', 'data-theme'), 'red');
  await page.context().close();
});

test('a whole review without a mouse', async () => {
  const page = await open(browser, await view(place('jump')));
  await loaded(page);
  const focused = new Set();
  for (let i = 0; i < 40; ++i) {
    await page.keyboard.press('Tab');
    focused.add(await page.evaluate(() => document.activeElement?.textContent?.trim() || document.activeElement?.getAttribute('aria-label')));
  }
  for (const name of ['Theme D', 'Export E', '12+750', 'Strips']) assert.ok(focused.has(name), `${name} cannot be reached: ${[...focused]}`);
  await page.focus('[data-tab=strips]');
  await press(page, 'ArrowRight');
  assert.notEqual(await page.getAttribute('[aria-selected=true]', 'data-tab'), 'strips');
  await page.context().close();
});

test('two runs: the difference and the other run beside', async () => {
  writeResult(place('later'), { offset: 1.5, title: 'After tamping' });
  writeResult(place('earlier'), { title: 'Before tamping' });
  const page = await open(browser, await view(place('later'), '--compare', place('earlier')), { hash: 'from=100&to=300&at=200' });
  await loaded(page, 'difference');
  assert.equal(await read(page, 'difference:level_left_d1_mm'), '1.5');
  assert.match(await page.textContent('.subtitle'), /^minus Before tamping/);
  const [shown, deviation] = await exact(page, 'difference:level_left_d1_mm');
  assert.ok(Math.abs(shown - 1.5) < 1e-4 && Math.abs(deviation - Math.SQRT2 * Number(sigma(800))) < 1e-5);
  await page.context().close();
});

test('more samples than a page holds: drawn and read through the server', async () => {
  writeResult(place('long'), { count: 520001, only: ['level_left_d1_mm', 'twist_3m_mm_per_m'] });
  const page = await open(browser, await view(place('long')), { hash: 'from=60000&to=60100&at=60012.5' });
  await page.waitForTimeout(300);
  const [shown] = await exact(page, 'level_left_d1_mm');
  assert.ok(Math.abs(shown - Number(value('level_left_d1_mm', 240050))) < 1e-5);
  await press(page, 'f');
  await page.waitForTimeout(300);
  assert.deepEqual(page.faults, []);
  await page.context().close();
});
