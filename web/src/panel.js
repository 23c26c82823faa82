// The left panel: mode, legend as filter, worst sections, what is in view, export.
import { distribution } from './charts.js';
import { download, el, option, replace } from './dom.js';
import { csvRows } from './drawer.js';
import { isFiltered, kilometres, noKind, passSteps, shows } from './filter.js';
import { choose, hidden, state, toggle } from './state.js';
import { className, interval, iri, iriUnit, kind, month, number, roadLength, roadName, w } from './words.js';

const bytesOfRow = { csv: 190, geojson: 750 };
const featureText = ({ line, months, ...properties }) => JSON.stringify({ type: 'Feature', geometry: { type: 'LineString', coordinates: line }, properties });
const swatch = (colour) => el('svg', { class: 'swatch', viewBox: '0 0 20 12', 'aria-hidden': 'true' }, el('rect', { x: 0.5, y: 0.5, width: 19, height: 11, fill: colour }));

function section(id, title, ...content) {
  return el('section', { id, 'aria-labelledby': `${id}-title` }, el('h2', { id: `${id}-title` }, title), ...content);
}

function modes() {
  const names = ['roughness', 'confidence', 'change'];
  return el('fieldset', { class: 'modes' }, el('legend', {}, w('site.show')), ...names.map((name) => el('label', {},
    el('input', { type: 'radio', name: 'mode', value: name, checked: state.mode === name, onchange: () => choose({ mode: name }) }), w(`site.mode.${name}`))));
}

const check = (isOn, toggleIt, label, colour, km) => el('li', {}, el('label', {}, el('input', { type: 'checkbox', checked: isOn, onchange: toggleIt }),
  colour && swatch(colour), el('span', {}, label), el('output', {}, roadLength(km))));

function range(classes, i) {
  const [from, to] = [classes[i - 1]?.below, classes[i].below];
  return from === undefined ? (to === null ? w('range.all') : w('range.below', { to: iri(to) })) : to === null ? w('range.above', { from: iri(from) }) : interval(from, to);
}

