// What is known of a road that was picked.
import { classScale, history, historyTable, seen } from './charts.js';
import { csvRow } from './csv.js';
import { parseId } from './data.js';
import { download, el } from './dom.js';
import { link } from './state.js';
import { className, day, interval, iri, iriChange, iriUnit, kind, metres, roadLength, roadName, w } from './words.js';

const z90 = 1.645;
const headings = ['N', 'NE', 'E', 'SE', 'S', 'SW', 'W', 'NW'];

function heading(line) {
  const [[lon1, lat1], [lon2, lat2]] = [line[0], line.at(-1)];
  const course = Math.atan2((lon2 - lon1) * Math.cos(lat1 * Math.PI / 180), lat2 - lat1) * 180 / Math.PI;
  return w(`heading.${headings[Math.round((course + 360) / 45) % 8]}`);
}

export const neighbour = (id, step) => {
  const { way, backward, index } = parseId(id);
  const next = index + step * (backward ? -1 : 1);
  return next < 0 ? null : `${way}${backward ? '-' : '+'}${String(next).padStart(4, '0')}`;
};

const withoutLists = ([, value]) => typeof value !== 'object' || value === null;

// Segments as rows of CSV; the first call for a file has the names of the columns.
export function csvRows(segments, withHead) {
  const rows = segments.map((segment) => {
    const [lon, lat] = segment.line[0];
    return [...Object.entries(segment).filter(withoutLists), ['lon_deg', lon], ['lat_deg', lat]];
  });
  const head = withHead && rows.length > 0 ? [rows[0].map(([name]) => name)] : [];
  return [...head, ...rows.map((each) => each.map(([, value]) => value))].map(csvRow).join('');
}

function historyCsv({ segment, months }) {
  return ['segment,month,iri,iri_sd,iri_low,iri_high,passes,vehicles\n', ...months.map((each) => csvRow([segment, ...Object.values(each)]))];
}

const row = (label, ...value) => [el('dt', {}, label), el('dd', {}, ...value)];

function trendWords({ trend_per_year: trend, trend_sd: sd }) {
  const isSure = trend !== null && trend !== undefined && sd !== null && Math.abs(trend) > z90 * sd;
  return isSure ? row(w('site.trend'), w('site.per_year', { value: `${iriChange(trend)} ${iriUnit()}` })) : [];
}

export function segmentDetail(segment, site, act) {
  const road = roadName(segment);
  const direction = heading(segment.line);
  const months = segment.months ?? [];
  return [
    el('h2', { id: 'drawer-title', tabIndex: -1 }, road),
    el('p', { class: 'quiet' }, `${kind(segment.highway)} · ${w('site.towards', { heading: direction })}`),
    el('p', { class: 'value' }, el('strong', {}, iri(segment.iri)), ` ${iriUnit()} IRI · ${className(segment.class)}`),
    classScale(site.classes, segment),
    el('dl', {},
      row(w('site.interval'), interval(segment.iri_low, segment.iri_high)),
      row(w('site.evidence'), `${w('site.passes_by', { count: segment.passes })}, ${w('cars', { count: segment.vehicles })}`),
      row(w('site.seen'), seen(segment)),
      row(w('site.chainage'), `${metres(segment.from_m)} – ${metres(segment.to_m)}`),
      trendWords(segment),
      segment.changed ? row(w('site.changed'), `${day(segment.changed)}: ${iriChange(segment.change)} ${iriUnit()}`) : [],
      segment.validity && segment.validity !== 'ok' && segment.validity.includes('indicative') ? row(w('site.note'), w('site.indicative')) : [],
      row(w('site.segment'), el('code', {}, segment.segment))),
    el('h3', {}, w('site.history')),
    months.length === 0 ? el('p', { class: 'quiet' }, w('site.no_history'))
      : [history(months, segment.changed), el('details', {}, el('summary', {}, w('site.as_table')), el('div', { class: 'scroll', tabIndex: 0, role: 'group', 'aria-label': w('site.history') }, historyTable(months)))],
    el('div', { class: 'actions' },
      el('button', { type: 'button', onclick: () => act.step(-1) }, `◂ ${w('site.back_along')}`),
      el('button', { type: 'button', onclick: () => act.step(1) }, `${w('site.on_along')} ▸`),
      act.route && el('button', { type: 'button', onclick: act.route.add }, w(act.route.isOn ? 'site.route_to' : 'site.route_from')),
      el('button', { type: 'button', onclick: (event) => act.copy(link(), event.currentTarget) }, w('site.copy_link')),
      el('button', { type: 'button', onclick: () => download(`${segment.segment}.csv`, 'text/csv', historyCsv(segment)) }, w('site.csv'))),
  ];
}

// Joined segments, as the map shows them from afar.
export function runDetail(run, act) {
  return [
    el('h2', { id: 'drawer-title', tabIndex: -1 }, roadName(run)),
    el('p', { class: 'quiet' }, kind(run.highway)),
    el('p', { class: 'value' }, el('strong', {}, iri(run.iri)), ` ${iriUnit()} IRI · ${className(run.class)}`),
    el('dl', {}, row(w('site.length'), roadLength(run.length_m / 1000)), row(w('site.worst_of'), `${iri(run.iri_worst)} ${iriUnit()}`),
      row(w('site.evidence'), w('site.at_least', { passes: w('site.passes_by', { count: run.passes }) }))),
    el('div', { class: 'actions' }, el('button', { type: 'button', onclick: act.zoomIn }, w('site.zoom_to_segments'))),
  ];
}

// Several roads at the place of a click.
export function choice(found, act) {
  return [
    el('h2', { id: 'drawer-title', tabIndex: -1 }, w('site.which')),
    el('ul', { class: 'choices' }, ...found.map((each) => el('li', {}, el('button', { type: 'button', onclick: () => act.open(each) },
      `${roadName(each)}${each.direction ? `, ${w(`site.${each.direction}`)}` : ''}: ${iri(each.iri)} ${iriUnit()}`)))),
  ];
}

