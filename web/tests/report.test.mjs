// The page of `macadam report` in Debian's Chromium: in both themes, on phones, without scripts, and asking no host.
import { chromium } from 'playwright-core';
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { createRequire } from 'node:module';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { databaseIn, macadam } from './simulated.mjs';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
let folder, browser;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'macadam-report-'));
  macadam('report', databaseIn(folder), '-o', `${folder}/report.html`, '--language', 'de');
  browser = await chromium.launch({ executablePath: '/usr/bin/chromium', timeout: 60_000,
    args: ['--no-sandbox', '--disable-gpu-sandbox', '--host-resolver-rules=MAP * ~NOTFOUND'] });
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

// A page that fails if it asks for anything but itself, logs an error or throws.
async function opened(width, more = {}, hash = '') {
  const context = await browser.newContext({ viewport: { width, height: 800 }, ...more });
  const page = await context.newPage();
  page.setDefaultTimeout(100_000);
  const wrong = [];
  page.on('request', (request) => { if (!/^(blob:|data:|file:)/.test(request.url())) wrong.push(`asked ${request.url()}`); });
  page.on('pageerror', (error) => wrong.push(String(error)));
  page.on('console', (message) => { if (message.type() === 'error') wrong.push(message.text()); });
  await page.goto(`file://${folder}/report.html${hash}`);
  return { page, async close() { assert.deepEqual(wrong, []); await context.close(); } };
}

for (const colorScheme of ['light', 'dark']) {
  for (const width of [320, 768, 1440]) {
    test(`breaks no rule of axe-core and fits ${width} pixels in the ${colorScheme} theme`, async () => {
      const { page, close } = await opened(width, { colorScheme });
      await page.evaluate(() => document.querySelectorAll('details').forEach((part) => { part.open = true; }));
      await page.evaluate(axe);
      const { violations } = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ['violations'] }));
      assert.deepEqual(violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 160)).join(' | ')}`), []);
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width);
      await close();
    });
  }
}

test('folds its sections on phones, and opens the one that a link leads to', async () => {
  const { page, close } = await opened(320);
  const open = () => page.locator('main details[open]').count();
  assert.ok(await page.locator('main details').count() > 5);
  assert.equal(await open(), 1);
  await page.locator('nav a').nth(2).click();
  await page.waitForFunction(() => document.querySelectorAll('main details')[2].open);
  await close();
});

test('keeps its contents in sight', async () => {
  for (const width of [768, 1440]) {
    const { page, close } = await opened(width);
    await page.evaluate(() => scrollTo(0, document.body.scrollHeight / 2));
    const { top, bottom } = await page.evaluate(() => document.querySelector('nav').getBoundingClientRect().toJSON());
    assert.ok(top >= 0 && bottom <= 800, `${width}: ${top} to ${bottom}`);
    await close();
  }
});

test('sorts a table by a column, the sum always last', async () => {
  const { page, close } = await opened(1440);
  const table = page.locator('main table').nth(1);
  const lengths = async () => (await table.locator('tbody tr td:nth-child(2)').allInnerTexts()).map((text) => Number(text.replace(',', '.')));
  const first = await lengths();
  assert.ok(first.length > 2);
  await table.locator('thead button').nth(1).click();
  const sum = first.at(-1);
  const rest = first.slice(0, -1).sort((a, b) => b - a);
  assert.deepEqual(await lengths(), [...rest, sum]);
  assert.equal(await table.locator('thead th').nth(1).getAttribute('aria-sort'), 'descending');
  await table.locator('thead button').nth(1).click();
  assert.deepEqual(await lengths(), [...rest.reverse(), sum]);
  await close();
});

test('saves a table as CSV with decimal points', async () => {
  const { page, close } = await opened(1440);
  const rows = await page.locator('main table').first().locator('tr').count();
  const [download] = await Promise.all([page.waitForEvent('download'), page.locator('.save').first().click()]);
  const text = readFileSync(await download.path(), 'utf8');
  assert.equal(text.trim().split('\r\n').length, rows);
  assert.match(text, /,\d+\.\d+,/);
  await close();
});

test('gives a spreadsheet no formula, and keeps numbers with a sign', async () => {
  const { page, close } = await opened(1440);
  const texts = ['=1+1', '-2+3', '+cmd', '@a', '-1.5'];
  await page.locator('main table').first().evaluate((table, cells) => {
    table.tBodies[0].rows[0].replaceChildren(...cells.map((text) => Object.assign(document.createElement('td'), { textContent: text })));
  }, texts);
  const [download] = await Promise.all([page.waitForEvent('download'), page.locator('.save').first().click()]);
  const rows = readFileSync(await download.path(), 'utf8').split('\r\n');
  assert.ok(rows.includes("'=1+1,'-2+3,'+cmd,'@a,-1.5"), rows.join('\n'));
  await close();
});

test('works when a link to it is damaged', async () => {
  const { page, close } = await opened(1440, {}, '#%');
  assert.ok(await page.locator('.save').count() > 3);
  await close();
});

test('says everything without scripts', async () => {
  const { page, close } = await opened(1440, { javaScriptEnabled: false });
  assert.equal(await page.locator('main details:not([open])').count(), 0);
  assert.equal(await page.locator('button').count(), 0);
  assert.ok(await page.locator('main table').count() > 3);
  await close();
});

test('repeats the head of a long table on each printed page', async () => {
  const { page, close } = await opened(1440);
  await page.evaluate(() => {
    const table = document.querySelector('main table');
    const row = table.tBodies[0].rows[0];
    for (let i = 0; i < 150; ++i) table.tBodies[0].append(row.cloneNode(true));
    table.parentElement.classList.add('long');
    table.tHead.rows[0].cells[0].querySelector('button').textContent = 'HEADWORD';
  });
  const pdf = join(folder, 'printed.pdf');
  await page.pdf({ path: pdf, preferCSSPageSize: true });
  const heads = execFileSync('pdftotext', [pdf, '-'], { encoding: 'utf8' }).split('HEADWORD').length - 1;
  assert.ok(heads >= 3, `${heads}`);
  await close();
});

test('keeps a swatch on the line of its word, however narrow the column', async () => {
  const { page, close } = await opened(320);
  const lines = await page.evaluate(() => [...document.querySelectorAll('main table')].flatMap((table) => {
    table.style.width = '1px';
    return [...table.querySelectorAll('.entry')].map((entry) => {
      const [swatch, word] = [...entry.children].map((part) => part.getBoundingClientRect());
      return swatch.top < word.bottom && swatch.bottom > word.top && swatch.right <= word.left;
    });
  }));
  assert.ok(lines.length >= 3 && lines.every(Boolean), `${lines}`);
  await close();
});

test('lets no other script run than its own', async () => {
  const { page, close } = await opened(1440);
  const ran = await page.evaluate(() => {
    const script = document.createElement('script');
    script.textContent = 'globalThis.foreign = true';
    document.body.append(script);
    return Boolean(globalThis.foreign);
  });
  assert.equal(ran, false);
  await close().catch((error) => assert.match(String(error), /Content Security Policy/));
});
