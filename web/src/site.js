// The page of a site: docs/reference/site.md says what it asks for.
import { onBusy, openSite } from './data.js';
import { choice, neighbour, runDetail, segmentDetail } from './drawer.js';
import { el, option, replace } from './dom.js';
import { showFirstPicture } from './first_picture.js';
import { openMap } from './map.js';
import { addFeatures, continuation, newNetwork } from './network.js';
import { openPanel } from './panel.js';
import { pictureMap } from './pictures.js';
import { openRouting } from './routing.js';
import { openSearch } from './search.js';
import { choose, link, onState, readState, state } from './state.js';
import { day, iri, iriUnit, month, roadLength, speak, w } from './words.js';

const narrow = matchMedia('(max-width: 760px)');
const small = matchMedia('(max-width: 1000px)'); // the drawer takes the place of the panel
let data, map, panel, parts, routing;
let openedBy = null; // where the focus returns
let shownSegment = null;

const keysAreOff = () => localStorage.getItem('macadam.keys') === 'off';

function applyTheme() {
  document.documentElement.dataset.theme = state.theme;
}

function failure(error, retry) {
  const reasons = error.status === 'offline' || !navigator.onLine ? [w('site.offline'), dateOfData()] : [w('site.failed', { what: error.url ?? '', why: String(error.status ?? error.message ?? '') })];
  replace(parts.notice, ...reasons.filter(Boolean).map((reason) => el('p', {}, reason)), el('button', { type: 'button', onclick: () => { clearNotice(); retry(); } }, w('site.retry')));
  parts.notice.hidden = false;
}
const clearNotice = () => { parts.notice.hidden = true; };

async function attempt(act) {
  try {
    await act();
  } catch (error) {
    failure(error, () => attempt(act));
  }
}

// Says in the status line what else would be silence.
const say = (text) => replace(parts.status, text && el('p', {}, text));

function dateOfData() {
  const { published, last_seen: last } = data.site;
  return published ? w('site.published', { month: month(published.month) }) : last ? w('site.fresh', { day: day(last) }) : '';
}

async function copy(text, button) {
  const before = button.textContent;
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = w('site.copied');
  } catch {
    prompt(w('site.copy_link'), text); // without leave to the clipboard
  }
  setTimeout(() => { button.textContent = before; }, 2000);
}

function showDrawer(content, label) {
  const close = el('button', { type: 'button', class: 'close', 'aria-label': w('site.close'), onclick: closeDrawer }, '×');
  if (parts.drawer.hidden) openedBy = document.activeElement;
  const focused = parts.drawer.contains(document.activeElement) && document.activeElement.textContent;
  replace(parts.drawer, close, ...content);
  parts.drawer.hidden = false;
  document.body.classList.add('has-drawer');
  if (label) for (const each of [parts.sheet, parts.drawer]) each.scrollTop = 0;
  const again = focused && [...parts.drawer.querySelectorAll('button')].find(({ textContent }) => textContent === focused);
  if (label || focused) (!label && again || parts.drawer.querySelector('#drawer-title'))?.focus({ preventScroll: true });
  if (narrow.matches && parts.sheet.dataset.height === 'low') setSheet(innerHeight < 500 ? 'high' : 'half');
}

function closeDrawer() {
  say('');
  if (parts.drawer.hidden) return;
  if (routing?.isOn()) { // from a segment back to its route, from there to the map
    const wasSegment = Boolean(shownSegment);
    shownSegment = null;
    choose({ s: '' });
    if (wasSegment) routing.draw(true); else routing.end();
    return;
  }
  parts.drawer.hidden = true;
  document.body.classList.remove('has-drawer');
  shownSegment = null;
  choose({ s: '' });
  map?.markPicked([]);
  panel.markWorst('');
  if (openedBy?.isConnected && openedBy !== document.body) openedBy.focus(); else map?.focus();
  openedBy = null;
}

