// The recorder in Chromium: from the first visit to a map.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { after, before, describe, it } from 'node:test';

import { chromium } from 'playwright-core';
import {
  accept, browser, browserOptions, drive, folder, getReady, invitations, macadam, patience_ms, phone, play, program,
  recorded, savedFile, server, setUp, setting, shortDrive, site, start, tap, tearDown, until,
} from './phone.mjs';
import { eventsOf, installPositions, readLog } from './player.mjs';
import { serveTrips } from './trip_server.mjs';

const axe = createRequire(import.meta.url).resolve('axe-core/axe.min.js');

// IRI by segment of one log, as `import` reads it.
function iriOf(name, bytes) {
  writeFileSync(join(folder, `${name}.trip.csv`), bytes);
  macadam('init', `${name}.gpkg`, '--network', 'fleet/network.osm.pbf', '--quiet');
  macadam('import', `${name}.gpkg`, `${name}.trip.csv`, '--vehicle', 'fleet/vehicles/phone-car.toml', '--quiet');
  macadam('export', `${name}.gpkg`, '-o', `${name}.csv`, '--quiet');
  const [head, ...rows] = readFileSync(join(folder, `${name}.csv`), 'utf8').trim().split('\n').map((line) => line.split(','));
  const [segment, iri] = ['segment', 'iri'].map((column) => head.indexOf(column));
  return new Map(rows.map((row) => [row[segment], Number(row[iri])]).filter(([, value]) => value > 0));
}

// Mean IRI of the segments that both have, as a ratio, and the median relative difference of single ones.
function compared(found, expected) {
  const both = [...found.keys()].filter((segment) => expected.has(segment));
  const mean = (of) => both.reduce((sum, segment) => sum + of.get(segment), 0) / both.length;
  const apart = both.map((segment) => Math.abs(found.get(segment) / expected.get(segment) - 1)).sort((a, b) => a - b);
  return { count: both.length, ratio: mean(found) / mean(expected), median: apart[both.length >> 1] };
}

const logText = ({ columns, rows }) =>
  `# macadam-trip 1\n# vehicle_id: phone-car\n# t0_utc: 2026-05-01T08:00:00Z\n${[columns.join(','), ...rows.map((row) => row.map((cell) => cell ?? '').join(','))].join('\n')}\n# end rows: ${rows.length}\n`;

// The last motion row (samples.js) in the phone's database; null: it has none.
const lastStored = (page) => page.evaluate(async () => {
  const db = await new Promise((resolve) => { const r = indexedDB.open('macadam-drive'); r.onsuccess = () => resolve(r.result); });
  const chunks = await new Promise((resolve) => { const r = db.transaction('chunks').objectStore('chunks').getAll(); r.onsuccess = () => resolve(r.result); });
  db.close();
  const rows = chunks.filter(({ motion }) => motion.length > 0).map(({ motion }) => Array.from(motion.slice(-10)));
  return rows.sort((a, b) => a[0] - b[0]).at(-1) ?? null;
});

// Ends every process of the browser that has this profile, as a dead battery would.
function kill(home) {
  for (const id of readdirSync('/proc').filter((name) => /^\d+$/.test(name))) {
    try {
      if (readFileSync(`/proc/${id}/cmdline`, 'utf8').includes(`--user-data-dir=${home}`)) {
        process.kill(Number(id), 'SIGKILL');
      }
    } catch { /* it ended meanwhile */ }
  }
}

// That of the drive as a file, worked out once.
let fileValues;
const fileIri = () => (fileValues ??= iriOf('file', logText(drive)));

