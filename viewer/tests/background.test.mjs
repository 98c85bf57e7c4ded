// SPDX-License-Identifier: Apache-2.0
// A picture of the ground under the plan, in a real browser; io.BackgroundMapTest looks at its pixels, and at MBTiles.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { writeResult } from './fixture.mjs';
import { writeGeorefResult } from './georef_fixture.mjs';
import { writeGeoTiff } from './geotiff.mjs';
import { browse, open, serve, versine } from './support.mjs';

const folder = mkdtempSync(path.join(os.tmpdir(), 'versine-background-'));
const place = (...names) => path.join(folder, ...names);
let browser;
const servers = [];
before(async () => {
  browser = await browse();
});
after(async () => {
  for (const server of servers) server.stop();
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** Share of reddish pixels of a map. */
async function red(page) {
  const png = (await page.locator('.plan-map').first().screenshot()).toString('base64');
  return page.evaluate(async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
    context.drawImage(image, 0, 0);
    const { data: p } = context.getImageData(0, 0, image.width, image.height);
    let n = 0;
    for (let i = 0; i < p.length; i += 4) n += p[i] > 90 && p[i + 1] < 70 && p[i + 2] < 70 ? 1 : 0;
    return n / (p.length / 4);
  }, png);
}

async function look(result, picture) {
  const server = await serve(result, ...(picture ? ['--background', picture] : []));
  servers.push(server);
  const page = await open(browser, server);
  if (picture) await page.waitForSelector('html[data-background=shown]', { timeout: 15000 });
  await page.waitForTimeout(300);
  return { page, server };
}

test('a GeoTIFF lies under the plan of a survey and under the map of journeys', async () => {
  const survey = writeResult(place('survey'), { count: 2001 }); // from 500000, 5600000 in EPSG:32632
  const ground = writeGeoTiff(place('ground.tif'), { epsg: 32632, easting: 499000, northing: 5602000, metre: 60 });
  const plain = await look(survey);
  assert.equal(await red(plain.page), 0);
  const { page, server } = await look(survey, ground);
  assert.ok((await red(page)) > 0.5);
  assert.deepEqual(page.faults, []);
  const ask = (query, token = server.token) => fetch(`${server.base}api/background?${query}`, { headers: { 'X-Versine-Token': token } });
  const window = 'west=500000&south=5600000&east=500400&north=5600400&width=64&height=64';
  const answer = await ask(window);
  assert.equal(answer.headers.get('content-type'), 'image/png');
  assert.equal((await ask(window, '0'.repeat(64))).status, 401);
  for (const wrong of ['', window.replace('width=64', 'width=9000'), window.replace('east=500400', 'east=499000'), window.replace('north=5600400', 'north=inf')]) {
    assert.equal((await ask(wrong)).status, 404, wrong);
  }
  // Web Mercator under a map in EPSG:25832: 9 E, 52 N.
  const mercator = writeGeoTiff(place('mercator.tif'), { epsg: 3857, easting: 1001875.4 - 2000, northing: 6800125.5 + 2000, metre: 62.5 });
  const journeys = await look(writeGeorefResult(place('georef')), mercator);
  assert.ok((await red(journeys.page)) > 0.5);
  assert.deepEqual(journeys.page.faults, []);
});

test('what is no picture of a place is refused with the cure', () => {
  const result = writeResult(place('result'), { count: 401 });
  const refused = (picture) => {
    const { status, stderr } = spawnSync(versine, ['view', '--no-browser', result, '--background', picture], { encoding: 'utf8', timeout: 20000 });
    assert.equal(status, 2, stderr);
    return stderr;
  };
  assert.match(refused(place('none.tif')), /no such file[^]*GeoTIFF[^]*--background/);
  writeFileSync(place('text.tif'), 'no picture');
  assert.match(refused(place('text.tif')), /no picture/);
});
