import { element } from '../dom.js';
import { endFound, goOn } from '../driving.js';
import { button, dateOf, heading, number, words } from '../page.js';
import { recordedFor_ms } from '../trips.js';

// A trip that a crash or an empty battery interrupted.
export function foundView(recorder, trip, chunks) {
  const min = number(recordedFor_ms(chunks) / 60000, 1);
  return [
    heading('found_heading'), element('p', {}, words('found_text', { date: dateOf(trip.begun_ms), min })),
    button('go_on', () => goOn(recorder, trip), { class: 'main' }), button('end_now', () => endFound(recorder, trip)),
  ];
}
