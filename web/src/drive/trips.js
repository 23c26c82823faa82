import { compressed } from './sending/log_file.js';
import { joined } from './recording.js';
import { fixColumn, fixWidth, motionWidth } from './samples.js';
import { drawCount } from './trimming.js';
import { tripLog } from './trip_log.js';
import { deleteAtServer, maxUpload_bytes, sendTrip, sha256Hex } from './sending/upload.js';

// States of a trip: recording, ended (the log is on the phone), too_short, queued (to be sent), withdrawn (deleted here
// after a try to send it, not yet at the server), received, deleting (at the server), gone (deleted there).

export const randomName = (prefix, bytes) =>
  prefix + [...crypto.getRandomValues(new Uint8Array(bytes))].map((byte) => byte.toString(16).padStart(2, '0')).join('');

export function newTrip(now_ms, vehicle_id, car) {
  const draws = [...crypto.getRandomValues(new Uint32Array(drawCount))].map((bits) => bits / 2 ** 32);
  return { id: randomName('drive-', 8), state: 'recording', begun_ms: now_ms, vehicle_id, car, draws };
}

// How much of an interrupted trip is on the phone.
export function recordedFor_ms(chunks) {
  const motion = chunks.filter((chunk) => chunk.motion.length > 0);
  const fixes = chunks.filter((chunk) => chunk.fixes.length > 0);
  const ends = [
    ...motion.map((chunk) => [chunk.motion[0], chunk.motion[chunk.motion.length - motionWidth]]),
    ...fixes.map((chunk) => [chunk.fixes[fixColumn.stamp_ms], chunk.fixes[chunk.fixes.length - fixWidth + fixColumn.stamp_ms]]),
  ];
  return ends.length === 0 ? 0 : Math.max(...ends.map((end) => end[1])) - Math.min(...ends.map((end) => end[0]));
}

// Ends a trip: its raw readings become the trimmed log and are erased. Returns the trip's entry.
export async function endTrip(store, trip, device) {
  const log = tripLog(joined(await store.chunks(trip.id)), { ...trip, trip_id: trip.id, device });
  const { draws, ...entry } = trip;
  if (!log) {
    const ended = { ...entry, state: 'too_short' };
    await store.finish(ended, null);
    return ended;
  }
  const blob = await compressed(new Blob(log.parts, { type: 'text/csv' }));
  const ended = {
    ...entry,
    state: 'ended',
    begun_ms: log.begin_ms,
    end_ms: log.end_ms,
    length_m: log.length_m,
    bytes: blob.size,
    sha256: await sha256Hex(await blob.arrayBuffer()),
  };
  await store.finish(ended, blob);
  return ended;
}

export const fileName = (trip) =>
  `${new Date(trip.begun_ms).toISOString().slice(0, 16).replace(/[-:]/g, '')}-${trip.id}.trip.csv`;

export const isTooLarge = (trip) => trip.bytes > maxUpload_bytes;

const pauseToDelete_s = 60;

// Sends a trip, unless it was deleted meanwhile. Returns { outcome, after_s } (upload.js); {}: it was deleted.
async function sendQueuedTrip(store, id, { token, base, signal }) {
  const ifQueued = (change, options) => store.changeTrip(id, (entry) => entry.state === 'queued' && change(entry), options);
  // Counted ahead, so that a crash from here on asks the server first.
  const trip = await ifQueued((entry) => ({ ...entry, attempt: (entry.attempt ?? 0) + 1 }));
  const body = trip && (await store.log(id));
  if (!body) {
    return {};
  }
  const attempt = trip.attempt - 1;
  const answer = body.size > maxUpload_bytes
    ? { outcome: 'too_large' }
    : await sendTrip({ sha256: trip.sha256, body, attempt }, { token, base, signal });
  if (answer.outcome === 'received') {
    await ifQueued(({ problem, reason, ...entry }) => ({ ...entry, state: 'received', told_ms: Date.now() }), { dropsLog: true });
  } else if (answer.outcome !== 'later') { // a first try that is refused has left nothing at the server
    const { outcome: problem, reason } = answer;
    await ifQueued((entry) => ({ ...entry, state: 'ended', problem, reason, attempt: attempt === 0 ? 0 : trip.attempt, bytes: body.size }));
  }
  return answer;
}

// Sends all queued trips, one after the other, and deletes withdrawn ones at the server. The driver may delete any
// meanwhile. signalOf(id): aborts the sending of a trip. Returns when to try again (s); null: nothing waits.
export async function sendQueued(store, { token, base, signalOf, onChange }) {
  let again_s = null;
  const waitFor = (after_s) => {
    again_s = Math.min(again_s ?? Infinity, after_s);
  };
  for (const { id } of (await store.trips()).filter((trip) => trip.state === 'queued')) {
    onChange('sending');
    const { outcome, after_s } = await sendQueuedTrip(store, id, { token, base, signal: signalOf(id) });
    if (outcome === 'later') {
      waitFor(after_s);
    }
    onChange(outcome);
  }
  for (const { id, sha256 } of (await store.trips()).filter((trip) => trip.state === 'withdrawn')) {
    if (await deleteAtServer(sha256, { token, base })) {
      await store.deleteTrip(id);
    } else {
      waitFor(pauseToDelete_s);
    }
  }
  return again_s;
}

// Deletes a trip on this phone; one that the server may have is withdrawn: the next sending deletes it there.
export async function deleteHere(store, id) {
  const entry = await store.changeTrip(id, (trip) => ({ ...trip, state: 'withdrawn' }), { dropsLog: true });
  if (!(entry?.attempt > 0)) {
    await store.deleteTrip(id);
  }
}
