// Pictures of numbers, each with its words beside it: the class scale, the history, the distribution.
import { el } from './dom.js';
import { className, day, inUnit, interval, iri, iriUnit, metres, month, number, roadLength, w } from './words.js';

const round = (value) => value.toFixed(1);

// IRI with its interval on the scale of the classes.
export function classScale(classes, { iri: value, iri_low: low, iri_high: high }) {
  const [width, height] = [340, 54];
  const last = classes.at(-2)?.below ?? 4;
  const most = Math.max(last * 1.8, high * 1.08);
  const x = (mmPerM) => Math.max(0, Math.min(width, mmPerM / most * width));
  const parts = [];
  let from = 0;
  for (const { name, below, colour } of classes) {
    const to = below ?? most;
    parts.push(el('rect', { x: round(x(from)), y: 22, width: round(x(to) - x(from)), height: 12, fill: colour }, el('title', {}, className(name))));
    if (below) parts.push(el('text', { x: round(x(below)), y: 50, 'text-anchor': 'middle', class: 'tick' }, iri(below)));
    from = to;
  }
  return el('svg', { viewBox: `0 0 ${width} ${height}`, class: 'chart', role: 'img', 'aria-label': `${iri(value)} ${iriUnit()}, ${w('site.interval')} ${interval(low, high)}` },
    ...parts,
    el('rect', { x: 0, y: 22, width, height: 12, class: 'outline' }),
    el('line', { x1: round(x(low)), x2: round(x(high)), y1: 12, y2: 12, class: 'interval' }),
    el('line', { x1: round(x(low)), x2: round(x(low)), y1: 7, y2: 17, class: 'interval' }),
    el('line', { x1: round(x(high)), x2: round(x(high)), y1: 7, y2: 17, class: 'interval' }),
    el('path', { d: `M${round(x(value))} 37l-5-9v-12h10v12z`, class: 'marker' }));
}

// Value by month with its 90 % band; a step where the road changed.
export function history(months, changed) {
  const [width, height, left, bottom, top] = [340, 130, 34, 22, 8];
  const numbers = months.map(({ month: each }) => Number(each.slice(0, 4)) * 12 + Number(each.slice(5)) - 1);
  const [first, last] = [numbers[0], numbers.at(-1)];
  const most = Math.max(1, ...months.map(({ iri_high: high }) => high)) * 1.05;
  const x = (at) => left + (last === first ? 0.5 : (at - first) / (last - first)) * (width - left - 12);
  const y = (mmPerM) => top + (1 - mmPerM / most) * (height - top - bottom);
  const points = months.map(({ iri: value, iri_low: low, iri_high: high }, i) => ({ x: round(x(numbers[i])), y: round(y(value)), low: round(y(Math.max(0, low))), high: round(y(high)) }));
  const ticks = [0, 0.5, 1].map((part) => part * most / 1.05);
  const changeAt = changed ? Number(changed.slice(0, 4)) * 12 + Number(changed.slice(5, 7)) - 1 : null;
  return el('svg', { viewBox: `0 0 ${width} ${height}`, class: 'chart', role: 'img', 'aria-label': w('site.history') },
    ...ticks.map((value) => el('g', {}, el('line', { x1: left, x2: width, y1: round(y(value)), y2: round(y(value)), class: 'grid' }),
      el('text', { x: left - 4, y: round(y(value) + 4), 'text-anchor': 'end', class: 'tick' }, number(inUnit(value), inUnit(1) > 2 ? 0 : 1)))),
    el('path', { d: `M${points.map((p) => `${p.x} ${p.high}`).join('L')}L${[...points].reverse().map((p) => `${p.x} ${p.low}`).join('L')}Z`, class: 'band' }),
    changeAt !== null && changeAt >= first && changeAt <= last && el('line', { x1: round(x(changeAt)), x2: round(x(changeAt)), y1: top, y2: height - bottom, class: 'change' }),
    el('path', { d: `M${points.map((p) => `${p.x} ${p.y}`).join('L')}`, class: 'line' }),
    ...points.map((p, i) => el('g', {}, el('line', { x1: p.x, x2: p.x, y1: p.high, y2: p.low, class: 'whisker' }), el('circle', { cx: p.x, cy: p.y, r: 3, class: 'dot' },
      el('title', {}, `${month(months[i].month)}: ${iri(months[i].iri)} (${interval(months[i].iri_low, months[i].iri_high)})`)))),
    el('text', { x: left, y: height - 6, class: 'tick' }, month(months[0].month)),
    last > first && el('text', { x: width - 2, y: height - 6, 'text-anchor': 'end', class: 'tick' }, month(months.at(-1).month)));
}