export function openPanel(place, data, totals, worst, act) {
  const { site } = data;
  const legend = el('div', {});
  const peek = el('ul', { class: 'peek keys', 'aria-hidden': 'true' }); // all of the legend that the low sheet of a phone has room for
  const view = el('div', {});
  const exporting = el('div', {});
  const compare = el('p', { class: 'quiet', role: 'status' });
  let comparing = null;
  let isAfar = false; // the map joins segments
  const routeButton = el('button', { type: 'button', 'aria-pressed': 'false', onclick: () => act.toggleRoute() }, w('site.choose_route'));

  function drawLegend() {
    const classKm = kilometres(totals, site, ({ inClass }) => inClass, 'c');
    const kindKm = kilometres(totals, site, ({ highway }) => highway, 'h');
    const totalKm = [...kilometres(totals, site, () => 0).values()][0] ?? 0;
    const key = (mark, label) => el('li', {}, mark, label);
    const chip = (step, label) => key(el('span', { class: `chip ${step}` }), label);
    const isSwiped = state.mode === 'change' && state.swipe === 'on';
    const classKeys = site.classes.map(({ name, colour }) => key(swatch(colour), className(name)));
    replace(peek, isSwiped ? [...classKeys, chip('unsure', w('site.change.unsure'))] : state.mode === 'change' ? ['better', 'worse', 'unsure'].map((step) => chip(step, w(`site.change.${step}`)))
      : state.mode === 'confidence' ? [chip('high', w('site.narrow.0')), chip('mid', w('site.narrow.1')), chip('low', w('site.confidence.low'))]
        : classKeys);
    const focused = document.activeElement?.dataset?.key;
    replace(legend,
      modes(),
      state.mode === 'change' && comparison(),
      state.mode === 'confidence' && el('ul', { class: 'keys' }, ...['high', 'mid', 'low'].map((step) => el('li', {}, el('span', { class: `chip ${step}` }), w(`site.confidence.${step}`)))),
      el('fieldset', {}, el('legend', {}, `${w('site.classes')}, ${iriUnit()}`), el('ul', { class: 'checks' }, ...site.classes.map(({ name, colour }, i) =>
        check(!hidden('c').has(name), () => toggle('c', name), `${className(name)} (${range(site.classes, i)})`, colour, classKm.get(i) ?? 0)))),
      el('details', { open: state.h !== '' || legend.querySelector('details')?.open }, el('summary', {}, w('site.kinds')), el('ul', { class: 'checks' }, ...site.highways.map((highway, i) =>
        check(!hidden('h').has(highway || noKind), () => toggle('h', highway || noKind), `${kind(highway)}${/_link$/.test(highway) ? ` (${w('site.slip_road')})` : ''}`, null, kindKm.get(i) ?? 0)))),
      el('label', { class: 'field' }, w('site.min_passes'), el('select', { onchange: (event) => choose({ p: Number(event.target.value) }) },
        ...passSteps.map((passes) => option(String(passes), String(passes), String(state.p))))),
      el('label', { class: 'field' }, w('site.min_confidence'), el('select', { onchange: (event) => choose({ q: Number(event.target.value) }) },
        ...[2, 1, 0].map((step) => option(String(step), w(`site.narrow.${step}`), String(state.q))))),
      state.q < 2 && isAfar && el('p', { class: 'quiet' }, w('site.confidence_afar')),
      el('p', { class: 'total', role: 'status' }, w('site.shown', { km: roadLength(totalKm), total: roadLength(site.km) }),
        isFiltered() && el('button', { type: 'button', onclick: () => choose({ c: '', h: '', p: 1, q: 2 }) }, w('site.reset'))));
    for (const input of legend.querySelectorAll('input, select')) input.dataset.key = `${input.name || input.tagName}${input.closest('label').textContent.replace(/[\d.,]+ (km|mi)$/, '')}`;
    if (focused) [...legend.querySelectorAll('[data-key]')].find((each) => each.dataset.key === focused)?.focus();
    drawExport(totalKm);
  }

  function comparison() {
    if (site.months.length < 2) return el('p', {}, w('site.one_month'));
    const pick = (key, label) => el('label', { class: 'field' }, label, el('select', { onchange: (event) => choose({ [key]: event.target.value }) },
      ...site.months.map((each) => option(each, month(each), state[key]))));
    compare.textContent = comparing ? w('site.compared', comparing) : w('site.zoom_to_compare');
    const steps = [...(state.swipe === 'on' ? [] : ['better', 'worse']), 'unsure', 'unknown'];
    return el('div', {}, pick('a', w('site.before')), pick('b', w('site.after')),
      el('div', { class: 'checks' }, el('label', {}, el('input', { type: 'checkbox', checked: state.swipe === 'on', onchange: (event) => choose({ swipe: event.target.checked ? 'on' : '' }) }), w('site.swipe'))),
      el('ul', { class: 'keys' }, ...steps.map((each) => el('li', {}, el('span', { class: `chip ${each}` }), w(`site.change.${each === 'unknown' && isAfar ? 'afar' : each}`)))), compare);
  }

  function drawExport(totalKm) {
    const rows = Math.round(site.segments_count * totalKm / Math.max(site.km, 1e-9));
    const size = (bytes) => (rows * bytes < 1e6 ? `${number(rows * bytes / 1e3, 0)} kB` : `${number(rows * bytes / 1e6, 1)} MB`);
    const status = el('span', { role: 'status' });
    const button = (format, label) => el('button', { type: 'button', onclick: (event) => save(event.currentTarget, status, format) }, label);
    replace(exporting, el('p', {}, w('site.export_size', { count: rows, size: size(bytesOfRow.csv), more: size(bytesOfRow.geojson) })),
      site.segments.index && el('p', { class: 'actions' }, button('csv', w('site.export_csv')), button('geojson', w('site.export_geojson'))), status);
  }

  async function save(button, status, format) {
    button.disabled = true;
    try {
      const parts = [];
      let count = 0;
      for await (const segments of data.segments()) {
        const chosen = segments.filter(shows);
        if (chosen.length === 0) continue;
        parts.push(format === 'csv' ? csvRows(chosen, count === 0) : `${count === 0 ? '' : ',\n'}${chosen.map(featureText).join(',\n')}`);
        count += chosen.length;
        status.textContent = ` ${w('site.rows', { count })}`;
      }
      if (format === 'csv') download('roads.csv', 'text/csv', parts);
      else download('roads.geojson', 'application/geo+json', ['{"type":"FeatureCollection","features":[\n', ...parts, '\n]}\n']);
    } catch (failure) {
      act.failed(failure);
    } finally {
      button.disabled = false;
      if (document.activeElement === document.body) button.focus(); // a disabled button loses it
    }
  }

  const worstRows = worst.map((each) => {
    const open = () => act.openWorst(each);
    return el('tr', { id: `worst-${each.rank}`, onmouseenter: () => act.pointAt(each), onmouseleave: () => act.pointAt(null) },
      el('td', {}, each.rank),
      el('th', { scope: 'row' }, el('button', { type: 'button', class: 'plain', onclick: open, onfocus: () => act.pointAt(each), onblur: () => act.pointAt(null) }, `${roadName(each)} ${w(`heading.${each.heading}`)}`)),
      el('td', {}, iri(each.iri)), el('td', {}, roadLength(each.length_m / 1000)));
  });

  function drawView(features, isSegments) {
    if (features !== null && isAfar === isSegments) {
      isAfar = !isSegments;
      drawLegend();
    }
    if (features === null) {
      replace(view, el('p', { class: 'quiet' }, w('site.no_map')));
      return;
    }
    const roads = new Map();
    const bins = new Map();
    for (const each of features) {
      const km = (isSegments ? each.to_m - each.from_m : each.length_m) / 1000;
      const key = each.name ?? `${each.highway}`;
      const road = roads.get(key) ?? { ...each, km: 0, sum: 0, worst: -1 };
      road.km += km;
      road.sum += km * each.iri;
      if (each.iri > road.worst) Object.assign(road, { worst: each.iri, target: each });
      roads.set(key, road);
      const bin = Math.min(47, Math.floor(each.iri / totals.bin_mm_per_m));
      bins.set(bin, (bins.get(bin) ?? 0) + km);
    }
    const areBothDirections = !isSegments && features.every(({ last_seen: day }) => day === undefined); // below zoom 12, docs/reference/vector-tiles.md
    const most = 50;
    const sorted = [...roads.values()].sort((a, b) => b.sum / b.km - a.sum / a.km);
    const all = sorted.reduce((sum, { km }) => sum + km, 0);
    replace(view, features.length === 0 ? el('p', {}, w('site.none_in_view'), ' ', el('button', { type: 'button', onclick: act.toData }, w('site.to_data'))) : [
      el('p', {}, w(areBothDirections ? 'site.in_view_total_rougher' : 'site.in_view_total', { km: roadLength(all), iri: iri(sorted.reduce((sum, { sum: each }) => sum + each, 0) / all), unit: iriUnit() })),
      distribution(bins, totals.bin_mm_per_m, site.classes),
      el('div', { class: 'scroll', tabIndex: 0, role: 'group', 'aria-label': w('site.in_view') }, el('table', { id: 'view-table' }, el('caption', { class: 'hidden' }, w('site.in_view')),
        el('thead', {}, el('tr', {}, ...['site.road', 'site.mean', 'site.length'].map((key) => el('th', { scope: 'col' }, w(key))))),
        el('tbody', {}, ...sorted.slice(0, most).map((road) => el('tr', {},
          el('th', { scope: 'row' }, el('button', { type: 'button', class: 'plain', onclick: () => act.openFeature(road.target) }, roadName(road))),
          el('td', {}, iri(road.sum / road.km)), el('td', {}, roadLength(road.km))))))),
      sorted.length > most && el('p', { class: 'quiet' }, w('site.more_roads', { count: sorted.length - most }))]);
  }

  replace(place, peek,
    section('legend', w('site.legend'), legend),
    section('worst', w('site.worst'), worst.length === 0 ? el('p', {}, w('site.no_worst')) : el('div', { class: 'scroll', tabIndex: 0, role: 'group', 'aria-label': w('site.worst') },
      el('table', { id: 'worst-table' }, el('caption', { class: 'hidden' }, w('site.worst')),
        el('thead', {}, el('tr', {}, el('th', { scope: 'col' }, '#'), ...['site.road', 'site.iri', 'site.length'].map((key) => el('th', { scope: 'col' }, w(key))))),
        el('tbody', {}, ...worstRows)))),
    section('view', w('site.in_view'), view),
    act.hasMap && section('route', w('site.profile'), el('p', { class: 'quiet' }, w('site.profile_about')), routeButton),
    section('export', w('site.export'), exporting));
  drawLegend();

  return {
    draw: drawLegend,
    drawView,
    routing: (isOn) => routeButton.setAttribute('aria-pressed', String(isOn)),
    compared(counts) {
      comparing = counts;
      compare.textContent = counts ? w('site.compared', counts) : w('site.zoom_to_compare');
    },
    // Shows which worst section a segment belongs to.
    markWorst(id) {
      worst.forEach((each, i) => worstRows[i].toggleAttribute('data-picked', each.segments.includes(id)));
      const row = place.querySelector('tr[data-picked]');
      row?.scrollIntoView({ block: 'nearest' });
    },
  };
}
