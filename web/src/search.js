// The field that finds a road by its name, or a segment by its id.
import { parseId } from './data.js';
import { el, replace } from './dom.js';
import { iri, roadLength, w } from './words.js';

// `act`: names(text) to ask for, openSegment(id), fit(bounds), failure(error, retry), say(text).
export function openSearch(act) {
  const list = el('ul', { id: 'found', role: 'listbox', 'aria-label': w('site.search'), hidden: true });
  let found = [];
  let at = -1;
  const close = () => { list.hidden = true; input.setAttribute('aria-expanded', 'false'); input.removeAttribute('aria-activedescendant'); at = -1; };
  const take = (road) => {
    close();
    input.value = road.name;
    act.openSegment(road.segment).then(() => act.fit(road.bounds));
  };
  const mark = (to) => {
    at = to;
    [...list.children].forEach((item, i) => item.setAttribute('aria-selected', String(i === at)));
    if (at >= 0) input.setAttribute('aria-activedescendant', `found-${at}`);
  };
  const look = async () => {
    const text = input.value.trim();
    if (!text) {
      found = [];
      return close();
    }
    if (parseId(text)) found = [{ name: text, segment: text, bounds: null }];
    else {
      try {
        const asked = await act.names(text);
        if (input.value.trim() !== text) return undefined;
        found = asked;
      } catch (error) {
        return act.failure(error, look);
      }
    }
    replace(list, found.length === 0 ? el('li', { class: 'quiet', role: 'option', 'aria-selected': 'false' }, w('site.no_road'))
      : found.map((road, i) => el('li', { id: `found-${i}`, role: 'option', 'aria-selected': 'false', onmousedown: (event) => { event.preventDefault(); chosen(road); } },
        road.name, road.km !== undefined && el('span', { class: 'quiet' }, ` ${roadLength(road.km)} · ${iri(road.iri)}`))));
    list.hidden = false;
    input.setAttribute('aria-expanded', 'true');
    at = -1;
    return undefined;
  };
  const chosen = (road) => (road.bounds ? take(road) : (close(), act.openSegment(road.segment, { fit: true })));
  const input = el('input', { type: 'search', id: 'search', role: 'combobox', 'aria-controls': 'found', 'aria-expanded': 'false', 'aria-autocomplete': 'list', autocomplete: 'off',
    'aria-label': w('site.search'), placeholder: w('site.search'), maxlength: '80', oninput: look, onblur: close,
    onkeydown: (event) => {
      if (event.key === 'ArrowDown' || event.key === 'ArrowUp') {
        event.preventDefault();
        if (found.length > 0) mark((at + (event.key === 'ArrowDown' ? 1 : found.length - (at < 0 ? 0 : 1))) % found.length);
      } else if (event.key === 'Enter' && found.length > 0) chosen(found[Math.max(at, 0)]);
      else if (event.key === 'Enter' && !list.hidden) act.say(w('site.no_road'));
      else if (event.key === 'Escape' && !list.hidden) { event.stopPropagation(); close(); }
    } });
  return el('div', { class: 'search' }, input, list);
}
