// The page of a queue in Chromium, with a server that answers what a test says.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { after, before, describe, it } from 'node:test';

import { chromium } from 'playwright-core';
import { catalogues } from '../src/queue/words.js';
import { serve } from './static_server.mjs';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
const patience_ms = 60_000; // of a machine that is busy

const state = (queued) => ({
  read: '2026-05-01T10:00:00Z',
  queue: {
    logs: { queued, working: 12, imported: 40_212, known: 3, outside: 4, refused: 5, parked: 1 },
    oldest_s: 312.2, accepted_in_minute: 4, accepted_in_hour: 200, finished_in_minute: 3, finished_in_hour: 180, passes_in_hour: 90_000,
    chunks_to_fuse: 12, objects: '/srv/roads/logs',
    workers: [
      { name: 'node1/12/0badcafe', alive: true, version: 7, seen_s: 3.1, jobs: 2, working: 8, finished: 120 },
      { name: 'node2/17/1badcafe', alive: false, version: 7, seen_s: 400, jobs: 2, working: 3, finished: 10 },
    ],
    failed: [{ sha256: 'a'.repeat(64), state: 'parked', attempts: 5, at: '2026-05-01T09:00:00Z', reason: 'not fetched <b>' }],
  },
});

describe('the page of the queue', { timeout: 10 * patience_ms }, () => {
  let server;
  let browser;
  before(async () => {
    server = await serve(process.env.MACADAM_SITE);
    browser = await chromium.launch({
      executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', timeout: patience_ms,
      args: ['--no-sandbox', '--disable-gpu', '--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1'],
    });
  });
  after(async () => {
    await browser?.close();
    server?.close();
  });

  // answer(): status and body of the server's next answer.
  async function opened(answer, context = {}) {
    const page = await (await browser.newContext({ locale: 'en-GB', ...context })).newPage();
    page.setDefaultTimeout(patience_ms);
    const wrong = [];
    page.on('pageerror', (error) => wrong.push(String(error)));
    page.on('request', (request) => { if (!request.url().startsWith(server.url)) wrong.push(request.url()); });
    page.on('console', (message) => { if (/Content Security Policy/.test(message.text())) wrong.push(message.text()); });
    await page.route('**/queue/status', (route) => {
      const { status = 200, body } = answer();
      return route.fulfill({ status, contentType: 'application/json', body: JSON.stringify(body) });
    });
    await page.goto(`${server.url}queue/`);
    return { page, wrong };
  }

  it('shows what waits, who works and what failed, and follows it without drawing anew', async () => {
    let queued = 7;
    const { page, wrong } = await opened(() => ({ body: state(queued) }));
    const waiting = page.locator('dd').first();
    await page.getByText('node1/12/0badcafe').waitFor();
    assert.equal(await waiting.innerText(), '7');
    const text = await page.locator('main').innerText();
    for (const part of ['5 min', 'imports 8 logs, 2 at a time', 'gives no sign', 'not fetched <b>', '40,212']) assert.ok(text.includes(part), part);
    await page.evaluate(() => { globalThis.cell = document.querySelector('td'); });
    queued = 9;
    await page.waitForFunction(() => document.querySelector('dd').textContent === '9');
    assert.ok(await page.evaluate(() => globalThis.cell === document.querySelector('td')));
    assert.deepEqual(wrong, []);
  });

  it('keeps what it showed while the database cannot be read, and says so', async () => {
    let answer = { body: state(7) };
    const { page } = await opened(() => answer);
    await page.getByText('node1/12/0badcafe').waitFor();
    answer = { status: 503, body: { detail: 'the database cannot be read now' } };
    await page.getByText('the database cannot be read now').waitFor();
    assert.equal(await page.locator('dd').first().innerText(), '7');
    answer = { body: state(8) };
    await page.waitForFunction(() => document.querySelector('#notice').textContent === '');
  });

  it('shows nothing to a token that does not suffice', async () => {
    const { page } = await opened(() => ({ status: 403, body: { detail: 'for operators' } }));
    await page.getByText('This is for tokens of scope operator.').waitFor();
    assert.ok(await page.locator('main').isHidden());
  });

  for (const colorScheme of ['light', 'dark']) {
    it(`fits 320 pixels in German and has no barrier, ${colorScheme}`, async () => {
      const { page } = await opened(() => ({ body: state(7) }), { locale: 'de-AT', colorScheme, viewport: { width: 320, height: 640 } });
      await page.getByRole('heading', { name: 'Warteschlange' }).waitFor();
      await page.getByText('node1/12/0badcafe').waitFor();
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= 320);
      await page.evaluate(axe);
      const { violations } = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ['violations'] }));
      assert.deepEqual(violations.map(({ id }) => id), []);
    });
  }

  it('has the same words in both languages', () => {
    assert.deepEqual(Object.keys(catalogues.de), Object.keys(catalogues.en));
  });
});
