// The recorder's page: what it shows first.
import { takeInvitation } from './sending/invitation.js';
import { show, speak } from './page.js';
import { holdRecording } from './recording_lock.js';
import { Sender } from './sending/sender.js';
import { ServerTrips } from './sending/server_trips.js';
import { TripStore } from './trip_store.js';
import { carView } from './views/car.js';
import { foundView } from './views/found.js';
import { homeView } from './views/home.js';
import { privacyView } from './views/privacy.js';
import { redrawTrips } from './views/trip_list.js';

const base = new URL('../', location.href); // of the server
const store = await TripStore.open();
const atServer = new ServerTrips(store, base, () => redrawTrips(recorder));
const sender = new Sender(store, base, async () => {
  await redrawTrips(recorder);
  await atServer.refresh();
});
const recorder = { store, sender, atServer, begin, home: () => show(homeView, recorder) };

// Shows what comes next: the privacy page, the car, an interrupted trip, or home.
async function begin() {
  if (!(await store.setting('understood'))) {
    return show(privacyView, recorder);
  }
  if (!(await store.setting('vehicle_id'))) {
    return show(carView, recorder);
  }
  const open = (await store.trips()).find((trip) => trip.state === 'recording');
  const letGo = open && (await holdRecording());
  if (letGo) { // no other page is at it
    await letGo();
    return show(foundView, recorder, open, await store.chunks(open.id));
  }
  return recorder.home();
}

speak(await store.setting('language'), (language) => store.setSetting('language', language));
await begin();
await takeInvitation(store, base);
addEventListener('hashchange', async () => { // the link was opened in this page
  await takeInvitation(store, base);
  await sender.send();
});
addEventListener('online', () => sender.send());
addEventListener('offline', () => redrawTrips(recorder));
document.addEventListener('visibilitychange', () => document.hidden || atServer.refresh());
sender.send();
navigator.serviceWorker?.register('service_worker.js');