async function openSegment(id, { fit = false, focus = true } = {}) {
  try {
    const segment = await data.segment(id);
    say(segment ? '' : w('site.no_segment', { id }));
    if (!segment) return false;
    shownSegment = segment;
    choose({ s: id });
    map?.markPicked([segment.line]);
    showDrawer(segmentDetail(segment, data.site, { copy, step: stepAlong, route: routing && { isOn: routing.isOn(), add: () => { shownSegment = null; routing.add(segment); } } }), focus);
    if (fit && map && !(map.sees(segment.line[0]) && map.hasSegments())) {
      const [lon, lat] = segment.line[0];
      map.fit([lon, lat, lon, lat], 16);
    }
    panel.markWorst(id);
    return true;
  } catch (error) {
    failure(error, () => openSegment(id, { fit, focus }));
    return false;
  }
}

// The segment after or before one on its road, across the ends of OSM's ways where the map knows how it goes on.
async function nextAlong(segment, step) {
  const next = neighbour(segment.segment, step);
  if (next && await data.segment(next)) return next;
  if (!map) return null;
  const { line, months, ...properties } = segment;
  const [lon, lat] = line.at(step > 0 ? -1 : 0);
  if (!(map.sees([lon, lat]) && map.hasSegments())) map.fit([lon, lat, lon, lat], 16);
  await map.settled();
  const network = newNetwork();
  addFeatures(network, [{ properties, geometry: { type: 'LineString', coordinates: line } }, ...map.segments()]);
  return continuation(network, segment, step);
}

const stepAlong = (step) => attempt(async () => {
  const from = shownSegment;
  const next = from && await nextAlong(from, step);
  if (shownSegment !== from) return;
  if (next) await openSegment(next, { fit: true, focus: false });
  else if (from) say(w('site.road_end'));
});

function openFeature(feature, at) {
  if (feature.segment) openSegment(feature.segment);
  else showDrawer(runDetail(feature, { zoomIn: () => map.zoomIn(at) }), true);
}

function picked(found, at) {
  if (routing.isOn()) {
    shownSegment = null;
    routing.picked(found, at);
    return;
  }
  if (found.length === 0) return;
  if (found.length === 1) openFeature(found[0], at);
  else showDrawer(choice(found, { open: (each) => openFeature(each, at) }), true);
}

function openWorst(section) {
  openSegment(section.segments[Math.floor(section.segments.length / 2)]).then(() => map?.fit(section.bounds));
}

// Pixels of the map below drawer and sheet.
function covered() {
  const height = parts.map.clientHeight;
  if (narrow.matches) return { right: 0, bottom: Math.min(parts.sheet.clientHeight, height * 0.5) };
  return { right: parts.drawer.hidden || small.matches ? 0 : Math.min(parts.drawer.clientWidth, parts.map.clientWidth - 200), bottom: 0 };
}

function toData() {
  choose({ c: '', h: '', p: 1, q: 2 });
  map?.fit(data.site.bounds, 15);
}

function setSheet(height) {
  parts.sheet.dataset.height = height;
  parts.handle.setAttribute('aria-expanded', String(height !== 'low'));
}
const raise = { low: 'half', half: 'high', high: 'low' };

function settings() {
  const select = (key, label, values) => el('label', {}, el('span', {}, label), el('select', { name: key, onchange: (event) => choose({ [key]: event.target.value }) },
    ...values.map(([value, text]) => option(value, text, state[key] || (key === 'lang' ? document.documentElement.lang : '')))));
  const keys = el('input', { type: 'checkbox', checked: !keysAreOff(), onchange: (event) => { localStorage.setItem('macadam.keys', event.target.checked ? 'on' : 'off'); } });
  const close = (event) => {
    if (event.key !== 'Escape' || !event.currentTarget.open) return;
    event.stopPropagation();
    event.currentTarget.open = false;
    event.currentTarget.querySelector('summary').focus();
  };
  return el('details', { class: 'settings', onkeydown: close }, el('summary', {}, w('site.settings')), el('div', { class: 'menu' },
    select('unit', w('site.unit'), [['mm/m', 'mm/m'], ['in/mi', 'in/mi']]),
    select('lang', w('site.language'), data.site.languages.map((code) => [code, { en: 'English', de: 'Deutsch' }[code] ?? code])),
    select('theme', w('site.theme'), ['auto', 'light', 'dark', 'contrast'].map((name) => [name, w(`site.theme.${name}`)])),
    el('label', {}, keys, w('site.single_keys')),
    el('p', { class: 'quiet' }, w('site.keys'))));
}

