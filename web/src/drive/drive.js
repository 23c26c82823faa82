import { parseCar, carBodies } from './car.js';
import { element } from './dom.js';
import { distance_m } from './geometry.js';
import { QualityWatch } from './quality.js';
import { Recording } from './recording.js';
import { holdRecording } from './recording_lock.js';
import { fixColumn } from './samples.js';
import { askForMotion, keepAwake, listen } from './sensors.js';
import { TripStore } from './trip_store.js';
import { endTrip, fileName, newTrip, randomName, recordedFor_ms, sendQueued } from './trips.js';
import { acceptInvitation, deleteAtServer } from './upload.js';
import { wordsOf } from './words.js';

const page = document.getElementById('page');
const notice = document.getElementById('notice');
const languageButton = document.getElementById('language');
const serverBase = new URL('../', location.href);
const refresh_ms = 1000;

let store;
let language;
let words;
let view; // function that draws the present view
let isSending = false;
let isSendingWanted = false; // again, once what is being sent is through
let sendTimer;
let isStarting = false;

const device = () => navigator.userAgent;

function say(text) {
  notice.textContent = text;
}

function button(key, onclick, attributes = {}) {
  return element('button', { type: 'button', onclick, ...attributes }, words(key));
}

// Shows a view and gives its heading the focus, so that a screen reader begins there.
async function show(next, ...values) {
  view = () => show(next, ...values);
  const content = await next(...values);
  page.replaceChildren(...content);
  document.documentElement.lang = language;
  document.getElementById('title').textContent = 'Macadam';
  document.title = `${words('title')} – Macadam`;
  languageButton.textContent = words('other_language');
  languageButton.lang = language === 'de' ? 'en' : 'de';
  page.querySelector('h2')?.focus();
}

const heading = (key) => element('h2', { tabindex: '-1' }, words(key));

// The browser's own form of the language: en-GB, de-AT.
const locale = () => navigator.languages.find((name) => name.startsWith(language)) ?? language;
const dateOf = (ms) => new Date(ms).toLocaleString(locale(), { dateStyle: 'medium', timeStyle: 'short' });
const number = (value, digits = 0) =>
  value.toLocaleString(locale(), { minimumFractionDigits: digits, maximumFractionDigits: digits });

// ---------------------------------------------------------------------------------- privacy, car

function privacyView() {
  const texts = [1, 2, 3, 4, 5, 6].map((n) => element('p', {}, words(`privacy_${n}`)));
  const understood = async () => {
    await store.setSetting('understood', true);
    await begin();
  };
  return [heading('privacy_heading'), ...texts, button('understood', understood, { class: 'main' })];
}

async function carView() {
  const known = (await store.setting('car')) ?? {};
  const body = element('select', { id: 'body' }, element('option', { value: '' }, words('body_unknown')),
    ...Object.keys(carBodies).map((name) => element('option', { value: name, selected: name === known.body }, words(`body_${name}`))));
  const input = (id, value) =>
    element('input', { type: 'text', inputmode: 'decimal', id, autocomplete: 'off', 'aria-describedby': 'wrong', value: value ?? '' });
  const mass = input('mass', known.mass_kg);
  const wheelbase = input('wheelbase', known.wheelbase_m);
  const wrong = element('p', { id: 'wrong', class: 'wrong', role: 'alert' });
  const hasVehicle = Boolean(await store.setting('vehicle_id'));
  const other = element('input', { type: 'checkbox', id: 'other' });
  const keep = async () => {
    const parsed = parseCar({ body: body.value, mass: mass.value, wheelbase: wheelbase.value });
    for (const field of [mass, wheelbase]) {
      field.removeAttribute('aria-invalid');
    }
    if (parsed.wrong) {
      wrong.textContent = words(`${parsed.wrong}_wrong`, { min: number(parsed.range[0], parsed.range[0] % 1 ? 2 : 0), max: number(parsed.range[1], parsed.range[1] % 1 ? 2 : 0) });
      const field = parsed.wrong === 'mass_kg' ? mass : wheelbase;
      field.setAttribute('aria-invalid', 'true');
      field.focus();
      return;
    }
    await store.setSetting('car', parsed.car);
    if (!hasVehicle || other.checked) {
      await store.setSetting('vehicle_id', randomName('web-', 8));
    }
    await begin();
  };
  return [
    heading('car_heading'), element('p', {}, words('car_why')),
    element('label', { for: 'body' }, words('car_body')), body,
    element('label', { for: 'mass' }, words('car_mass')), mass,
    element('label', { for: 'wheelbase' }, words('car_wheelbase')), wheelbase,
    hasVehicle ? element('label', { class: 'tick' }, other, words('other_car')) : null,
    wrong, button('save_car', keep, { class: 'main' }),
  ].filter(Boolean);
}