describe('the recorder in the browser', () => {
  before(setUp);
  after(tearDown);

  it('a drive recorded in the browser has the IRI of the same drive as a file', async () => {
    const { context, page, complaints } = await phone();
    await recorded(page, eventsOf(drive));
    const { name, bytes } = await savedFile(page);
    assert.match(name, /^\d{8}T\d{4}-drive-[0-9a-f]{16}\.trip\.csv$/);
    const browserFile = iriOf('browser', bytes);
    const { count, ratio, median } = compared(browserFile, fileIri());
    console.log(`${count} segments, mean IRI ${(100 * (ratio - 1)).toFixed(2)} %, single ones ${(100 * median).toFixed(2)} % apart`);
    assert.ok(count > 60, `${count} segments in common`);
    assert.ok(Math.abs(ratio - 1) < 0.03, `${ratio}`);
    assert.ok(median < 0.03, `${median}`);
    // 300 m and more are gone at both ends: no position is near the first or the last
    const fixes = (log) => log.rows.map((row) => [row[log.columns.indexOf('lat_deg')], row[log.columns.indexOf('lon_deg')]]).filter(([lat]) => lat !== null);
    const apart_m = ([a, b], [c, d]) => Math.hypot(111_195 * (a - c), 111_195 * Math.cos((a * Math.PI) / 180) * (b - d));
    const [whole, left] = [fixes(drive), fixes(readLog(bytes))];
    assert.ok(apart_m(left[0], whole[0]) > 300 && apart_m(left.at(-1), whole.at(-1)) > 300);
    assert.deepEqual(complaints, []);
    await context.close();
  });

  it('a browser with 60 readings per second, rounded to 0.1 m/s2, is good enough', async () => {
    const { context, page } = await phone();
    await recorded(page, eventsOf(drive, { step: 1 / 61, quantum_mps2: 0.1 }));
    const { ratio, median, count } = compared(iriOf('rounded', (await savedFile(page)).bytes), fileIri());
    console.log(`${count} segments, mean IRI ${(100 * (ratio - 1)).toFixed(2)} %, single ones ${(100 * median).toFixed(2)} % apart`);
    assert.ok(Math.abs(ratio - 1) < 0.05, `${ratio}`);
    await context.close();
  });

  it('the import into a crowd\u2019s database trims no second time, and takes the car that was told', async () => {
    const { context, page } = await phone();
    await tap(page, 'Understood');
    await page.getByLabel('Kind of car').selectOption('compact');
    await page.getByLabel(/^Mass/).fill('1430');
    await page.getByLabel(/^Wheelbase/).fill('26');
    await tap(page, 'Keep');
    await page.getByText('The wheelbase of such a car is 2.35 to 2.90 m.').waitFor();
    await page.getByLabel(/^Wheelbase/).fill('2.62');
    await tap(page, 'Keep');
    await start(page);
    await play(page, eventsOf(shortDrive));
    await tap(page, 'End trip');
    writeFileSync(join(folder, 'crowd.trip.csv'), (await savedFile(page)).bytes);
    macadam('init', 'crowd.gpkg', '--network', 'fleet/network.osm.pbf', '--privacy', 'crowd', '--quiet');
    const report = JSON.parse(macadam('import', 'crowd.gpkg', 'crowd.trip.csv', '--json').trim().split('\n')[0]);
    assert.equal(report.result, 'imported');
    assert.equal(report.vehicle, 'compact');
    assert.ok(!('trimmed' in report.reasons), JSON.stringify(report.reasons));
    assert.ok(!report.warnings.some((warning) => /were removed|^car/.test(warning)), report.warnings.join());
    await context.close();
  });

  it('a drive goes from the phone to the map: by an invitation, to a real server, which imports it', async () => {
    const cars = join(folder, 'cars');
    mkdirSync(cars);
    macadam('init', 'way.gpkg', '--network', 'fleet/network.osm.pbf', '--privacy', 'crowd', '--quiet');
    const real = spawn(program, ['serve', 'way.gpkg', '--listen', '127.0.0.1:0', '--vehicles', cars], { cwd: folder, stdio: ['ignore', 'ignore', 'pipe'] });
    try {
      const base = await new Promise((found, failed) => {
        let said = '';
        real.stderr.on('data', (text) => { said += text; const [, url] = /serving on (http:\S+\/);/.exec(said) ?? []; url && found(url); });
        real.on('exit', () => failed(new Error('the server ended')));
      });
      const invite = macadam('token', 'invite', 'way.gpkg', 'ada', '--url', base, '--quiet').trim();
      const { context, page, complaints } = await phone({ url: invite });
      await recorded(page, eventsOf(drive));
      const { bytes } = await savedFile(page);
      const [, id] = /# vehicle_id: (\S+)/.exec(bytes.toString());
      writeFileSync(join(cars, `${id}.toml`), readFileSync(join(folder, 'fleet/vehicles/phone-car.toml'), 'utf8').replace('"phone-car"', `"${id}"`));
      await tap(page, /^Send/);
      await page.getByText(/Received by the server and deleted here|Evaluated/).first().waitFor();
      const token = await setting(page, 'token');
      let fate;
      for (const end = Date.now() + 120_000; !fate || ['queued', 'working'].includes(fate.state);) {
        assert.ok(Date.now() < end, 'not imported in two minutes');
        await new Promise((done) => { setTimeout(done, 200); });
        const answer = await fetch(new URL('v1/trips', base), { headers: { Authorization: `Bearer ${token}` } });
        fate = (await answer.json()).trips[0];
      }
      assert.equal(fate.state, 'imported');
      await page.getByText(`Evaluated. Road segments of about 20 m: ${fate.passes}.`).waitFor();
      const [head, ...rows] = macadam('query', 'way.gpkg', '--bbox=-180,-90,180,90', '--format', 'csv').trim().split('\n').map((line) => line.split(','));
      const [segment, iri] = ['segment', 'iri'].map((column) => head.indexOf(column));
      const { count, ratio } = compared(new Map(rows.map((row) => [row[segment], Number(row[iri])]).filter(([, value]) => value > 0)), fileIri());
      console.log(`${count} segments, mean IRI ${(100 * (ratio - 1)).toFixed(2)} % apart after the upload`);
      assert.ok(count > 60, `${count} segments in common`);
      assert.ok(Math.abs(ratio - 1) < 0.03, `${ratio}`);
      await until(() => readdirSync(join(folder, 'way.gpkg.uploads/spool')).length === 0, 'the log is not erased');
      page.once('dialog', (dialog) => dialog.accept());
      await tap(page, /^Delete at the server/);
      await page.getByText(/^Deleted at the server/).waitFor();
      assert.deepEqual(complaints, []);
      await context.close();
    } finally {
      real.kill('SIGKILL');
    }
  });

  it('a killed browser loses at most five seconds of a trip, and the trip goes on', async () => {
    const home = mkdtempSync(join(folder, 'home-'));
    const open = async () => {
      const context = await chromium.launchPersistentContext(home, { ...browserOptions, viewport: { width: 320, height: 640 }, locale: 'en-GB', acceptDownloads: true });
      await context.addInitScript(installPositions);
      const page = context.pages()[0] ?? await context.newPage();
      page.setDefaultTimeout(patience_ms);
      await page.goto(server.url);
      return { context, page };
    };
    const events = eventsOf(shortDrive);
    const half = events.findIndex(([t_s]) => t_s > 235); // is kept, whatever is drawn
    let { context, page } = await open();
    await getReady(page);
    await start(page);
    const begun_ms = await page.evaluate(() => performance.timeOrigin);
    await play(page, events.slice(0, half), { pause_ms: 20 });
    const lost_s = async () => events[half - 1][0] - (((await lastStored(page))?.[0] ?? -Infinity) - begun_ms - 1000) / 1000;
    await until(async () => (await lost_s()) < 5, 'what the drive brought is not stored');
    kill(home);
    await context.close().catch(() => {});
    rmSync(join(home, 'SingletonLock'), { force: true });
    ({ context, page } = await open());
    await page.getByText('A trip was interrupted').waitFor();
    assert.ok((await lost_s()) < 5, `${await lost_s()} s`);
    await tap(page, 'Go on recording');
    await page.getByRole('button', { name: 'End trip' }).waitFor();
    const shift_ms = begun_ms - await page.evaluate(() => performance.timeOrigin);
    await play(page, events.slice(half), { begin_ms: 1000 + shift_ms });
    await tap(page, 'End trip');
    const { bytes } = await savedFile(page);
    const t_s = readLog(bytes).rows.map((row) => row[0]);
    const from_ms = Date.parse(/t0_utc: (\S+)/.exec(bytes.toString())[1]);
    const seam_ms = begun_ms + 1000 + 1000 * events[half][0];
    assert.ok(from_ms < seam_ms && seam_ms < from_ms + 1000 * t_s.at(-1), 'the log holds what was before and after');
    assert.ok(Math.max(...t_s.slice(1).map((t, i) => t - t_s[i])) < 5);
    await context.close();
  });

  it('the page opens without a network once it was seen', async () => {
    const { context, page } = await phone();
    await page.evaluate(() => navigator.serviceWorker.ready);
    await until(() => page.evaluate(async () => (await (await caches.open('macadam-drive')).keys()).length >= 7), 'the page is not kept');
    await context.setOffline(true);
    await page.reload();
    await page.getByRole('heading', { name: 'Before the first trip' }).waitFor();
    await context.close();
  });

  it('the browser\u2019s own sensors are understood, and faults are told in words', async () => {
    const real = await browser.newContext({ locale: 'en-GB', permissions: ['geolocation', 'accelerometer', 'gyroscope', 'magnetometer'], geolocation: { latitude: 48.41, longitude: 15.6, accuracy: 65 } });
    const live = await real.newPage();
    live.setDefaultTimeout(patience_ms);
    await live.goto(server.url);
    const cdp = await real.newCDPSession(live);
    const sensors = ['accelerometer', 'linear-acceleration', 'gyroscope'];
    const set = (type, xyz) => cdp.send('Emulation.setSensorOverrideReadings', { type, reading: { xyz } });
    for (const type of sensors) {
      await cdp.send('Emulation.setSensorOverrideEnabled', { enabled: true, type, metadata: { available: true, minimumFrequency: 1, maximumFrequency: 100 } });
    }
    await set('accelerometer', { x: 0, y: 2.04, z: 9.6 });
    await set('linear-acceleration', { x: 0, y: 0, z: 0 });
    await set('gyroscope', { x: 0, y: 0, z: 0 });
    await getReady(live);
    await start(live);
    await live.getByText('The position is only good to 65 m').waitFor();
    await live.getByText('tilt 12°, steady').waitFor();
    // 60 readings a second, of which a busy machine loses some
    await live.waitForFunction(() => { const rate = Number.parseInt(document.querySelector('#figure-rate').textContent, 10); return rate >= 20 && rate <= 70; });
    await set('gyroscope', { x: 1, y: 0, z: 0 });
    await live.getByText('The phone is loose or in the hand').waitFor();
    let turn;
    await until(async () => (turn = (await lastStored(live))?.slice(1))?.[6] > 0.5, 'the turn is not stored');
    // Chromium rounds to 0.1 m/s2 and 0.1 degree/s
    [0, 2.0, 9.6, 0, 0, 0, 1, 0, 0].forEach((expected, i) => assert.ok(Math.abs(turn[i] - expected) < 0.06, `${turn}`));
    await real.close();
  });

  it('where a phone asks by a tap, as iOS does, a refusal is told and a leave begins the trip', async () => {
    const { context, page } = await phone();
    await getReady(page);
    await page.evaluate(() => {
      globalThis.asked = [];
      for (const type of [DeviceMotionEvent, DeviceOrientationEvent]) {
        type.requestPermission = async () => {
          globalThis.asked.push(navigator.userActivation.isActive);
          return globalThis.asked.length > 2 ? 'granted' : 'denied';
        };
      }
    });
    await tap(page, 'Start trip');
    await page.getByText('This phone gave no leave to read its sensors.').waitFor();
    await start(page);
    assert.deepEqual(await page.evaluate(() => globalThis.asked), [true, true, true, true]);
    await context.close();
  });

  it('two pages never record at once, and one that ends its trip lets the other record', async () => {
    const { context, page, complaints } = await phone();
    await getReady(page);
    await start(page);
    const second = await context.newPage();
    second.setDefaultTimeout(patience_ms);
    await second.goto(server.url);
    await tap(second, 'Start trip');
    await second.getByText('Another page records already.').waitFor();
    await tap(page, 'End trip');
    await page.getByRole('button', { name: 'Start trip' }).waitFor();
    // the notice of the try before is gone at once
    const said = await second.getByRole('button', { name: 'Start trip' }).evaluate((button) => { button.click(); return document.getElementById('notice').textContent; });
    assert.equal(said, '');
    await second.getByRole('button', { name: 'End trip' }).waitFor();
    await tap(page, 'Start trip');
    await page.getByText('Another page records already.').waitFor();
    assert.deepEqual(complaints, []);
    await context.close();
  });

  it('a leave to read positions that is withdrawn during the drive is told until positions come again', async () => {
    const { context, page } = await phone();
    await getReady(page);
    await start(page);
    const told = page.getByText('does not give leave to read its position');
    const [, fix] = eventsOf(shortDrive).filter(([, kind]) => kind === 1);
    await page.evaluate(() => globalThis.played.error({ code: 1 }));
    await told.waitFor();
    await play(page, [fix]);
    await told.waitFor({ state: 'detached' });
    await page.evaluate(() => globalThis.played.error({ code: 3 })); // a gap of the receiver
    await page.evaluate(() => globalThis.played.error({ code: 1 }));
    await told.waitFor();
    await context.close();
  });

  it('without https it says what is missing', async () => {
    const insecure = server.url.replace('127.0.0.1', 'phone.example');
    const { context, page, complaints } = await phone({ url: insecure });
    await getReady(page);
    await tap(page, 'Start trip');
    await page.getByText('open this page by https').waitFor();
    assert.deepEqual(complaints, []);
    await context.close();
  });

  for (const [language, colorScheme] of [['en-GB', 'light'], ['de-AT', 'dark']]) {
    it(`every view passes axe, fits 320 px and works by keys alone: ${language}, ${colorScheme}`, async () => {
      const closed = await serveTrips(site, { invitations });
      const { context, page, complaints } = await phone({ language, colorScheme, url: `${closed.url}#invite=${invitations[0]}` });
      const words = (en, de) => (language.startsWith('de') ? de : en);
      const axeSource = readFileSync(axe, 'utf8');
      const look = async (name) => {
        await page.evaluate(axeSource);
        const { violations } = await page.evaluate(() => globalThis.axe.run(document, { runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa', 'wcag22aa', 'best-practice'] }));
        assert.deepEqual(violations.map((found) => `${name}: ${found.id} ${found.nodes[0].html}`), []);
        const sizes = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth, ...[...document.querySelectorAll('button, select, input[type=text]')].map((e) => e.getBoundingClientRect().height)]);
        assert.ok(sizes[0] <= sizes[1], `${name}: ${sizes[0]} px wide`);
        assert.ok(sizes.slice(2).every((height) => height >= 44), `${name}: ${sizes.slice(2)}`);
        if (process.env.MACADAM_SHOTS) {
          await page.screenshot({ path: join(process.env.MACADAM_SHOTS, `${name}-${language}-${colorScheme}.png`), fullPage: true });
        }
      };
      // Tabs to a button and presses it.
      const press = async (name) => {
        const wanted = page.getByRole('button', { name }).first();
        await wanted.waitFor();
        for (let i = 0; i < 30 && !(await wanted.evaluate((e) => e === document.activeElement)); ++i) {
          await page.keyboard.press('Tab');
        }
        assert.ok(await wanted.evaluate((e) => e === document.activeElement), String(name));
        await page.keyboard.press('Enter');
      };
      await page.getByRole('button', { name: words('Understood', 'Verstanden') }).waitFor();
      await look('privacy');
      await press(words('Understood', 'Verstanden'));
      await page.getByLabel(words('Kind of car', 'Art des Autos')).waitFor();
      await look('car');
      await press(words('Keep', 'Behalten'));
      await page.getByRole('button', { name: words('Start trip', 'Fahrt beginnen') }).waitFor();
      await look('home');
      await press(words('Start trip', 'Fahrt beginnen'));
      await page.getByRole('button', { name: words('End trip', 'Fahrt beenden') }).waitFor();
      await play(page, eventsOf(shortDrive));
      await page.waitForFunction(() => /^[1-9]\d*:/.test(document.querySelector('#figure-time').textContent)); // the figures are drawn
      await look('recording');
      await press(words('End trip', 'Fahrt beenden'));
      await page.getByRole('button', { name: words(/^Save file/, /^Datei sichern/) }).waitFor();
      await look('trips');
      await press(words(/^Send/, /^Senden/));
      await page.getByText(words('Received by the server', 'Vom Server empfangen')).waitFor();
      await look('received');
      closed.fates.set([...closed.trips.keys()][0], { state: 'refused', reason: 'row 17: acc_z_mps2 is 4e9, expected at most 200' });
      closed.trips.set('0'.repeat(64), Buffer.from('of another phone'));
      closed.owners.set('0'.repeat(64), invitations[0]);
      closed.fates.set('0'.repeat(64), { state: 'imported', passes: 1234 });
      await page.reload();
      await page.getByText(words('The server could not use it', 'Der Server konnte sie nicht verwenden')).waitFor();
      await look('fates');
      accept(page);
      await press(words(/^Delete at the server/, /^Auf dem Server löschen/));
      await page.getByText(words(/^Deleted at the server/, /^Auf dem Server gelöscht/)).waitFor();
      await look('deleted');
      assert.deepEqual(complaints, []);
      await context.close();
      closed.close();
    });
  }
});
