// Messages, numbers and days in the language of the reader; the catalogues are the report's.
let words = {};
let unit = 'mm/m';

const inPerMi = 63.36; // of 1 mm/m
const kmOfMile = 1.609344;

export async function speak(data, language, chosenUnit) {
  words = await data.words(language);
  unit = chosenUnit;
  document.documentElement.lang = words.language;
}

export function w(key, values = {}) {
  const text = words[key] ?? words[`${key}.${plural(values.count)}`];
  if (text === undefined) return key;
  return text.replace(/\{(\w+)\}/g, (whole, name) => (name in values ? (name === 'count' ? whole_(values[name]) : values[name]) : whole));
}
export const knows = (key) => key in words;

const plural = (count) => words.plural_forms?.[count < 200 ? count : 100 + (count % 100)] ?? 0;
const mark = (text) => text.replace('.', words['locale.decimal_mark'] ?? '.');
const whole_ = (value) => (value >= 10_000
  ? String(Math.round(value)).replace(/\B(?=(\d{3})+$)/g, words['locale.group_mark'] ?? '\u202f') : String(Math.round(value)));

export const number = (value, decimals) => mark(value.toFixed(decimals));
export const isUs = () => unit === 'in/mi';
export const iriUnit = () => unit;
export const inUnit = (mmPerM) => (isUs() ? mmPerM * inPerMi : mmPerM);
export const iri = (mmPerM) => (mmPerM === null || mmPerM === undefined ? '–' : number(inUnit(mmPerM), isUs() ? 0 : 2));
export const iriChange = (mmPerM) => `${mmPerM > 0 ? '+' : mmPerM < 0 ? '−' : ''}${iri(Math.abs(mmPerM))}`;
export const interval = (low, high) => `${iri(low)} – ${iri(high)}`;
export function roadLength(km) {
  const length = isUs() ? km / kmOfMile : km;
  return `${length >= 10_000 ? whole_(length) : number(length, length < 10 ? 2 : length < 1000 ? 1 : 0)} ${isUs() ? 'mi' : 'km'}`;
}
export const metres = (m) => (isUs() ? `${Math.round(m / 0.3048)} ft` : `${Math.round(m)} m`);
export function day(iso) {
  if (!iso) return '–';
  const [year, month, date] = iso.split('-');
  return date ? (words['locale.day'] ?? '{year}-{month}-{day}').replace('{year}', year).replace('{month}', month).replace('{day}', date) : iso;
}
export function month(iso) {
  return new Intl.DateTimeFormat(words.language, { month: 'short', year: 'numeric', timeZone: 'UTC' }).format(new Date(`${iso}-01T00:00:00Z`));
}
export const className = (name) => (knows(`class.${name}`) ? w(`class.${name}`) : name);
export function kind(highway) {
  const plain = (highway ?? '').replace(/_link$/, '');
  return knows(`kind.${plain}`) ? w(`kind.${plain}`) : w('kind.other');
}
export function roadName(road) {
  if (road.name) return road.name;
  const plain = (road.highway ?? '').replace(/_link$/, '');
  return knows(`unnamed.${plain}`) ? w(`unnamed.${plain}`) : w('unnamed.other');
}