// ------------------------------------------------------------------------------------------ home

async function homeView() {
  const trips = (await store.trips()).filter((trip) => trip.state !== 'recording').sort((a, b) => b.begun_ms - a.begun_ms);
  const items = trips.map((trip) => element('li', {}, ...tripLines(trip)));
  return [
    heading('ready_heading'), element('p', {}, words('ready_text')),
    button('start', startTrip, { class: 'main' }),
    element('h2', {}, words('trips')),
    items.length > 0 ? element('ul', { class: 'trips' }, ...items) : element('p', { class: 'soft' }, words('no_trips')),
    element('div', { class: 'deeds' },
      button('car_heading', () => show(carView), { class: 'plain' }),
      button('privacy_again', () => show(privacyView), { class: 'plain' }),
      element('a', { class: 'plain', href: '../' }, words('to_map'))),
  ];
}

function tripLines(trip) {
  const date = dateOf(trip.begun_ms);
  const remove = async (isAsked) => {
    if (!isAsked || confirm(words('confirm_delete'))) {
      await store.deleteTrip(trip.id);
      await show(homeView);
    }
  };
  if (trip.state === 'too_short') {
    return [element('p', {}, words('too_short', { date })), element('div', { class: 'deeds' }, button('hide', () => remove(false)))];
  }
  const line = words('trip_line', {
    date, km: number(trip.length_m / 1000, 1), min: number((trip.end_ms - trip.begun_ms) / 60000),
  });
  const named = (key, onclick) => button(key, onclick, { 'aria-label': `${words(key)}: ${date}` });
  const deeds = [];
  if (trip.state === 'ended' || trip.state === 'queued') {
    if (trip.state === 'ended') {
      deeds.push(named('send', () => queueTrip(trip)));
    }
    deeds.push(named('save_file', () => saveTrip(trip)));
    if (canShare()) {
      deeds.push(named('share_file', () => shareTrip(trip)));
    }
    deeds.push(named('delete', () => remove(true)));
  } else {
    if (trip.state === 'received') {
      deeds.push(named('delete_there', () => deleteThere(trip)));
    }
    deeds.push(named('hide', () => remove(false)));
  }
  return [
    element('strong', {}, line),
    element('p', { class: 'soft' }, words(`state_${trip.state}`)),
    trip.problem ? element('p', { class: 'wrong' }, words(trip.problem, { reason: trip.reason })) : null,
    element('div', { class: 'deeds' }, ...deeds),
  ];
}

const fileOf = async (trip) => new File([await store.log(trip.id)], fileName(trip), { type: 'text/csv' });

const canShare = () => Boolean(navigator.canShare?.({ files: [new File([''], 'a.csv', { type: 'text/csv' })] }));

