import { Odometer } from './odometer.js';
import { show } from './page.js';
import { placeOf } from './places.js';
import { QualityWatch } from './quality.js';
import { Recording } from './recording.js';
import { fixColumn } from './samples.js';
import { keepAwake, listen } from './sensors.js';
import { drivePanel } from './views/drive_panel.js';

const refresh_ms = 1000;
const flush_ms = 2000;
const permissionDenied = 1; // of GeolocationPositionError; the others are gaps of the receiver

// Writes chunks of a trip to the phone's disk, after those that it has already.
function chunkWriter(store, trip, before, onFailure) {
  let seq = before.length === 0 ? 0 : before.at(-1).seq + 1;
  const writes = new Set();
  return {
    add(chunk) {
      const write = store.addChunk(trip.id, seq++, chunk).catch(onFailure).finally(() => writes.delete(write));
      writes.add(write);
    },
    written: () => Promise.all(writes),
  };
}

// Callbacks of the sensors, which pass readings on and keep the figures of the trip's state.
function listeners(state, recording, watch, odometer) {
  const seen = (t_ms) => {
    state.begun_ms ??= t_ms;
    state.now_ms = Math.max(state.now_ms, t_ms);
  };
  return {
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
      odometer.add(placeOf(row, row[fixColumn.stamp_ms]));
      state.length_m = odometer.length_m;
    },
    onPositionError: ({ code }) => {
      state.isPositionRefused = code === permissionDenied;
    },
  };
}

// Records a trip, and shows how it goes, until the driver ends it. before: chunks that the trip has already;
// onEnd(written): what comes then; written: resolves when all readings are on the disk.
export async function recordTrip(store, trip, before, onEnd) {
  navigator.storage?.persist?.();
  const state = { length_m: 0, awake: false, failed: false, isPositionRefused: false, begun_ms: null, now_ms: 0 };
  const watch = new QualityWatch();
  const writer = chunkWriter(store, trip, before, () => {
    state.failed = true;
  });
  const recording = new Recording({ timeOrigin_ms: performance.timeOrigin, onChunk: writer.add });
  const stopListening = listen(listeners(state, recording, watch, new Odometer()));
  const flush = () => recording.flush();
  const flushTimer = setInterval(flush, flush_ms);
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
    await onEnd(writer.written());
  });
  const draw = () => panel.draw(state, watch.assess(performance.now(), { isHidden: document.hidden }));
  const drawTimer = setInterval(draw, refresh_ms);
  await show(() => panel.content());
  draw();
}
