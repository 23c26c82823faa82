import { element } from '../dom.js';
import { startTrip } from '../driving.js';
import { button, heading, show, words } from '../page.js';
import { carView } from './car.js';
import { privacyView } from './privacy.js';
import { tripList } from './trip_list.js';

// Where a trip begins, with the trips before.
export async function homeView(recorder) {
  return [
    heading('ready_heading'), element('p', {}, words('ready_text')),
    button('start', () => startTrip(recorder), { class: 'main' }),
    element('div', { class: 'deeds' },
      button('car_heading', () => show(carView, recorder), { class: 'plain' }),
      button('privacy_again', () => show(privacyView, recorder), { class: 'plain' }),
      element('a', { class: 'plain', href: '../' }, words('to_map'))),
    element('h2', { id: 'trips-heading', tabindex: '-1' }, words('trips')),
    await tripList(recorder),
  ];
}