async function saveTrip(trip) {
  const url = URL.createObjectURL(await fileOf(trip));
  element('a', { href: url, download: fileName(trip) }).click();
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

async function shareTrip(trip) {
  try {
    await navigator.share({ files: [await fileOf(trip)] });
  } catch { // the driver thought better of it
  }
}

async function queueTrip(trip) {
  const { problem, reason, ...entry } = trip;
  await store.putTrip({ ...entry, state: 'queued' });
  await show(homeView);
  await sendAll();
}

async function deleteThere(trip) {
  if (!confirm(words('confirm_delete'))) {
    return;
  }
  if (await deleteAtServer(trip.sha256, { token: await store.setting('token'), base: serverBase })) {
    await store.putTrip({ ...trip, state: 'gone' });
    await show(homeView);
  } else {
    say(words('not_deleted'));
  }
}

// Sends what the driver has given leave to send. Only one page of several does it at a time.
async function sendAll() {
  isSendingWanted = isSending;
  if (isSending || !navigator.onLine || !isSecureContext) {
    return;
  }
  isSending = true;
  clearTimeout(sendTimer);
  try {
    await acceptWaitingInvitation();
    const send = async () => sendQueued(store, {
      token: await store.setting('token'),
      base: serverBase,
      onChange: (trip, state) => say(state === 'sending' ? words('state_sending') : ''),
    });
    const again_s = await navigator.locks.request('macadam-drive-send', send);
    if (again_s !== null) {
      sendTimer = setTimeout(sendAll, again_s * 1000);
    }
  } finally {
    isSending = false;
  }
  if (view && page.querySelector('ul.trips')) {
    await view();
  }
  if (isSendingWanted) {
    await sendAll();
  }
}

// -------------------------------------------------------------------------------------- recording

// Answers a tap on "Start trip". What was said of the try before is gone at once.
async function startTrip() {
  if (isStarting) {
    return;
  }
  isStarting = true;
  say('');
  try {
    if (!isSecureContext) {
      say(words('insecure'));
    } else if (!(await askForMotion())) {
      say(words('no_leave_motion'));
    } else {
      await withRecording(startNewTrip);
    }
  } finally {
    isStarting = false;
  }
}

// Does what only one page of several may do at a time. work(letGo): returns whether it goes on recording; then it is to
// let go itself. Returns the same.
async function withRecording(work) {
  const letGo = await holdRecording();
  if (!letGo) {
    say(words('other_page'));
    return false;
  }
  let goesOn = false;
  try {
    goesOn = await work(letGo);
  } finally {
    if (!goesOn) {
      await letGo();
    }
  }
  return goesOn;
}

async function startNewTrip(letGo) {
  const trip = newTrip(Date.now(), await store.setting('vehicle_id'), await store.setting('car'));
  try {
    await store.putTrip(trip);
  } catch {
    say(words('no_room'));
    return false;
  }
  await record(trip, [], letGo);
  return true;
}

const permissionDenied = 1; // of GeolocationPositionError; the others are gaps of the receiver

// Records until the driver ends the trip. before: chunks that the trip has already; letGo: lets other pages record again.
async function record(trip, before, letGo) {
  say('');
  navigator.storage?.persist?.();
  let seq = before.length === 0 ? 0 : before.at(-1).seq + 1;
  const state = { length_m: 0, awake: false, failed: false, isPositionRefused: false, last: null, begun_ms: null, now_ms: 0 };
  const watch = new QualityWatch();
  const writes = new Set();
  const recording = new Recording({
    timeOrigin_ms: performance.timeOrigin,
    onChunk: (chunk) => {
      const write = store.addChunk(trip.id, seq++, chunk).catch(() => {
        state.failed = true;
      }).finally(() => writes.delete(write));
      writes.add(write);
    },
  });
  const seen = (t_ms) => {
    state.begun_ms ??= t_ms;
    state.now_ms = Math.max(state.now_ms, t_ms);
  };
  const stopListening = listen({
    onMotion: (event) => {
      const row = recording.addMotion(event);
      watch.addMotion(row, performance.now());
      seen(row[0]);
    },
    onOrientation: (event) => recording.addOrientation(event),
    onPosition: (position) => {
      const row = recording.addPosition(position);
      state.isPositionRefused = false;
      watch.addFix(row, performance.now());
      seen(row[fixColumn.stamp_ms]);
      const place = { lat: row[fixColumn.lat], lon: row[fixColumn.lon] };
      if (row[fixColumn.accuracy] <= 50) {
        const gone_m = state.last ? distance_m(state.last, place) : 0;
        if (!state.last || gone_m > 10) { // a parked car's receiver wanders
          state.length_m += gone_m;
          state.last = place;
        }
      }
    },
    onPositionError: ({ code }) => {
      state.isPositionRefused = code === permissionDenied;
    },
  });
  const flush = () => recording.flush();
  const flushTimer = setInterval(flush, 2000);
  document.addEventListener('visibilitychange', flush);
  const letSleep = keepAwake((isAwake) => {
    state.awake = isAwake;
  });
  const panel = drivePanel(async () => {
    clearInterval(flushTimer);
    clearInterval(drawTimer);
    stopListening();
    letSleep();
    document.removeEventListener('visibilitychange', flush);
    flush();
    await show(() => [heading('driving'), element('p', {}, words('working'))]);
    await Promise.all(writes);
    await endTrip(store, trip, device());
    await letGo();
    await show(homeView);
  });
  const draw = () => panel.draw(state, watch.assess(performance.now(), { isHidden: document.hidden }));
  const drawTimer = setInterval(draw, refresh_ms);
  await show(() => panel.content());
  draw();
}

// Figures of the running trip and advice in words. Advice changes only when it differs, so that it is read out once.
function drivePanel(stop) {
  const figures = ['time', 'distance', 'rate', 'gnss', 'mounting'];
  let cells = {};
  let advice;
  let shown;
  const content = () => {
    cells = Object.fromEntries(figures.map((key) => [key, element('dd', { id: `figure-${key}` }, '–')]));
    advice = element('ul', { class: 'advice', id: 'advice', role: 'list' });
    shown = null;
    return [
      heading('driving'),
      element('div', { role: 'status' }, advice),
      element('dl', { class: 'figures' }, ...figures.map((key) => element('div', {}, element('dt', {}, words(key)), cells[key]))),
      button('stop', stop, { class: 'main' }),
    ];
  };
  const draw = (state, quality) => {
    const s = Math.max(0, Math.round((state.now_ms - (state.begun_ms ?? state.now_ms)) / 1000));
    cells.time.textContent = `${Math.floor(s / 60)}:${String(s % 60).padStart(2, '0')}`;
    cells.distance.textContent = `${number(state.length_m / 1000, 1)} km`;
    cells.rate.textContent = words('per_second', { n: number(quality.rate_hz) });
    cells.gnss.textContent = Number.isFinite(quality.accuracy_m) ? words('within', { n: number(quality.accuracy_m) }) : words('none');
    cells.mounting.textContent = Number.isFinite(quality.tilt_deg)
      ? words(quality.isSteady ? 'tilt_steady' : 'tilt_moves', { n: number(quality.tilt_deg) })
      : words('measuring');
    const problems = [
      ...(state.failed ? ['no_room'] : []), ...(state.isPositionRefused ? ['no_leave_position'] : []),
      ...quality.problems.filter((problem) => !(state.isPositionRefused && problem === 'no_gnss')),
    ];
    const key = `${language} ${problems} ${state.awake}`;
    if (key === shown) {
      return;
    }
    shown = key;
    const values = { slow_motion: { n: number(quality.rate_hz) }, poor_gnss: { n: number(quality.accuracy_m) } };
    advice.replaceChildren(
      ...problems.map((problem) => element('li', { class: 'bad' }, words(problem, values[problem]))),
      problems.length === 0 ? element('li', {}, words('all_well')) : '',
      element('li', {}, words(state.awake ? 'awake' : 'not_awake')));
  };
  return { content, draw };
}

function foundView(trip, chunks) {
  const min = number(recordedFor_ms(chunks) / 60000, 1);
  // Another page may have gone on with it, or ended it, since this one was drawn.
  const withTrip = async (work) => {
    const goesOn = await withRecording(async (letGo) => {
      const now = (await store.trips()).find(({ id, state }) => id === trip.id && state === 'recording');
      return now ? work(now, letGo) : false;
    });
    if (!goesOn) {
      await begin();
    }
  };
  const goOn = async () => {
    say('');
    if (await askForMotion()) {
      await withTrip(async (now, letGo) => {
        await record(now, await store.chunks(now.id), letGo);
        return true;
      });
    } else {
      say(words('no_leave_motion'));
    }
  };
  const endNow = async () => {
    say('');
    await withTrip(async (now) => {
      await show(() => [heading('driving'), element('p', {}, words('working'))]);
      await endTrip(store, now, device());
      return false;
    });
  };
  return [
    heading('found_heading'), element('p', {}, words('found_text', { date: dateOf(trip.begun_ms), min })),
    button('go_on', goOn, { class: 'main' }), button('end_now', endNow),
  ];
}

// ------------------------------------------------------------------------------------------ start

// Shows what comes next: the privacy page, the car, an interrupted trip, or home.
async function begin() {
  if (!(await store.setting('understood'))) {
    return show(privacyView);
  }
  if (!(await store.setting('vehicle_id'))) {
    return show(carView);
  }
  const open = (await store.trips()).find((trip) => trip.state === 'recording');
  const letGo = open && (await holdRecording());
  if (letGo) { // no other page is at it
    await letGo();
    return show(foundView, open, await store.chunks(open.id));
  }
  return show(homeView);
}

// Takes an invitation (…/drive/#invite=TEXT), which never reaches a server as part of an address.
async function takeInvitation() {
  const invitation = new URLSearchParams(location.hash.slice(1)).get('invite');
  if (invitation && /^[\w.~-]{16,200}$/.test(invitation)) {
    await store.setSetting('token', invitation); // which it may be already
    await store.setSetting('invitation', invitation);
    history.replaceState(null, '', location.pathname);
    say(words('invited'));
    await acceptWaitingInvitation();
  }
}

// Gets the token of an invitation, now or when there is a network.
async function acceptWaitingInvitation() {
  const invitation = await store.setting('invitation');
  const token = invitation && navigator.onLine ? await acceptInvitation(invitation, { base: serverBase }) : undefined;
  if (token !== undefined) {
    await store.setSetting('token', token ?? invitation);
    await store.setSetting('invitation', null);
  }
}

async function setLanguage(chosen) {
  language = chosen;
  words = wordsOf(language);
}

languageButton.onclick = async () => {
  await setLanguage(language === 'de' ? 'en' : 'de');
  await store.setSetting('language', language);
  await view();
};

store = await TripStore.open();
await setLanguage((await store.setting('language')) ?? (navigator.language.startsWith('de') ? 'de' : 'en'));
await takeInvitation();
await begin();
addEventListener('online', sendAll);
sendAll();
navigator.serviceWorker?.register('service_worker.js');