function footer({ site }) {
  return el('footer', {}, el('span', {}, dateOfData()), el('span', {}, w('site.indicative')), site.attribution && el('span', { class: 'attribution' }, site.attribution),
    el('a', { href: 'drive/' }, w('site.record')), el('a', { href: 'assets/licences.txt' }, w('site.licences')));
}

function pressed(event) {
  if (event.key === 'Escape') { closeDrawer(); return; }
  if (keysAreOff() || event.ctrlKey || event.metaKey || event.altKey || event.target.closest?.('input:not([type=checkbox],[type=radio]), select, textarea')) return;
  const go = {
    '/': () => document.getElementById('search').focus(),
    '[': () => stepAlong(-1),
    ']': () => stepAlong(1),
    w: () => { openSheetFor('worst'); document.querySelector('#worst-table button')?.focus(); },
    c: () => choose({ mode: state.mode === 'change' ? 'roughness' : 'change' }),
    r: () => routing?.toggle(),
  }[event.key];
  if (go) { event.preventDefault(); go(); }
}

function openSheetFor(id) {
  if (small.matches) closeDrawer();
  if (narrow.matches) setSheet('high');
  document.getElementById(id)?.scrollIntoView({ block: 'start' });
}

// Without a map: the names of the roads lead to all numbers.
async function listNames() {
  const most = data.site.names.index ? 200 : 50; // of a server
  const names = await data.names('', most);
  const { overview, pictures, bounds } = data.site;
  replace(parts.map, el('div', { class: 'notice' }, el('p', {}, w('site.no_webgl'))), pictures ? pictureMap(pictures, bounds) : overview && el('img', { class: 'overview', src: overview, alt: w('site.overview') }), el('div', { class: 'scroll', tabIndex: 0, role: 'group', 'aria-label': w('site.roads') },
    el('table', { id: 'road-table' }, el('caption', {}, w('site.roads')),
      el('thead', {}, el('tr', {}, ...['site.road', 'site.mean', 'site.length'].map((key) => el('th', { scope: 'col' }, w(key))))),
      el('tbody', {}, ...names.map((road) => el('tr', {}, el('th', { scope: 'row' }, el('button', { type: 'button', class: 'plain', onclick: () => openSegment(road.segment) }, road.name)),
        el('td', {}, iri(road.iri)), el('td', {}, roadLength(road.km)))))),
    names.length === most && el('p', { class: 'quiet' }, w('site.more_names', { count: most }))));
}

// The worker that keeps answers is fetched after the first picture, which needs the network for itself.
let isKept = false;
function keepAnswers() {
  if (isKept || !isSecureContext || !navigator.serviceWorker) return;
  isKept = true;
  navigator.serviceWorker.register('service_worker.js').catch(() => {});
}

function showView() {
  if (!panel || !parts.map.dataset.ready) return;
  panel.drawView(map.inView(), map.hasSegments());
  routing?.idle();
  setTimeout(keepAnswers, 1000);
}

// The map, or nothing where WebGL 2 is missing.
async function mapOn(place) {
  const takeAway = showFirstPicture(place, data.site, covered());
  try {
    return await openMap(place, data, covered, {
      picked,
      failed: (error, retry = () => location.reload()) => failure(error, retry),
      idle: () => { takeAway(); showView(); },
      compared: (counts) => panel?.compared(counts),
    });
  } catch (error) {
    console.info(String(error));
    takeAway();
    return undefined;
  }
}

