import { element } from '../dom.js';
import { dateOf, words } from '../page.js';
import { mergedTrips } from '../sending/server_trips.js';
import { tripLines } from './trip_lines.js';

// Whether the fates are old ones, and why.
function staleLine(problem, { asked_ms }) {
  const key = !navigator.onLine || problem === 'unreachable' ? 'old_fates' : problem === 'no_leave' ? 'old_fates_no_leave' : null;
  return key && asked_ms > 0 ? element('p', { class: 'soft' }, words(key, { date: dateOf(asked_ms) })) : null;
}

async function listElements(recorder) {
  const known = await recorder.atServer.known();
  const items = mergedTrips(await recorder.store.trips(), known).map((trip) => element('li', {}, ...tripLines(recorder, trip).filter(Boolean)));
  return [
    staleLine(recorder.atServer.problem, known),
    items.length > 0 ? element('ul', { class: 'trips' }, ...items) : element('p', { class: 'soft' }, words('no_trips')),
  ].filter(Boolean);
}

export const tripList = async (recorder) => element('div', { id: 'trips' }, ...(await listElements(recorder)));

// Draws the list anew where it is shown. The focus stays at its button, or goes to the heading of the list.
export async function redrawTrips(recorder) {
  const next = await listElements(recorder);
  const list = document.getElementById('trips');
  if (!list || list.innerHTML === next.map(({ outerHTML }) => outerHTML).join('')) {
    return;
  }
  const focused = list.contains(document.activeElement) ? document.activeElement.id : null;
  list.replaceChildren(...next);
  if (focused) {
    (document.getElementById(focused) ?? document.getElementById('trips-heading')).focus();
  }
}
