// A phone for tests: the recorder in Chromium, a server, and a simulated drive.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

import { chromium } from 'playwright-core';
import { eventsOf, installPositions, playEvents, readLogFile } from './player.mjs';
import { serveTrips } from './trip_server.mjs';

export const { MACADAM_PROGRAM: program, MACADAM_SITE: site } = process.env;
const source = fileURLToPath(new URL('../../..', import.meta.url));
export const browserOptions = { executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: ['--no-sandbox', '--disable-gpu', '--host-resolver-rules=MAP phone.example 127.0.0.1 , MAP * ~NOTFOUND , EXCLUDE 127.0.0.1'], timeout: 60_000 };
export const folder = mkdtempSync(join(tmpdir(), 'macadam-drive-'));
const recipe = `[trips]
count = 1
length_km = [4, 5]
[gnss]
rate_hz = 1
latency_s = [0.4, 0.4]
[[road]]
iri_mm_per_m = [1.5, 3.5]
[[car]]
id = 'phone-car'
like = 'generic'
wheelbase_m = 2.62
cg_to_front_m = 1.15
sensors = ['acc', 'gyro']
`;

export const patience_ms = 60_000; // of a machine that is busy
export const invitations = ['an-invitation-of-32-letters-0123', 'another-invitation-for-32-letters']; // of two names

export let browser;
export let server;
export let drive; // a simulated drive
export let shortDrive; // its first 2.6 km, of which something is left when the ends are gone

export const macadam = (...words) => execFileSync(program, words, { cwd: folder, encoding: 'utf8', timeout: 120_000, stdio: ['ignore', 'pipe', 'pipe'] });

// The beginning of a drive, by the receiver's speed (1 Hz).
function beginning({ columns, rows }, length_m) {
  const speed = columns.indexOf('gnss_speed_mps');
  let gone_m = 0;
  const past = rows.findIndex((row) => (gone_m += row[speed] ?? 0) > length_m);
  return { columns, rows: rows.slice(0, past) };
}

// A new phone. before: runs in the page ahead of its own script. `complaints` collects what the browser's console objects to, and every request to another host.
export async function phone({ language = 'en-GB', colorScheme = 'light', width = 320, url = server.url, of = browser, before } = {}) {
  const context = await of.newContext({ locale: language, colorScheme, viewport: { width, height: 640 }, acceptDownloads: true });
  const complaints = [];
  await context.addInitScript(installPositions);
  if (before) {
    await context.addInitScript(before);
  }
  const page = await context.newPage();
  page.setDefaultTimeout(patience_ms);
  page.on('console', (message) => message.type() === 'error' && !/Failed to load resource|net::ERR/.test(message.text()) && complaints.push(message.text()));
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('request', (request) => ![new URL(url).hostname, '127.0.0.1'].includes(new URL(request.url()).hostname) && !request.url().startsWith('blob:') && complaints.push(request.url()));
  await page.goto(url);
  return { context, page, complaints };
}

export const tap = (page, name) => page.getByRole('button', { name }).first().click();

export async function getReady(page) {
  await tap(page, 'Understood');
  await tap(page, 'Keep');
  await page.getByRole('button', { name: 'Start trip' }).waitFor(); // by now the car is on the phone's disk
}

export async function start(page) {
  await tap(page, 'Start trip');
  await page.getByRole('button', { name: 'End trip' }).waitFor();
}

export const play = (page, events, options = {}) => page.evaluate(playEvents, { events: JSON.stringify(events), begin_ms: 1000, ...options });

export async function recorded(page, events = eventsOf(shortDrive)) {
  await getReady(page);
  await recordedAgain(page, 1, events);
}

// Records one more trip; count: of those on the phone then.
export async function recordedAgain(page, count, events = eventsOf(shortDrive)) {
  await start(page);
  await play(page, events);
  await tap(page, 'End trip');
  await page.getByRole('button', { name: /^Save file/ }).nth(count - 1).waitFor();
}

export const send = /^Send/;
export const linesOf = (page) => page.locator('ul.trips > li');
export const accept = (page) => page.once('dialog', (dialog) => dialog.accept());
export const tripsAsked = (of) => of.asked.filter((line) => line.includes('/v1/trips/')).map((line) => line.split(' ')[0]);

// Opens the link of an invitation in a page that loads anew.
export async function openLink(page, url, invitation, first = 'Start trip') {
  await page.goto(`${url}?link#invite=${invitation}`);
  await page.getByRole('button', { name: first }).waitFor();
  await until(() => !page.url().includes('#'), 'the invitation is not taken');
}

// A value in the phone's database; without a key: all of its store.
const stored = (page, from, key) => page.evaluate(async ([its, name]) => {
  const open = indexedDB.open('macadam-drive');
  await new Promise((done) => { open.onsuccess = done; });
  const objects = open.result.transaction(its).objectStore(its);
  const found = name ? objects.get(name) : objects.getAll();
  await new Promise((done) => { found.onsuccess = done; });
  open.result.close();
  return found.result;
}, [from, key]);
export const setting = (page, name) => stored(page, 'settings', name);
export const tripsOn = (page) => stored(page, 'trips');

export async function savedFile(page) {
  const [download] = await Promise.all([page.waitForEvent('download'), tap(page, /^Save file/)]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

// Waits until it is so. (Playwright's waitForFunction takes a promise for yes.)
export async function until(isSo, what) {
  for (const end = Date.now() + patience_ms; !(await isSo());) {
    assert.ok(Date.now() < end, what);
    await new Promise((done) => { setTimeout(done, 50); });
  }
}

export async function setUp() {
  writeFileSync(join(folder, 'recipe.toml'), recipe);
  macadam('simulate', '-o', 'fleet', '--network', join(source, 'sample_data/fleet/network.osm.pbf'), '--recipe', 'recipe.toml', '--quiet');
  // Four minutes of driving tell friction to 10 N, or 10 % of the IRI: stated, as simulated, so that what the recorder changes is seen.
  const car = join(folder, 'fleet/vehicles/phone-car.toml');
  writeFileSync(car, readFileSync(car, 'utf8').replace('[half_car]', '[half_car]\nfriction_n = 40'));
  drive = readLogFile(join(folder, 'fleet/trips', readdirSync(join(folder, 'fleet/trips'))[0]));
  shortDrive = beginning(drive, 2600);
  server = await serveTrips(site);
  browser = await chromium.launch(browserOptions);
}

export async function tearDown() {
  await browser?.close();
  server?.close();
  rmSync(folder, { recursive: true, force: true });
}
