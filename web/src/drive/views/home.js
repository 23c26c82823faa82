import { element } from '../dom.js';
import { startTrip } from '../driving.js';
import { button, heading, show, words } from '../page.js';
import { carView } from './car.js';
import { privacyView } from './privacy.js';
import { tripLines } from './trip_lines.js';

// Where a trip begins, with the trips before.
export async function homeView(recorder) {
  const trips = (await recorder.store.trips()).filter((trip) => trip.state !== 'recording').sort((a, b) => b.begun_ms - a.begun_ms);
  const items = trips.map((trip) => element('li', {}, ...tripLines(recorder, trip)));
  return [
    heading('ready_heading'), element('p', {}, words('ready_text')),
    button('start', () => startTrip(recorder), { class: 'main' }),
    element('h2', {}, words('trips')),
    items.length > 0 ? element('ul', { class: 'trips' }, ...items) : element('p', { class: 'soft' }, words('no_trips')),
    element('div', { class: 'deeds' },
      button('car_heading', () => show(carView, recorder), { class: 'plain' }),
      button('privacy_again', () => show(privacyView, recorder), { class: 'plain' }),
      element('a', { class: 'plain', href: '../' }, words('to_map'))),
  ];
}
