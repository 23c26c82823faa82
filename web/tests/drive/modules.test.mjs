// The recorder's functions, without a browser.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';

import { carBodies, parseCar } from '../../src/drive/car.js';
import { Odometer } from '../../src/drive/odometer.js';
import { placeOf } from '../../src/drive/places.js';
import { QualityWatch } from '../../src/drive/quality.js';
import { Recording, joined } from '../../src/drive/recording.js';
import { motionRow, rowsOf, upBy } from '../../src/drive/samples.js';
import { mergedTrips } from '../../src/drive/sending/server_trips.js';
import { fixTimes_ms, keptTimes } from '../../src/drive/trimming.js';
import { tripLog } from '../../src/drive/trip_log.js';
import { isTooLarge, sendQueued } from '../../src/drive/trips.js';
import { deleteAtServer, listAtServer, maxUpload_bytes, sendTrip } from '../../src/drive/sending/upload.js';
import { catalogues, wordsOf } from '../../src/drive/words.js';

const lat_m = 111195; // metres per degree on the sphere, to 1e-5
const home = { lat: 47.5, lon: 19 };
const t0_ms = Date.UTC(2026, 4, 1, 8);
const speed_mps = 10;

// Fixes each second along { x, y } in metres from home; each part is [seconds, (s) => { x, y }].
function drive(...parts) {
  const rows = [];
  let s = 0;
  for (const [seconds, place] of parts) {
    for (let i = 0; i < seconds; ++i, ++s) {
      const at = place?.(i);
      if (at) {
        const lat = home.lat + at.y / lat_m;
        rows.push([t0_ms + 1000 * s, t0_ms + 1000 * s, lat, home.lon + at.x / (lat_m * Math.cos((home.lat * Math.PI) / 180)), 5, NaN, NaN, speed_mps, 90]);
      }
    }
  }
  return Float64Array.from(rows.flat());
}
const east = (from_m) => (s) => ({ x: from_m + speed_mps * s, y: 0 });
const stand = (x) => () => ({ x, y: 0 });
const seconds = (kept) => kept.map((part) => part.map((t_ms) => (t_ms - t0_ms) / 1000));
const half = [0.5];

function motion(n, step_ms = 10, force = [0, 0, 9.81], turn = [0, 0, 0]) {
  return Float64Array.from(Array.from({ length: n }, (_, i) => [t0_ms + step_ms * i, ...force, NaN, NaN, NaN, ...turn]).flat());
}

test('a trip loses the drawn length at both ends, by air', () => {
  // 300 + 100 m, 10 m of error and 5 m of accuracy, at 10 m/s; the receiver may be 3 s late at the far end
  assert.deepEqual(seconds(keptTimes(drive([200, east(0)]), half)), [[42, 199 - 42 - 3]]);
  assert.deepEqual(seconds(keptTimes(drive([200, east(0)]), [0])), [[32, 199 - 32 - 3]]);
});

test('a road that winds near home shows nothing of it', () => {
  const around = (s) => ({ x: 200 * Math.cos(s / 20), y: 200 * Math.sin(s / 20) }); // 1,000 m within 400 m of the start
  const [[from]] = seconds(keptTimes(drive([100, around], [200, (s) => ({ x: 200 + 10 * s, y: 0 })]), half));
  assert.ok(from > 100, `${from}`);
});

test('a stop of more than five minutes is left out with both its sides', () => {
  const parts = keptTimes(drive([150, east(0)], [310, stand(1500)], [150, east(1500)]), half);
  assert.equal(parts.length, 2);
  const [first, second] = seconds(parts);
  assert.ok(first[1] < 150 - 40 && second[0] > 460 + 40, `${first} ${second}`);
});

test('a stop at a light stays, and so does a silence under five minutes', () => {
  assert.equal(keptTimes(drive([150, east(0)], [120, stand(1500)], [150, east(1500)]), half).length, 1);
  assert.equal(keptTimes(drive([150, east(0)], [280, null], [150, east(3000)]), half).length, 1);
});

test('a silence of more than five minutes counts as a stop', () => {
  assert.equal(keptTimes(drive([150, east(0)], [310, null], [150, east(3000)]), half).length, 2);
});

test('a receiver that jumps does not hide a stop', () => {
  const jumping = (s) => ({ x: 1500, y: s % 100 === 50 ? 60 : 0 }); // a car could have gone there and back
  assert.equal(keptTimes(drive([150, east(0)], [310, jumping], [150, east(1500)]), half).length, 2);
});

