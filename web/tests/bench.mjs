// What the page costs for a large network, beside a plain page with one GeoJSON: node bench.mjs SITE_FOLDER ROADS.geojson
// Prints rows of a table. Chromium draws maps by software here, and puts pages together without a graphics card as it does
// by itself (its --disable-gpu), or by the same software as maps; answers are gzipped, as hosts do.
import { chromium } from 'playwright-core';
import { copyFileSync, mkdirSync, readFileSync, symlinkSync, rmSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { serve } from './static_server.mjs';

const [site, geojson] = process.argv.slice(2).map((each) => resolve(each));
const waits = 120_000; // ms
const slowed = 4; // times
const withoutCard = ['--disable-gpu'];
const allByAngle = ['--use-gl=angle', '--use-angle=swiftshader'];

// The peer: the same library, the same lines and colours, all of it as one file.
function plainPage(folder) {
  const { bounds, classes } = JSON.parse(readFileSync(join(site, 'site.json'), 'utf8'));
  mkdirSync(folder, { recursive: true });
  for (const name of ['maplibre-gl.mjs', 'maplibre-gl-worker.mjs', 'maplibre-gl.css']) copyFileSync(join(site, 'assets', name), join(folder, name));
  rmSync(join(folder, 'roads.geojson'), { force: true });
  symlinkSync(geojson, join(folder, 'roads.geojson'));
  const colour = ['match', ['get', 'class'], ...classes.flatMap(({ name, colour: value }) => [name, value]), '#999'];
  writeFileSync(join(folder, 'index.html'), `<!doctype html><link rel="stylesheet" href="maplibre-gl.css"><style>#map{position:absolute;inset:0}</style><div id="map"></div><script type="module">
import * as maplibre from './maplibre-gl.mjs';
const map = new maplibre.Map({container: 'map', bounds: ${JSON.stringify(bounds)}, fadeDuration: 0, style: {version: 8, sources: {roads: {type: 'geojson', data: new URL('roads.geojson', location.href).href}},
  layers: [{id: 'roads', type: 'line', source: 'roads', paint: {'line-color': ${JSON.stringify(colour)}, 'line-width': 2}}]}});
globalThis.map = map;
map.on('idle', () => { if (map.isSourceLoaded('roads') && map.queryRenderedFeatures().length > 0) document.getElementById('map').dataset.ready = 'yes'; });
</script>`);
  return folder;
}

// Seconds of CPU that a kind of Chromium's processes took.
async function cpuOf(browser, kind) {
  const session = await browser.newBrowserCDPSession();
  const { processInfo } = await session.send('SystemInfo.getProcessInfo');
  return processInfo.filter(({ type }) => type === kind).reduce((sum, { cpuTime }) => sum + cpuTime, 0);
}

async function memory(browser) {
  const session = await browser.newBrowserCDPSession();
  const { processInfo } = await session.send('SystemInfo.getProcessInfo');
  const mb = processInfo.filter(({ type }) => type === 'renderer').map(({ id }) => Number(/^Pss:\s+(\d+)/m.exec(readFileSync(`/proc/${id}/smaps_rollup`, 'utf8'))[1]) / 1024);
  return Math.max(...mb);
}

const browsers = []; // open ones, also after a failure

async function open(server, drawing, hash = '') {
  const args = ['--no-sandbox', '--disable-gpu-sandbox', '--enable-unsafe-swiftshader', ...drawing];
  const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args, timeout: 60_000 });
  browsers.push(browser);
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  await page.addInitScript(() => {
    new MutationObserver(() => { if (globalThis.drawnMs === undefined && document.querySelector('#map[data-ready]')) globalThis.drawnMs = performance.now(); })
      .observe(document, { subtree: true, childList: true, attributes: true });
    document.addEventListener('load', ({ target }) => { if (target.className === 'first-picture') requestAnimationFrame(() => { globalThis.pictureMs = performance.now(); }); }, { capture: true });
  });
  const session = await page.context().newCDPSession(page);
  if (!hash) await session.send('Emulation.setCPUThrottlingRate', { rate: slowed });
  server.sent.bytes = 0;
  await page.goto(server.url + hash);
  await page.waitForFunction(() => globalThis.drawnMs !== undefined, undefined, { timeout: waits });
  return { browser, page, ms: await page.evaluate(() => globalThis.drawnMs), pictureMs: await page.evaluate(() => globalThis.pictureMs ?? globalThis.drawnMs), bytes: server.sent.bytes };
}

