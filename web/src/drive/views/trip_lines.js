// A trip in the list, and what the driver can do with it.
import { element } from '../dom.js';
import { plain } from '../sending/log_file.js';
import { button, dateOf, number, say, words } from '../page.js';
import { deleteHere, fileName, isTooLarge } from '../trips.js';

const fates = ['queued', 'working', 'imported', 'known', 'outside', 'refused', 'deleting'];

// The log as people read it, not compressed. Returns undefined if another page has deleted or sent the trip.
async function fileOf(store, trip) {
  const log = await store.log(trip.id);
  return log && new File([await plain(log)], fileName(trip), { type: 'text/csv' });
}

const canShare = () => Boolean(navigator.canShare?.({ files: [new File([''], 'a.csv', { type: 'text/csv' })] }));

async function saveTrip({ store, home }, trip) {
  const file = await fileOf(store, trip);
  if (!file) {
    await home();
    return;
  }
  const url = URL.createObjectURL(file);
  element('a', { href: url, download: file.name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

async function shareTrip({ store, home }, trip) {
  const file = await fileOf(store, trip);
  if (!file) {
    await home();
    return;
  }
  try {
    await navigator.share({ files: [file] });
  } catch { // the driver thought better of it
  }
}

async function queueTrip({ store, sender, home }, trip) {
  await store.changeTrip(trip.id, ({ problem, reason, ...entry }) => entry.state === 'ended' && { ...entry, state: 'queued' });
  await home();
  await sender.send();
}

async function deleteThere({ store, atServer, home }, trip) {
  if (!confirm(words('confirm_delete'))) {
    return;
  }
  const state = await atServer.delete(trip.sha256);
  if (!state) {
    say(words('not_deleted'));
    return;
  }
  say(trip.state === 'elsewhere' ? words(`state_${state}`) : '');
  await store.changeTrip(trip.id, (entry) => ({ ...entry, state, told_ms: Date.now() }));
  await home();
  await atServer.refresh();
}

async function remove({ store, sender, home }, trip) {
  if (confirm(words('confirm_delete'))) {
    await deleteHere(store, trip.id);
    sender.cancel(trip.id);
    await home();
    await sender.send();
  }
}

async function hide({ store, home }, trip) {
  await store.deleteTrip(trip.id);
  await home();
}

function deedsOf(recorder, trip) {
  const named = (key, act) =>
    button(key, () => act(recorder, trip), { id: `${key}-${trip.id}`, 'aria-label': `${words(key)}: ${dateOf(trip.begun_ms)}` });
  if (trip.state === 'ended' || trip.state === 'queued') {
    return [
      trip.state === 'ended' && !isTooLarge(trip) ? named('send', queueTrip) : null,
      named('save_file', saveTrip),
      canShare() ? named('share_file', shareTrip) : null,
      named('delete', remove),
    ];
  }
  if (trip.state === 'withdrawn' || (trip.row ?? trip).state === 'deleting') {
    return [];
  }
  return [['too_short', 'gone', 'missing'].includes(trip.state) ? named('hide', hide) : named('delete_there', deleteThere)];
}

function titleOf(trip) {
  const date = dateOf(trip.begun_ms);
  return trip.state === 'elsewhere'
    ? words('sent_line', { date, mb: number(trip.bytes / 1e6, 1) })
    : words('trip_line', { date, km: number(trip.length_m / 1000, 1), min: number((trip.end_ms - trip.begun_ms) / 60000) });
}

// What became of a trip: of the server's fates, or the state on this phone.
function fateText({ state, row }) {
  if (!row) {
    return words(`state_${state}`);
  }
  return fates.includes(row.state)
    ? words(`fate_${row.state}`, { n: number(row.passes), reason: row.reason ?? '–' })
    : words('fate_other', { state: row.state });
}

function problemText(trip) {
  const problem = isTooLarge(trip) ? 'too_large' : trip.problem;
  return problem && words(problem, { reason: trip.reason, mb: number(trip.bytes / 1e6) });
}

export function tripLines(recorder, trip) {
  const deeds = element('div', { class: 'deeds' }, ...deedsOf(recorder, trip));
  if (trip.state === 'too_short') {
    return [element('p', {}, words('too_short', { date: dateOf(trip.begun_ms) })), deeds];
  }
  const problem = problemText(trip);
  return [
    element('strong', {}, titleOf(trip)),
    element('p', { class: trip.row?.state === 'refused' ? 'wrong' : 'soft' }, fateText(trip)),
    problem ? element('p', { class: 'wrong' }, problem) : null,
    deeds,
  ];
}