export function historyTable(months) {
  return el('table', {}, el('caption', { class: 'hidden' }, w('site.history')),
    el('thead', {}, el('tr', {}, ...['site.month', 'site.iri', 'site.interval', 'site.passes', 'site.cars'].map((key) => el('th', { scope: 'col' }, w(key))))),
    el('tbody', {}, ...months.map((each) => el('tr', {}, el('th', { scope: 'row' }, month(each.month)), el('td', {}, iri(each.iri)),
      el('td', {}, interval(each.iri_low, each.iri_high)), el('td', {}, each.passes), el('td', {}, each.vehicles)))));
}

// Kilometres by IRI, coloured by class. `bins`: number of the bin to kilometres.
export function distribution(bins, binMmPerM, classes) {
  const [width, height, bottom] = [280, 110, 20];
  const last = Math.max(12, ...bins.keys());
  const most = Math.max(...bins.values(), 1e-9);
  const step = width / (last + 1);
  const colourAt = (mmPerM) => (classes.find(({ below }) => below === null || mmPerM < below) ?? classes.at(-1)).colour;
  const total = [...bins.values()].reduce((sum, km) => sum + km, 0);
  return el('svg', { viewBox: `0 0 ${width} ${height}`, class: 'chart', role: 'img', 'aria-label': `${w('site.distribution')}: ${roadLength(total)}` },
    ...[...bins].map(([bin, km]) => {
      const tall = km / most * (height - bottom - 4);
      return el('rect', { x: round(bin * step), y: round(height - bottom - tall), width: round(Math.max(1, step - 1)), height: round(tall), fill: colourAt((bin + 0.5) * binMmPerM), class: 'bar' },
        el('title', {}, `${iri(bin * binMmPerM)} – ${bin === 47 ? '' : iri((bin + 1) * binMmPerM)}: ${roadLength(km)}`));
    }),
    el('line', { x1: 0, x2: width, y1: height - bottom, y2: height - bottom, class: 'axis' }),
    ...[0, 4, 8, 12, 16, 20, 28, 36, 44].filter((bin) => bin <= last).map((bin) => el('text', { x: round(bin * step), y: height - 5, 'text-anchor': bin ? 'middle' : 'start', class: 'tick' },
      number(inUnit(bin * binMmPerM), 0))));
}

export const seen = ({ first_seen: first, last_seen: last }) => (first ? (first === last ? day(first) : w('period', { first: day(first), last: day(last) })) : '–');

// IRI by distance with its 90 % band and classes; `mark` shades what lies outside of a part.
export function profile(steps, classes) {
  const [width, height, left, bottom, top] = [340, 150, 34, 22, 8];
  const total = steps.at(-1).to;
  const most = Math.max(1, ...steps.map(({ segment }) => segment.iri_high)) * 1.05;
  const x = (at) => left + at / total * (width - left - 6);
  const y = (mmPerM) => top + (1 - Math.max(0, mmPerM) / most) * (height - top - bottom);
  const edge = (key) => steps.map(({ segment, from, to }) => `${round(x(from))} ${round(y(segment[key]))}L${round(x(to))} ${round(y(segment[key]))}`);
  const outside = [0, 1].map(() => el('rect', { y: top, height: height - top - bottom, class: 'outside' }));
  const colourOf = (segment) => classes.find(({ name }) => name === segment.class)?.colour ?? classes.at(-1).colour;
  const node = el('svg', { viewBox: `0 0 ${width} ${height}`, class: 'chart', role: 'img', 'aria-label': w('site.profile') },
    ...[0, 0.5, 1].map((part) => part * most / 1.05).map((value) => el('g', {}, el('line', { x1: left, x2: width, y1: round(y(value)), y2: round(y(value)), class: 'grid' }),
      el('text', { x: left - 4, y: round(y(value) + 4), 'text-anchor': 'end', class: 'tick' }, number(inUnit(value), inUnit(1) > 2 ? 0 : 1)))),
    el('path', { d: `M${edge('iri_high').join('L')}L${steps.map(({ segment, from, to }) => `${round(x(to))} ${round(y(segment.iri_low))}L${round(x(from))} ${round(y(segment.iri_low))}`).reverse().join('L')}Z`, class: 'band' }),
    el('path', { d: `M${edge('iri').join('L')}`, class: 'line' }),
    ...steps.map(({ segment, from, to }) => el('rect', { x: round(x(from)), y: height - bottom, width: round(Math.max(0.5, x(to) - x(from))), height: 5, fill: colourOf(segment) })),
    ...outside,
    el('text', { x: left, y: height - 3, class: 'tick' }, metres(0)),
    el('text', { x: width - 2, y: height - 3, 'text-anchor': 'end', class: 'tick' }, total < 2000 ? metres(total) : roadLength(total / 1000)));
  const place = (rect, from, to) => { rect.setAttribute('x', round(x(from))); rect.setAttribute('width', round(Math.max(0, x(to) - x(from)))); };
  return { node, mark(from, to) { place(outside[0], 0, from); place(outside[1], Math.min(to, total), total); } };
}