// While the map is dragged to and fro: frames a second, and milliseconds of CPU a frame in the page and in the process that draws.
async function panning(browser, page) {
  const box = await page.locator('#map canvas').first().boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.evaluate(() => {
    globalThis.frames = 0;
    const count = () => { globalThis.frames += 1; requestAnimationFrame(count); };
    requestAnimationFrame(count);
  });
  const session = await page.context().newCDPSession(page);
  await session.send('Performance.enable');
  const taken = async () => {
    const { metrics } = await session.send('Performance.getMetrics');
    const [ms, frames] = await page.evaluate(() => [performance.now(), globalThis.frames]);
    return { ms, frames, page: 1000 * metrics.find(({ name }) => name === 'TaskDuration').value, drawing: 1000 * await cpuOf(browser, 'GPU') };
  };
  await page.mouse.move(x, y);
  await page.mouse.down();
  const begin = await taken();
  for (let i = 1; i <= 120; ++i) {
    await page.mouse.move(x + 260 * Math.sin(i / 12), y + 160 * Math.sin(i / 19));
    await page.waitForTimeout(16);
  }
  const end = await taken();
  await page.mouse.up();
  const frames = end.frames - begin.frames;
  const [rate, ...costs] = [frames / (end.ms - begin.ms) * 1000, (end.page - begin.page) / frames, (end.drawing - begin.drawing) / frames];
  return `${rate.toFixed(0)} (${costs.map((each) => each.toFixed(0)).join(' + ')} ms)`;
}

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

async function measured(name, folder, drawing, hashes, turns) {
  const server = await serve(folder, { gzip: true });
  const starts = [];
  const frames = [];
  let most = 0;
  let failed = '';
  try {
    for (let i = 0; i < turns; ++i) {
      const { browser, ms, pictureMs, bytes } = await open(server, drawing);
      starts.push({ ms, pictureMs, mb: bytes / 1e6 });
      await browser.close();
    }
    for (const hash of hashes) {
      const { browser, page } = await open(server, drawing, hash);
      if (hash === '#plain') await page.evaluate(() => globalThis.map.setZoom(14));
      await page.waitForTimeout(1000);
      frames.push(await panning(browser, page));
      await page.waitForTimeout(2000);
      most = Math.max(most, await memory(browser));
      await browser.close();
    }
  } catch (error) {
    failed = String(error.message).split('\n')[0];
  } finally {
    await Promise.all(browsers.splice(0).map((each) => each.close()));
    server.close();
  }
  const first = turns === 0 ? ['', ''] : starts.length > 0 ? [`${['pictureMs', 'ms'].map((key) => (median(starts.map((each) => each[key])) / 1000).toFixed(2)).join(', ')} s`, `${median(starts.map(({ mb }) => mb)).toFixed(2)} MB`] : [`none in ${waits / 1000} s`, ''];
  console.log(`| ${[name, ...first, failed || frames.join(', '), most > 0 ? `${most.toFixed(0)} MB` : ''].join(' | ')} |`);
}

const { classes, bounds: [west, south, east, north] } = JSON.parse(readFileSync(join(site, 'site.json'), 'utf8'));
const at = (zoom) => `#map=${zoom}/${(south + north) / 2}/${(west + east) / 2}`;
const views = [at(11), at(13), at(15), `${at(15)}&c=${classes.map(({ name }) => name)}`];
await measured('the page', site, withoutCard, views, 3);
await measured('the same, all by SwiftShader', site, allByAngle, views, 0);
if (geojson) await measured('one GeoJSON', plainPage(join(site, '../plain')), withoutCard, ['#plain'], 1);
