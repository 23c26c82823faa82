// The page of a queue of trips, for operators: what waits, how fast it goes, who works and what failed.
import { element } from '../drive/dom.js';
import { wordsOf } from './words.js';

const refreshEvery_ms = 5000;
const states = ['queued', 'working', 'imported', 'known', 'outside', 'refused', 'parked'];

const content = document.getElementById('page');
const notice = document.getElementById('notice');
const languageButton = document.getElementById('language');

let language = navigator.language.startsWith('de') ? 'de' : 'en';
let latest; // { read, queue } as the server gave it
let parts; // of the page, in the present language
let trouble = ''; // words of the notice

const words = (key, values) => wordsOf(language)(key, values);
const locale = () => navigator.languages.find((name) => name.startsWith(language)) ?? language;
const number = (value) => value.toLocaleString(locale());
const timeOf = (iso) => new Date(iso).toLocaleString(locale(), { dateStyle: 'medium', timeStyle: 'medium' });

function duration(seconds) {
  const [key, unit_s] = seconds < 120 ? ['s', 1] : seconds < 7200 ? ['min', 60] : seconds < 172_800 ? ['h', 3600] : ['days', 86_400];
  return words(key, { n: number(Math.round(seconds / unit_s)) });
}

// Changes only what differs, so that nothing flickers and a selection stays.
function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

class Figures {
  constructor(keys) {
    this.values = keys.map(() => element('dd'));
    this.node = element('dl', { class: 'figures' }, ...keys.map((key, i) => element('div', {}, element('dt', {}, words(key)), this.values[i])));
  }

  show(texts) {
    texts.forEach((text, i) => setText(this.values[i], text));
  }
}

// Table of columns [key of its title, class]; without rows it gives way to words. On a phone, a wide one shows each row as
// a list of titles and values: roles say that it is a table all the same.
class Table {
  constructor(id, columns, whenEmpty = '') {
    this.columns = columns;
    this.body = element('tbody', { role: 'rowgroup' });
    const titles = columns.map(([key, kind]) => element('th', { role: 'columnheader', scope: 'col', class: kind }, words(key)));
    const table = element('table', { role: 'table', class: columns.length > 3 ? 'wide' : '', 'aria-labelledby': id },
      element('thead', { role: 'rowgroup' }, element('tr', { role: 'row' }, ...titles)), this.body);
    this.scroll = element('div', { class: 'scroll', tabindex: '0', role: 'region', 'aria-labelledby': id }, table);
    this.empty = element('p', { class: 'soft', hidden: true }, whenEmpty);
    this.node = element('div', {}, this.scroll, this.empty);
  }

  // rows: { cells: texts, isBad }
  show(rows) {
    while (this.body.rows.length > rows.length) this.body.lastChild.remove();
    rows.forEach(({ cells, isBad }, i) => {
      const row = this.body.rows[i] ?? this.body.appendChild(element('tr', { role: 'row' }, ...this.columns.map(([key, kind]) => element('td', { role: 'cell', class: kind, 'data-title': words(key) }))));
      row.classList.toggle('bad', isBad === true);
      cells.forEach((text, column) => setText(row.cells[column], text));
    });
    this.scroll.hidden = rows.length === 0;
    this.empty.hidden = rows.length > 0;
  }
}

function build() {
  document.documentElement.lang = language;
  document.getElementById('title').textContent = words('title');
  document.title = `${words('title')} – Macadam`;
  languageButton.textContent = words('other_language');
  languageButton.lang = language === 'de' ? 'en' : 'de';
  const heading = (key) => element('h2', { id: key }, words(key));
  parts = {
    figures: new Figures(['waiting', 'being_worked', 'oldest', 'to_fuse', 'accepted_minute', 'accepted_hour', 'finished_minute', 'finished_hour', 'passes_hour']),
    workers: new Table('workers', [['worker'], ['version', 'number'], ['last_sign', 'number'], ['doing'], ['finished', 'number']], words('no_workers')),
    failures: new Table('failures', [['log'], ['state'], ['attempts', 'number'], ['when'], ['reason', 'text']], words('no_failures')),
    logs: new Table('logs', [['state'], ['count', 'number'], ['meaning', 'text']]),
    objects: element('p', { class: 'soft' }),
    read: element('p', { class: 'soft' }),
  };
  content.replaceChildren(
    heading('now'), parts.figures.node, heading('workers'), parts.workers.node, heading('failures'), parts.failures.node,
    heading('logs'), parts.logs.node, parts.objects, parts.read,
  );
}

const doingOf = (worker) => (!worker.alive ? words('gone')
  : worker.working > 0 ? words('imports', { n: number(worker.working), jobs: number(worker.jobs) }) : words('idle'));

function show() {
  setText(notice, trouble);
  content.hidden = latest === undefined;
  if (latest === undefined) return;
  const { queue, read } = latest;
  parts.figures.show([
    number(queue.logs.queued), number(queue.logs.working), duration(queue.oldest_s), number(queue.chunks_to_fuse),
    number(queue.accepted_in_minute), number(queue.accepted_in_hour),
    number(queue.finished_in_minute), number(queue.finished_in_hour), number(queue.passes_in_hour),
  ]);
  parts.workers.show(queue.workers.map((worker) => ({
    cells: [worker.name, String(worker.version), words('ago', { time: duration(worker.seen_s) }), doingOf(worker), number(worker.finished)],
    isBad: !worker.alive,
  })));
  parts.failures.show(queue.failed.map((log) => ({
    cells: [log.sha256.slice(0, 12), words(log.state), number(log.attempts), log.at ? timeOf(log.at) : '–', log.reason],
    isBad: log.state === 'parked',
  })));
  parts.logs.show(states.map((state) => ({ cells: [words(state), number(queue.logs[state]), words(`${state}_means`)] })));
  setText(parts.objects, queue.objects ? words('objects', { place: queue.objects }) : words('no_objects'));
  setText(parts.read, words('read', { time: timeOf(read) }));
}

async function refresh() {
  try {
    const answer = await fetch('status', { cache: 'no-store', headers: { Accept: 'application/json' } });
    if (answer.ok) {
      latest = await answer.json();
      trouble = '';
    } else if (answer.status === 401 || answer.status === 403) {
      latest = undefined;
      trouble = words('not_allowed');
    } else {
      const { detail } = await answer.json();
      trouble = words('failed', { reason: detail });
    }
  } catch {
    trouble = words('unreachable');
  }
  show();
}

async function refreshForever() {
  if (!document.hidden) await refresh();
  setTimeout(refreshForever, refreshEvery_ms);
}

languageButton.onclick = () => {
  language = language === 'de' ? 'en' : 'de';
  trouble = '';
  build();
  show();
};
document.addEventListener('visibilitychange', () => { if (!document.hidden) refresh(); });
build();
show();
refreshForever();
