// What the reader chose, in the address after '#', so that a link shows the same.
const defaults = { s: '', mode: 'roughness', c: '', h: '', p: 1, q: 2, lang: '', theme: 'auto', unit: 'mm/m', a: '', b: '', swipe: '', r: '', way: '', map: '' };

export const state = { ...defaults };
const listeners = [];
export const onState = (listener) => listeners.push(listener);

export function readState() {
  const given = new URLSearchParams(location.hash.slice(1));
  for (const [key, value] of Object.entries(defaults)) {
    const text = given.get(key);
    state[key] = text === null ? value : typeof value === 'number' ? (text !== '' && Number.isFinite(Number(text)) ? Number(text) : value) : text;
  }
  for (const key of ['s', 'r', 'way']) state[key] = state[key].replaceAll(' ', '+'); // as '+' in an address is read
}

function address() {
  const given = new URLSearchParams();
  for (const [key, value] of Object.entries(defaults)) {
    if (state[key] !== value) given.set(key, state[key]);
  }
  return `#${given}`.replaceAll('%2F', '/').replaceAll('%2C', ',').replaceAll('%2B', '+');
}

export const link = () => new URL(address(), location.href).href;

// Changes some of it, and tells what shows it.
export function choose(changes) {
  const before = { ...state };
  Object.assign(state, changes);
  const changed = Object.keys(changes).filter((key) => before[key] !== state[key]);
  if (changed.length === 0) return;
  history.replaceState(null, '', address());
  if (changed.some((key) => key !== 'map')) listeners.forEach((tell) => tell(changed));
}

const list = (text) => (text ? text.split(',') : []);
// Names that a filter hides; none by default.
export const hidden = (key) => new Set(list(state[key]));
export function toggle(key, name) {
  const names = hidden(key);
  if (!names.delete(name)) names.add(name);
  choose({ [key]: [...names].join(',') });
}
