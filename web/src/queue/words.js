// What the page says. A word in braces is replaced by a value.

const en = {
  title: 'Queue',
  other_language: 'Deutsch',
  now: 'Now',
  waiting: 'Waiting', being_worked: 'Being imported', oldest: 'Oldest waits for', to_fuse: 'Chunks to fuse',
  accepted_minute: 'Accepted, last minute', accepted_hour: 'Accepted, last hour',
  finished_minute: 'Done, last minute', finished_hour: 'Done, last hour', passes_hour: 'Passes, last hour',
  logs: 'Logs by state', state: 'State', count: 'Logs', meaning: 'Meaning',
  queued: 'waiting', working: 'being imported', imported: 'imported', known: 'known', outside: 'outside the map', refused: 'refused', parked: 'parked',
  queued_means: 'No worker has it.',
  working_means: 'A worker has it.',
  imported_means: 'Its passes are in the database.',
  known_means: 'Its trips were in the database before.',
  outside_means: 'It touches no road of this map.',
  refused_means: 'It holds no usable trip.',
  parked_means: 'It failed five times. Submit it again to try it again.',
  workers: 'Workers', no_workers: 'None. Start one with “macadam worker”.',
  worker: 'Worker', version: 'Version of results', last_sign: 'Last sign', doing: 'Does', finished: 'Logs done',
  ago: '{time} ago',
  idle: 'nothing, waits', imports: 'imports {n} logs, {jobs} at a time', gone: 'gives no sign; others take its logs',
  failures: 'Latest failures', no_failures: 'None.',
  log: 'Log', attempts: 'Attempts', when: 'When', reason: 'Reason',
  objects: 'Logs lie in {place}.', no_objects: 'Nothing was submitted so far.',
  read: 'As of {time}.',
  unreachable: 'The server does not answer. This page tries again.',
  not_allowed: 'This is for tokens of scope operator.',
  failed: 'The server answers: {reason}. This page tries again.',
  s: '{n} s', min: '{n} min', h: '{n} h', days: '{n} days',
};

const de = {
  title: 'Warteschlange',
  other_language: 'English',
  now: 'Jetzt',
  waiting: 'Warten', being_worked: 'In Arbeit', oldest: 'Ältestes wartet seit', to_fuse: 'Zu fusionierende Abschnitte',
  accepted_minute: 'Angenommen, letzte Minute', accepted_hour: 'Angenommen, letzte Stunde',
  finished_minute: 'Erledigt, letzte Minute', finished_hour: 'Erledigt, letzte Stunde', passes_hour: 'Überfahrten, letzte Stunde',
  logs: 'Aufzeichnungen nach Zustand', state: 'Zustand', count: 'Anzahl', meaning: 'Bedeutung',
  queued: 'wartet', working: 'in Arbeit', imported: 'eingelesen', known: 'bekannt', outside: 'außerhalb der Karte', refused: 'abgelehnt', parked: 'beiseitegelegt',
  queued_means: 'Noch kein Arbeiter hat sie.',
  working_means: 'Ein Arbeiter hat sie.',
  imported_means: 'Ihre Überfahrten sind in der Datenbank.',
  known_means: 'Ihre Fahrten waren schon in der Datenbank.',
  outside_means: 'Sie berührt keine Straße dieser Karte.',
  refused_means: 'Sie enthält keine brauchbare Fahrt.',
  parked_means: 'Sie ist fünfmal gescheitert. Für einen neuen Versuch erneut einreichen.',
  workers: 'Arbeiter', no_workers: 'Keine. „macadam worker“ startet einen.',
  worker: 'Arbeiter', version: 'Version der Ergebnisse', last_sign: 'Letztes Zeichen', doing: 'Tut', finished: 'Erledigt',
  ago: 'vor {time}',
  idle: 'nichts, wartet', imports: 'liest {n} ein, {jobs} gleichzeitig', gone: 'gibt kein Zeichen; andere nehmen seine Aufzeichnungen',
  failures: 'Letzte Fehlschläge', no_failures: 'Keine.',
  log: 'Aufzeichnung', attempts: 'Versuche', when: 'Wann', reason: 'Grund',
  objects: 'Die Aufzeichnungen liegen in {place}.', no_objects: 'Bisher wurde nichts eingereicht.',
  read: 'Stand: {time}.',
  unreachable: 'Der Server antwortet nicht. Diese Seite versucht es erneut.',
  not_allowed: 'Das ist für Schlüssel mit dem Recht „operator“.',
  failed: 'Der Server antwortet: {reason}. Diese Seite versucht es erneut.',
  s: '{n} s', min: '{n} min', h: '{n} h', days: '{n} Tagen',
};

export const catalogues = { en, de };

export function wordsOf(language) {
  const words = catalogues[language] ?? en;
  return (key, values = {}) => words[key].replace(/\{(\w+)\}/g, (_, name) => String(values[name]));
}