test('a trip that begins with the place of yesterday shows nothing of today\u2019s', () => {
  const stale = drive([1, stand(-9000)], [199, east(0)]);
  assert.deepEqual(seconds(keptTimes(stale, half)), [[43, 199 - 42 - 3]]); // 400 m from x = 0, as after any begin
});

const lengthOf = (fixes) => {
  const odometer = new Odometer();
  for (const row of rowsOf(fixes, 9)) {
    odometer.add(placeOf(row, row[0]));
  }
  return odometer.length_m;
};

test('jumps of the receiver are no distance', () => {
  const until = 1990 - 11; // a step of 10 m may be left
  const near = (length_m) => assert.ok(length_m > until && length_m < 2001, `${length_m}`);
  near(lengthOf(drive([200, east(0)])));
  for (const jump of [1, 2]) { // fixes in a row
    near(lengthOf(drive([100, east(0)], [jump, stand(5000)], [100 - jump, east(1000 + speed_mps * jump)])));
  }
  near(lengthOf(drive([5, stand(-9000)], [200, east(0)])));
  assert.equal(lengthOf(drive([100, (s) => ({ x: 3 * Math.cos(s), y: 3 * Math.sin(s) })])), 0); // parked
});

test('a tunnel is distance, a silence in which the log is cut is none', () => {
  assert.ok(lengthOf(drive([50, east(0)], [100, null], [50, east(1500)])) > 1990 - 11);
  assert.ok(lengthOf(drive([50, east(0)], [310, null], [50, east(3600)])) < 2 * 490 + 1);
});

test('of a short trip, and of one without a good position, nothing is kept', () => {
  assert.deepEqual(keptTimes(drive([80, east(0)]), half), []);
  assert.deepEqual(keptTimes(new Float64Array(0), half), []);
  const poor = drive([200, east(0)]);
  for (let i = 4; i < poor.length; i += 9) {
    poor[i] = 80;
  }
  assert.deepEqual(keptTimes(poor, half), []);
});

test('fixes take the sensors\u2019 clock, whatever the receiver\u2019s clock says', () => {
  const fixes = drive([20, east(0)]);
  for (let i = 0; i < fixes.length; i += 9) {
    fixes[i] += 250; // arrives a quarter of a second later,
    fixes[i + 1] -= 5000; // by a clock that is 5 s slow
  }
  fixes[9 * 3] = NaN; // the sensors were silent
  assert.deepEqual(fixTimes_ms(fixes), Array.from({ length: 20 }, (_, s) => t0_ms + 1000 * s + 250));
});

const meta = { trip_id: 'drive-1', vehicle_id: 'web-2', car: { body: 'compact', mass_kg: 1430, wheelbase_m: 2.62 }, device: 'Phone\n1', draws: half };

test('the log is a macadam-trip 1 that states its trimming and its car', () => {
  const log = tripLog({ motion: motion(20000, 10, [0.1, -0.2, 9.8], [0.01, 0, NaN]), fixes: drive([200, east(0)]), upright: 1 }, meta);
  const lines = log.parts.join('').split('\n');
  assert.deepEqual(lines.slice(0, 16), [
    '# macadam-trip 1', '# trip_id: drive-1', '# vehicle_id: web-2', '# t0_utc: 2026-05-01T08:00:42.000Z', '# frame: sensor',
    '# gravity: included', '# mount: auto', '# speed_source: gnss', '# trimmed_m: 300', '# car_body: compact', '# car_mass_kg: 1430',
    '# car_wheelbase_m: 2.62', '# recorder: macadam drive 1', '# device: Phone 1',
    't_s,acc_x_mps2,acc_y_mps2,acc_z_mps2,gyro_x_radps,gyro_y_radps,lat_deg,lon_deg,hacc_m,gnss_speed_mps,course_deg,gnss_utc_s',
    '0.000000,0.10000,-0.20000,9.80000,0.010000,0.000000,47.50000000,19.00559089,5.00,10.0000,90.0000,1777622442.000',
  ]);
  assert.equal(lines.at(-1), '');
  assert.equal(lines.at(-2), `# end rows: ${log.rows}`);
  assert.equal(log.rows, lines.length - 2 - 15);
  assert.ok(Math.abs(log.length_m - 1120) < 11, `${log.length_m}`);
});

