// A trip in the list, and what the driver can do with it.
import { element } from '../dom.js';
import { button, dateOf, number, say, words } from '../page.js';
import { fileName } from '../trips.js';
import { deleteAtServer } from '../upload.js';

const fileOf = async (store, trip) => new File([await store.log(trip.id)], fileName(trip), { type: 'text/csv' });

const canShare = () => Boolean(navigator.canShare?.({ files: [new File([''], 'a.csv', { type: 'text/csv' })] }));

async function saveTrip({ store }, trip) {
  const url = URL.createObjectURL(await fileOf(store, trip));
  element('a', { href: url, download: fileName(trip) }).click();
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

async function shareTrip({ store }, trip) {
  try {
    await navigator.share({ files: [await fileOf(store, trip)] });
  } catch { // the driver thought better of it
  }
}

async function queueTrip({ store, sender, home }, trip) {
  const { problem, reason, ...entry } = trip;
  await store.putTrip({ ...entry, state: 'queued' });
  await home();
  await sender.send();
}

async function deleteThere({ store, base, home }, trip) {
  if (!confirm(words('confirm_delete'))) {
    return;
  }
  if (await deleteAtServer(trip.sha256, { token: await store.setting('token'), base })) {
    await store.putTrip({ ...trip, state: 'gone' });
    await home();
  } else {
    say(words('not_deleted'));
  }
}

async function remove({ store, home }, trip, isAsked) {
  if (!isAsked || confirm(words('confirm_delete'))) {
    await store.deleteTrip(trip.id);
    await home();
  }
}

function deedsOf(recorder, trip) {
  const named = (key, onclick) => button(key, onclick, { 'aria-label': `${words(key)}: ${dateOf(trip.begun_ms)}` });
  if (trip.state === 'ended' || trip.state === 'queued') {
    return [
      trip.state === 'ended' ? named('send', () => queueTrip(recorder, trip)) : null,
      named('save_file', () => saveTrip(recorder, trip)),
      canShare() ? named('share_file', () => shareTrip(recorder, trip)) : null,
      named('delete', () => remove(recorder, trip, true)),
    ];
  }
  return [
    trip.state === 'received' ? named('delete_there', () => deleteThere(recorder, trip)) : null,
    named('hide', () => remove(recorder, trip, false)),
  ];
}

export function tripLines(recorder, trip) {
  const date = dateOf(trip.begun_ms);
  if (trip.state === 'too_short') {
    return [element('p', {}, words('too_short', { date })), element('div', { class: 'deeds' }, button('hide', () => remove(recorder, trip, false)))];
  }
  const line = words('trip_line', {
    date, km: number(trip.length_m / 1000, 1), min: number((trip.end_ms - trip.begun_ms) / 60000),
  });
  return [
    element('strong', {}, line),
    element('p', { class: 'soft' }, words(`state_${trip.state}`)),
    trip.problem ? element('p', { class: 'wrong' }, words(trip.problem, { reason: trip.reason })) : null,
    element('div', { class: 'deeds' }, ...deedsOf(recorder, trip)),
  ];
}
