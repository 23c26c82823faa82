// Roughness along a route: the drawing by distance, its two movable ends, and the table of the same.
import { profile } from './charts.js';
import { csvRow } from './csv.js';
import { download, el, replace } from './dom.js';
import { interval, iri, iriUnit, metres, roadLength, roadName, w } from './words.js';

// Places of the segments along a route, in metres from its start.
export function alongRoute(route) {
  let at = 0;
  return route.map((segment) => {
    const from = at;
    at += segment.metres;
    return { segment, from, to: at };
  });
}

// Means over a part, weighted by length. The interval is the mean of the intervals: that of errors which all segments share, the widest it can be.
export function partOf(steps, from, to) {
  const sums = { metres: 0, iri: 0, iri_low: 0, iri_high: 0 };
  let worst = null;
  for (const each of steps) {
    const inside = Math.min(each.to, to) - Math.max(each.from, from);
    if (inside <= 0) continue;
    sums.metres += inside;
    for (const key of ['iri', 'iri_low', 'iri_high']) sums[key] += inside * each.segment[key];
    if (!worst || each.segment.iri > worst.segment.iri) worst = each;
  }
  const mean = (key) => (sums.metres > 0 ? sums[key] / sums.metres : null);
  return { metres: sums.metres, iri: mean('iri'), iri_low: mean('iri_low'), iri_high: mean('iri_high'), worst };
}

function csv(steps) {
  return ['from_m,to_m,segment,name,iri,iri_low,iri_high,passes\n', ...steps.map(({ segment: each, from, to }) =>
    csvRow([from.toFixed(1), to.toFixed(1), each.segment, each.name, each.iri, each.iri_low, each.iri_high, each.passes]))];
}

function table(steps, open) {
  return el('table', { id: 'profile-table' }, el('caption', { class: 'hidden' }, w('site.profile')),
    el('thead', {}, el('tr', {}, ...['site.distance', 'site.road', 'site.iri', 'site.interval'].map((key) => el('th', { scope: 'col' }, w(key))))),
    el('tbody', {}, ...steps.map(({ segment, from }) => el('tr', {}, el('td', {}, metres(from)),
      el('th', { scope: 'row' }, el('button', { type: 'button', class: 'plain', onclick: () => open(segment.segment) }, roadName(segment))),
      el('td', {}, iri(segment.iri)), el('td', {}, interval(segment.iri_low, segment.iri_high))))));
}

// `act`: show(lines) the part on the map, open(id) a segment.
function chart(route, site, act) {
  const steps = alongRoute(route);
  const total = steps.at(-1).to;
  const step = 10; // metres that an arrow key moves an end
  const whole = Math.ceil(total / step) * step;
  const drawing = profile(steps, site.classes);
  const summary = el('div', { role: 'status', id: 'profile-part' });
  const slider = (id, value) => el('input', { type: 'range', id, min: '0', max: String(whole), step: String(step), value: String(value), oninput: () => move(id) });
  const ends = [slider('profile-from', 0), slider('profile-to', whole)];
  const values = ends.map(() => el('span', { class: 'quiet', 'aria-hidden': 'true' }));
  const rows = el('div', { class: 'scroll', tabIndex: 0, role: 'group', 'aria-label': w('site.profile') });
  const move = (moved) => {
    let [from, to] = ends.map((each) => Number(each.value));
    if (from > to - step) { // they push each other along
      if (moved === 'profile-to') ends[0].value = from = Math.max(0, to - step); else ends[1].value = to = Math.min(whole, from + step);
    }
    ends.forEach((each, i) => {
      each.setAttribute('aria-valuetext', metres(Math.min(total, Number(each.value))));
      values[i].textContent = metres(Math.min(total, Number(each.value)));
    });
    const part = partOf(steps, from, to);
    const inside = steps.filter((each) => each.to > from && each.from < to);
    drawing.mark(from, to);
    replace(summary, el('p', { class: 'value' }, el('strong', {}, iri(part.iri)), ` ${iriUnit()} IRI`),
      el('dl', {}, el('dt', {}, w('site.interval')), el('dd', {}, interval(part.iri_low, part.iri_high)),
        el('dt', {}, w('site.length')), el('dd', {}, roadLength(part.metres / 1000)),
        part.worst && el('dt', {}, w('site.worst_of')), part.worst && el('dd', {}, `${iri(part.worst.segment.iri)} · ${metres(part.worst.from)}`)));
    replace(rows, table(inside, act.open));
    act.show(inside.map(({ segment }) => segment.line));
  };
  const field = (label, i) => el('label', { class: 'field end-of', for: ends[i].id }, el('span', {}, label), ends[i], values[i]);
  move();
  return [summary, drawing.node, field(w('site.part_from'), 0), field(w('site.part_to'), 1),
    el('details', {}, el('summary', {}, w('site.as_table')), rows),
    el('p', {}, el('button', { type: 'button', onclick: () => download('profile.csv', 'text/csv', csv(steps)) }, w('site.profile_csv')))];
}

// What the drawer says of a route: `names` of its points, `route` its segments or null, `why` there is none.
export function routeDetail({ names, route, why }, site, act) {
  return [
    el('h2', { id: 'drawer-title', tabIndex: -1 }, w('site.profile')),
    names.length > 0 && el('ol', { class: 'points' }, ...names.map((name, i) => el('li', {}, el('div', {}, el('span', {}, name),
      el('button', { type: 'button', 'aria-label': `${w('site.remove_point')}: ${name}`, onclick: () => act.remove(i) }, '×'))))),
    why && el('p', { role: 'status' }, why),
    ...(route ? chart(route, site, act) : []),
    el('div', { class: 'actions' },
      names.length > 1 && el('button', { type: 'button', onclick: act.reverse }, w('site.reverse_route')),
      route && el('button', { type: 'button', onclick: (event) => act.copy(event.currentTarget) }, w('site.copy_link')),
      el('button', { type: 'button', onclick: act.end }, w('site.end_route'))),
  ].filter(Boolean);
}