// Columns lat_deg and lon_deg of a log, in metres from home.
function placesIn(log) {
  const lines = log.parts.join('').split('\n').filter((line) => !line.startsWith('#'));
  const [lat, lon] = ['lat_deg', 'lon_deg'].map((name) => lines[0].split(',').indexOf(name));
  return lines.slice(1).map((line) => line.split(',')).filter((cells) => cells[lat])
    .map((cells) => ({ x: (Number(cells[lon]) - home.lon) * lat_m * Math.cos((home.lat * Math.PI) / 180), y: (Number(cells[lat]) - home.lat) * lat_m }));
}

test('jumps of the receiver are not in the log, poor positions on the way are', () => {
  for (const jump of [1, 2]) { // fixes in a row
    const fixes = drive([100, east(0)], [jump, stand(-4000)], [100 - jump, east(1000 + speed_mps * jump)]);
    fixes[9 * 80 + 4] = 65; // m
    fixes.set([0, 0, 5], 9 * 85 + 2); // a receiver that knows nothing
    fixes.set([fixes[9 * 90 + 2] + 0.03, fixes[9 * 90 + 3], 4000], 9 * 90 + 2); // the place of a mast 3 km away
    const places = placesIn(tripLog({ motion: motion(20000), fixes, upright: 1 }, meta));
    assert.equal(places.length, 113 - jump - 2);
    assert.ok(places.every(({ x, y }) => x > 400 && x < 1600 && Math.abs(y) < 1), JSON.stringify(places));
    assert.ok(places.some(({ x }) => Math.abs(x - 800) < 1));
  }
});

test('times in the log increase, whatever order the samples came in', () => {
  const samples = motion(20000);
  samples.copyWithin(50000, 60000, 60010); // a reading twice, out of order
  const log = tripLog({ motion: samples, fixes: drive([200, east(0)]), upright: 1 }, meta);
  const times = log.parts.join('').split('\n').filter((line) => /^\d/.test(line)).map((line) => Number(line.split(',')[0]));
  assert.ok(times.every((t, i) => i === 0 || t > times[i - 1]));
});

test('accelerations of browsers that turn the signs round are turned back', () => {
  assert.deepEqual(upBy(0, 0), [-0, 0, 1]);
  const log = tripLog({ motion: motion(20000, 10, [0, 0, -9.81]), fixes: drive([200, east(0)]), upright: -98.1 }, meta);
  assert.match(log.parts.join(''), /\n0\.000000,-?0\.00000,-?0\.00000,9\.81000,/);
});