async function draw() {
  const { site } = data;
  const language = site.languages.includes(state.lang) ? state.lang : site.languages.find((code) => navigator.language.startsWith(code)) ?? 'en';
  const asked = Promise.all([data.totals(), data.worst()]);
  asked.catch(() => {}); // told below
  await speak(data, language, state.unit);
  if (state.mode === 'change' && !state.a && site.months.length > 1) choose({ a: site.months[0], b: site.months.at(-1) });
  document.title = `${site.title} – ${w('title')}`;
  const handle = el('button', { type: 'button', class: 'handle', 'aria-label': w('site.panel'), 'aria-expanded': 'true', onclick: () => setSheet(raise[parts.sheet.dataset.height]) });
  const panelPlace = el('div', { class: 'panel' });
  const drawer = el('aside', { class: 'drawer', hidden: true, 'aria-labelledby': 'drawer-title' });
  const sheet = el('div', { class: 'sheet' }, handle, panelPlace, drawer);
  const mapPlace = el('div', { id: 'map', class: 'map', role: 'region', 'aria-label': w('site.map') });
  const notice = el('div', { class: 'notice', role: 'alert', hidden: true });
  const bar = el('div', { class: 'progress', hidden: true, role: 'progressbar', 'aria-label': w('site.loading') });
  const status = el('div', { class: 'status', role: 'status', onclick: () => say('') });
  parts = { handle, sheet, drawer, map: mapPlace, notice, status };
  const setting = document.activeElement?.closest('.settings') && document.activeElement.name; // that has the page drawn anew
  document.body.replaceChildren(
    el('a', { class: 'skip', href: '#legend', onclick: (event) => { event.preventDefault(); openSheetFor('legend'); document.querySelector('#legend input')?.focus(); } }, w('site.skip')),
    el('header', {}, el('h1', {}, site.title), openSearch({ names: (text) => data.names(text), openSegment, fit: (bounds) => map?.fit(bounds), failure, say }), settings(), el('button', { type: 'button', class: 'share', onclick: (event) => copy(link(), event.currentTarget) }, w('site.share'))),
    bar, el('main', {}, mapPlace, el('div', { class: 'messages' }, notice, status), sheet), footer(data));
  if (setting) {
    document.querySelector('.settings').open = true;
    document.querySelector(`.settings [name=${setting}]`).focus();
  }
  setSheet('low');
  // Nothing has the focus where the low sheet hides it.
  panelPlace.addEventListener('focusin', () => { if (narrow.matches && parts.sheet.dataset.height === 'low') setSheet('half'); });
  onBusy((isBusy) => { bar.hidden = !isBusy; });
  panel = undefined;
  map = undefined;
  map = await mapOn(mapPlace);
  const act = {
    hasMap: Boolean(map), openWorst, openFeature: (feature) => (feature.segment ? openSegment(feature.segment) : showDrawer(runDetail(feature, { zoomIn: () => map.fit(data.site.bounds, 15) }), true)),
    toData, toggleRoute: () => routing.toggle(), failed: (error) => failure(error, clearNotice), pointAt: (section) => map?.markPointed(section ? [section.line] : []),
  };
  panel = openPanel(panelPlace, data, ...await asked, act);
  routing = map && openRouting(data, map, { show: showDrawer, close: closeDrawer, openSegment: (id) => openSegment(id, { fit: true }), copy, told: panel.routing });
  if (map) showView();
  else {
    panel.drawView(null);
    await attempt(listNames);
  }
  await attempt(async () => routing?.restore());
  if (state.s) await openSegment(state.s, { fit: !state.map, focus: false });
}

function changed(keys) {
  if (keys.includes('theme')) applyTheme();
  if (keys.some((key) => ['lang', 'unit'].includes(key))) {
    map?.remove();
    draw().catch(broken);
    return;
  }
  if (keys.some((key) => ['mode', 'c', 'h', 'p', 'q', 'a', 'b', 'swipe', 'theme'].includes(key))) {
    if (state.mode === 'change' && !state.a && data.site.months.length > 1) {
      choose({ a: data.site.months[0], b: data.site.months.at(-1) });
      return;
    }
    map?.show();
    panel.draw();
  }
}

// Before there are words: in English.
function broken(error) {
  const isOffline = error.status === 'offline';
  document.body.replaceChildren(el('main', { class: 'broken' }, el('h1', {}, 'Road roughness'),
    el('p', { role: 'alert' }, isOffline ? 'There is no network, and this page has not been loaded before.' : `The map cannot be shown: ${error.message ?? error}`),
    el('button', { type: 'button', onclick: () => location.reload() }, 'Try again')));
}

async function start() {
  readState();
  applyTheme();
  document.body.append(el('p', { class: 'loading', role: 'status' }, 'Loading…'));
  data = await openSite();
  await draw();
  onState(changed);
  addEventListener('keydown', pressed);
  addEventListener('hashchange', () => {
    readState();
    applyTheme();
    map?.remove();
    draw().catch(broken);
  });
  const offline = () => failure({ status: 'offline' }, () => {});
  addEventListener('offline', offline);
  addEventListener('online', clearNotice);
  if (!navigator.onLine) offline();
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => map?.show());
}

start().catch(broken);
