// A site of a small simulated fleet, and pages of Debian's Chromium that show it and reach no other host.
import { chromium } from 'playwright-core';
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { databaseIn, macadam } from './simulated.mjs';
import { serve } from './static_server.mjs';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

export { macadam };

export async function world() {
  const folder = mkdtempSync(join(tmpdir(), 'macadam-web-'));
  const database = databaseIn(folder);
  macadam('export', database, '-o', `${folder}/site`, '--format', 'site', '--title', 'Krems <b>&amp;');
  const server = await serve(join(folder, 'site'));
  const options = { executablePath: '/usr/bin/chromium', timeout: 60_000 };
  const noHost = ['--no-sandbox', '--disable-gpu-sandbox', '--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1'];
  const browser = await chromium.launch({ ...options, args: [...noHost, '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] });
  const query = (...words) => JSON.parse(macadam('query', database, ...words, '--json'));

  return {
    server, query, folder, database,
    site: JSON.parse(readFileSync(join(folder, 'site/site.json'), 'utf8')),
    segments: query('--bbox', '-180,-90,180,90'),

    // A page that has drawn its map; without its worker, which answers what a test wants to fail, unless it `keeps` answers.
    // What it asks of other hosts, logs or throws is a failure when it closes.
    async page(hash = '', { width = 1280, height = 800, ready = true, path = '', keeps = false, url = server.url, ...context } = {}) {
      const opened = await browser.newContext({ viewport: { width, height }, locale: 'en-GB', ...context });
      const page = await opened.newPage();
      if (!keeps) await page.addInitScript(() => Object.defineProperty(Navigator.prototype, 'serviceWorker', { value: undefined }));
      page.setDefaultTimeout(100_000);
      const wrong = [];
      page.on('request', (request) => { if (!/^(blob:|data:)/.test(request.url()) && !request.url().startsWith(url)) wrong.push(`asked ${request.url()}`); });
      page.on('pageerror', (error) => wrong.push(String(error)));
      page.on('console', (message) => { if (['error', 'warning'].includes(message.type())) wrong.push(message.text()); });
      if (context.before) await context.before(page);
      await page.goto(url + path + hash);
      const drawn = () => page.waitForSelector('#map[data-ready]');
      if (ready) await drawn();
      return {
        page, wrong, drawn,
        text: (selector) => page.locator(selector).innerText(),
        async close() {
          assert.deepEqual(wrong, []);
          await opened.close();
        },
        // Breaches of axe-core's rules for WCAG 2.2 AA and its best practices.
        async breaches() {
          await page.evaluate(axe);
          const { violations } = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ['violations'] }));
          return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html, any }) => `${html.slice(0, 120)} ${any[0]?.message ?? ''}`).join(' | ')}`);
        },
      };
    },

    async close() {
      await browser.close();
      server.close();
      rmSync(folder, { recursive: true, force: true });
    },
  };
}
