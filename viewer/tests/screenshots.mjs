// SPDX-License-Identifier: Apache-2.0
// Pictures for docs/images: node screenshots.mjs OUTPUT DEMO LINE; `make screenshots` makes the results first.
import path from 'node:path';
import { browse, loaded, open, serve } from './support.mjs';

const [output, demo, line, harbour, brussels] = process.argv.slice(2);
const browser = await browse();

async function shot(name, result, options, act = async () => {}) {
  const server = await serve(...[result].flat());
  const page = await open(browser, server, options);
  await loaded(page, options.tab ?? 'strips');
  await act(page);
  await page.waitForTimeout(400);
  await page.screenshot({ path: path.join(output, `${name}.png`) });
  if (page.faults.length > 0) console.error(name, page.faults);
  server.stop();
  await page.context().close();
}

const press = (...keys) => async (page) => {
  for (const key of keys) await page.keyboard.press(key);
};

await shot('survey-dark', line, { theme: 'dark' }, press('n'));
await shot('survey-light-jump', line, { theme: 'light' }, async (page) => {
  await page.keyboard.press('g');
  await page.keyboard.type('18+150');
  await page.keyboard.press('Enter');
  await press('-', '-')(page);
});
await shot('survey-red', line, { theme: 'red' }, press('n', 'n'));
await shot('survey-whole', line, { theme: 'light', width: 1280, height: 720 }, press('f'));
await shot('survey-demo', demo, { theme: 'light' }, press('f'));
// Where the recordings of Brussels are not on this machine their picture stays as it is.
await shot('georef-review', harbour, { theme: 'dark' }, press('n', 'n', '2'));
if (brussels) await shot('georef-brussels', brussels, { theme: 'light' });
await browser.close();
