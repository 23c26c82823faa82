import { joined } from './recording.js';
import { fixColumn, fixWidth, motionWidth } from './samples.js';
import { drawCount } from './trimming.js';
import { tripLog } from './trip_log.js';
import { sendTrip, sha256Hex } from './upload.js';

// States of a trip: recording, ended (the log is on the phone), too_short, queued (to be sent), received, gone (deleted
// at the server after it was received).

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
  const blob = new Blob(log.parts, { type: 'text/csv' });
  const ended = {
    ...entry,
    state: 'ended',
    begun_ms: log.begin_ms,
    end_ms: log.end_ms,
    length_m: log.length_m,
    sha256: await sha256Hex(await blob.arrayBuffer()),
  };
  await store.finish(ended, blob);
  return ended;
}

export const fileName = (trip) =>
  `${new Date(trip.begun_ms).toISOString().slice(0, 16).replace(/[-:]/g, '')}-${trip.id}.trip.csv`;

// Sends all queued trips, one after the other. Returns when to try again (s); null: nothing waits.
export async function sendQueued(store, { token, base, onChange }) {
  let again_s = null;
  for (const trip of await store.trips()) {
    if (trip.state !== 'queued') {
      continue;
    }
    onChange(trip, 'sending');
    const body = await store.log(trip.id);
    const attempt = trip.attempt ?? 0;
    await store.putTrip({ ...trip, attempt: attempt + 1 }); // so that a crash from here on asks the server first
    const answer = await sendTrip({ sha256: trip.sha256, body, attempt }, { token, base });
    const { problem, reason, ...entry } = trip;
    if (answer.outcome === 'received') {
      await store.received({ ...entry, state: 'received', attempt: attempt + 1 });
    } else if (answer.outcome === 'later') {
      again_s = Math.min(again_s ?? Infinity, answer.after_s);
    } else {
      await store.putTrip({ ...entry, state: 'ended', problem: answer.outcome, reason: answer.reason, attempt: attempt + 1 });
    }
    onChange(trip, answer.outcome);
  }
  return again_s;
}
