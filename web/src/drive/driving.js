// Begins, goes on with and ends trips.
import { element } from './dom.js';
import { heading, say, show, words } from './page.js';
import { holdRecording } from './recording_lock.js';
import { askForMotion } from './sensors.js';
import { recordTrip } from './trip_recorder.js';
import { endTrip, newTrip } from './trips.js';

let isStarting = false;

const showWorking = () => show(() => [heading('driving'), element('p', {}, words('working'))]);

const end = (store, trip) => endTrip(store, trip, navigator.userAgent);

// Answers a tap on "Start trip". What was said of the try before is gone at once.
export async function startTrip(recorder) {
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
      await withRecording((letGo) => startNewTrip(recorder, letGo));
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

async function startNewTrip(recorder, letGo) {
  const { store } = recorder;
  const trip = newTrip(Date.now(), await store.setting('vehicle_id'), await store.setting('car'));
  try {
    await store.putTrip(trip);
  } catch {
    say(words('no_room'));
    return false;
  }
  await record(recorder, trip, [], letGo);
  return true;
}

// Records until the driver ends the trip. before: chunks that the trip has already; letGo: lets other pages record again.
async function record({ store, home }, trip, before, letGo) {
  say('');
  await recordTrip(store, trip, before, async (written) => {
    await showWorking();
    await written;
    await end(store, trip);
    await letGo();
    await home();
  });
}

// Does something with an interrupted trip. Another page may have gone on with it, or ended it, since this one was drawn.
async function withFound({ store, begin }, trip, work) {
  const goesOn = await withRecording(async (letGo) => {
    const now = (await store.trips()).find(({ id, state }) => id === trip.id && state === 'recording');
    return now ? work(now, letGo) : false;
  });
  if (!goesOn) {
    await begin();
  }
}

export async function goOn(recorder, trip) {
  say('');
  if (!(await askForMotion())) {
    say(words('no_leave_motion'));
    return;
  }
  await withFound(recorder, trip, async (now, letGo) => {
    await record(recorder, now, await recorder.store.chunks(now.id), letGo);
    return true;
  });
}

export async function endFound(recorder, trip) {
  say('');
  await withFound(recorder, trip, async (now) => {
    await showWorking();
    await end(recorder.store, now);
    return false;
  });
}