test('without a reading of gravity the other acceleration is written, and said so', () => {
  const samples = motion(20000, 10, [NaN, NaN, NaN]);
  for (let i = 0; i < samples.length; i += 10) {
    samples.set([1, 2, 3], i + 4);
  }
  const text = tripLog({ motion: samples, fixes: drive([200, east(0)]), upright: 0 }, meta).parts.join('');
  assert.match(text, /# gravity: removed\n/);
  assert.match(text, /\n0\.000000,1\.00000,2\.00000,3\.00000,/);
});

test('events become SI units, and what is unknown stays unknown', () => {
  const row = motionRow({ timeStamp: 5, accelerationIncludingGravity: { x: 1, y: null, z: 9 }, acceleration: null, rotationRate: { alpha: 180, beta: 0, gamma: null } }, 1000);
  assert.deepEqual(row, [1005, 1, NaN, 9, NaN, NaN, NaN, Math.PI, 0, NaN]);
});

test('no reading waits longer than two seconds for the disk', () => {
  const chunks = [];
  const recording = new Recording({ timeOrigin_ms: 0, onChunk: (chunk) => chunks.push(chunk) });
  for (let t = 0; t < 10_000; t += 20) {
    recording.addMotion({ timeStamp: t, accelerationIncludingGravity: { x: 0, y: 0, z: 9.8 } });
  }
  assert.equal(chunks.length, 4);
  recording.flush();
  const all = joined(chunks);
  assert.equal(all.motion.length, 500 * 10);
  assert.ok(chunks.every((chunk) => chunk.motion.at(-10) - chunk.motion[0] <= 2000));
});

function watchOf({ step_ms = 10, force = [0, 0, 9.81], turn = [0, 0, 0], accuracy = 4, seconds: s = 6 } = {}, watch = new QualityWatch(), from_ms = 0) {
  for (let t = from_ms; t < from_ms + 1000 * s; t += step_ms) {
    watch.addMotion([t, ...force, NaN, NaN, NaN, ...turn], t);
  }
  watch.addFix([0, 0, 47, 19, accuracy, NaN, NaN, 12, 0], from_ms + 1000 * s);
  return watch;
}

test('a phone that is fixed well gives no cause for complaint', () => {
  const found = watchOf({ force: [0, 2.04, 9.6] }).assess(6000);
  assert.deepEqual(found.problems, []);
  assert.equal(Math.round(found.rate_hz), 100);
  assert.equal(Math.round(found.tilt_deg), 12);
  assert.ok(found.isSteady);
});

test('what is wrong is said', () => {
  assert.deepEqual(watchOf({ step_ms: 33 }).assess(6000).problems, ['slow_motion']);
  assert.deepEqual(watchOf({ accuracy: 65 }).assess(6000).problems, ['poor_gnss']);
  assert.deepEqual(watchOf().assess(17_000).problems, ['no_motion', 'no_gnss']);
  assert.deepEqual(watchOf({ turn: [0.6, 0, 0] }).assess(6000).problems, ['handheld']);
  assert.deepEqual(watchOf({ turn: [0, 0, 0.6] }).assess(6000).problems, [], 'a bend');
  assert.deepEqual(watchOf().assess(6000, { isHidden: true }).problems, ['hidden']);
  assert.deepEqual(new QualityWatch().assess(0).problems, ['no_motion', 'no_gnss']);
});

test('a phone that slid is noticed', () => {
  const watch = watchOf();
  watch.assess(6000);
  watchOf({ force: [0, 6, 7.8] }, watch, 6000);
  assert.deepEqual(watch.assess(12_000).problems, ['moved']);
});

test('a car is taken as on its papers, or not at all', () => {
  assert.deepEqual(parseCar({ body: 'compact', mass: '1430', wheelbase: '2,62' }), { car: { body: 'compact', mass_kg: 1430, wheelbase_m: 2.62 } });
  assert.equal(parseCar({ body: 'compact', mass: '1430', wheelbase: '2620' }).car.wheelbase_m, 2.62);
  assert.deepEqual(parseCar({ body: '', mass: '1430', wheelbase: '2.62' }), { car: {} });
  assert.equal(parseCar({ body: 'compact', mass: '14300', wheelbase: '2.62' }).wrong, 'mass_kg');
  assert.equal(parseCar({ body: 'compact', mass: '1430', wheelbase: 'long' }).wrong, 'wheelbase_m');
});

test('the bodies of cars are those of the program', () => {
  const source = readFileSync(new URL('../../../estimator/vehicle/vehicle_prior.cpp', import.meta.url), 'utf8');
  const rows = [...source.matchAll(/\{"(\w+)",\s*\{([\d.]+), ([\d.]+)\},\s*\{([\d.]+), ([\d.]+)\}/g)];
  const bodies = Object.fromEntries(rows.map(([, name, ...limits]) => {
    const [a, b, c, d] = limits.map(Number);
    return [name, { mass_kg: [a, b], wheelbase_m: [c, d] }];
  }));
  assert.deepEqual(carBodies, bodies);
});

test('both languages say the same things', () => {
  const holes = (text) => [...text.matchAll(/\{\w+\}/g)].map(String).sort();
  assert.deepEqual(Object.keys(catalogues.de), Object.keys(catalogues.en));
  for (const [key, text] of Object.entries(catalogues.en)) {
    assert.deepEqual(holes(catalogues.de[key]), holes(text), key);
  }
  assert.equal(wordsOf('fr')('none'), 'none');
});

const answer = (status, headers = {}, body = {}) => new Response(status === 204 ? null : JSON.stringify(body), { status, headers });
async function sent(answers, trip = {}) {
  const asked = [];
  const fetch = async (url, { method = 'GET', headers }) => {
    asked.push(`${method} ${url.pathname} ${headers.Authorization ?? ''}`.trim());
    const next = answers.shift();
    if (!next) {
      throw new TypeError('no network');
    }
    return next;
  };
  const outcome = await sendTrip({ sha256: 'ab', body: new Blob(['x'], { type: 'application/gzip' }), attempt: 0, ...trip }, { token: 'key', base: 'https://a.example/m/', fetch });
  return { asked, ...outcome };
}

test('a receipt is an answer 200 or 202 and nothing else', async () => {
  assert.deepEqual(await sent([answer(202)]), { asked: ['PUT /m/v1/trips/ab Bearer key'], outcome: 'received' });
  assert.equal((await sent([answer(200)])).outcome, 'received');
  assert.equal((await sent([answer(201)])).outcome, 'refused');
  assert.equal((await sent([answer(204)])).outcome, 'refused');
});

test('what the server says decides what happens next', async () => {
  assert.equal((await sent([])).outcome, 'later');
  assert.deepEqual(await sent([answer(429, { 'Retry-After': '7' })]), { asked: ['PUT /m/v1/trips/ab Bearer key'], outcome: 'later', after_s: 7 });
  assert.equal((await sent([answer(503)], { attempt: 0 })).after_s, 5);
  assert.equal((await sent([answer(404), answer(503)], { attempt: 99 })).after_s, 900);
  assert.equal((await sent([answer(401)])).outcome, 'no_leave');
  assert.equal((await sent([answer(405)])).outcome, 'no_server');
  assert.equal((await sent([answer(413)])).outcome, 'too_large');
  assert.deepEqual((await sent([answer(422, {}, { detail: 'hash differs' })])).reason, 'hash differs');
});

test('a trip whose receipt was lost is not sent twice', async () => {
  assert.deepEqual(await sent([answer(200)], { attempt: 1 }), { asked: ['GET /m/v1/trips/ab Bearer key'], outcome: 'received' });
  assert.deepEqual((await sent([answer(404), answer(202)], { attempt: 1 })).asked, ['GET /m/v1/trips/ab Bearer key', 'PUT /m/v1/trips/ab Bearer key']);
});

// A trip in a store that has no other.
function storeOf(trip, log) {
  return {
    trips: async () => [trip],
    log: async () => log,
    changeTrip: async (id, change) => (trip = change(trip) || trip),
  };
}

test('a log that is larger than servers take is not sent, and the trip says so', async () => {
  const store = storeOf({ id: 'a', state: 'queued', sha256: 'ab' }, { size: maxUpload_bytes + 1 });
  assert.equal(await sendQueued(store, { base: 'https://a.example/', signalOf: () => undefined, onChange: () => {} }), null);
  const [trip] = await store.trips();
  assert.deepEqual([trip.state, trip.problem], ['ended', 'too_large']);
  assert.ok(isTooLarge(trip) && !isTooLarge({ bytes: maxUpload_bytes }));
});

test('a deletion at the server is told from one that will be, and from a trip that is not there', async () => {
  const fateOf = (...answers) => deleteAtServer('ab', { base: 'https://a.example/', fetch: async () => answers[0] ?? Promise.reject(new TypeError()) });
  assert.deepEqual(await Promise.all([answer(204), answer(202), answer(404), answer(401), answer(503), undefined].map((each) => fateOf(each))),
    ['gone', 'deleting', 'missing', undefined, undefined, undefined]);
});

test('a list that the server does not give is told from an empty one', async () => {
  const listOf = (given) => listAtServer({ base: 'https://a.example/', fetch: async () => given ?? Promise.reject(new TypeError()) });
  assert.deepEqual(await listOf(answer(200, {}, { trips: [] })), { trips: [] });
  assert.deepEqual(await listOf(answer(401)), { problem: 'no_leave' });
  assert.deepEqual(await listOf(answer(503)), {});
  assert.deepEqual(await listOf(undefined), {});
});

test('a trip on the phone and at the server is one entry, with its fate', () => {
  const row = (sha256, state) => ({ sha256, state, received: '2026-05-01T08:00:00Z', bytes: 1, passes: 0 });
  const known = { trips: [row('b', 'refused'), row('c', 'imported'), row('q', 'working')], asked_ms: 100, isWhole: true };
  const trips = [
    { id: '1', sha256: 'a', state: 'received', begun_ms: 1, told_ms: 50 }, { id: '2', sha256: 'b', state: 'received', begun_ms: 2, told_ms: 50 },
    { id: '3', sha256: 'd', state: 'deleting', begun_ms: 3, told_ms: 50 }, { id: '4', sha256: 'e', state: 'received', begun_ms: 4, told_ms: 150 },
    { id: '5', sha256: 'q', state: 'queued', begun_ms: 5 }, { id: '6', state: 'recording', begun_ms: 6 },
  ];
  const told = (merged) => merged.map(({ sha256, state, row: its }) => `${sha256} ${state} ${its?.state ?? '-'}`);
  // e was sent after the list was asked for, and is not missing
  assert.deepEqual(told(mergedTrips(trips, known)), ['c elsewhere imported', 'q queued -', 'e received -', 'd gone -', 'b received refused', 'a missing -']);
  const cut = told(mergedTrips(trips, { ...known, isWhole: false })); // older ones are not in the list
  assert.ok(cut.includes('a received -') && cut.includes('d deleting -'), cut.join());
});
