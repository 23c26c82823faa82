// Two months beside each other: the later one lies on the earlier one as far as a slider uncovers it.
import { el } from './dom.js';
import { month, w } from './words.js';

const thumb = 44; // pixels, as in site.css

// `openAfter(place)` opens a map of the later month in `place` that follows the first.
export function openSwipe(container, { before, after }, openAfter) {
  const side = el('div', { class: 'swipe-side', 'aria-hidden': 'true' });
  const line = el('div', { class: 'swipe-line', 'aria-hidden': 'true' });
  const names = [before, after].map((each, i) => el('span', { class: `swipe-name ${i === 0 ? 'left' : 'right'}`, 'aria-hidden': 'true' }, month(each)));
  const slider = el('input', { type: 'range', class: 'swipe', min: '0', max: '100', value: '50', 'aria-label': w('site.swipe_border', { before: month(before), after: month(after) }), oninput: () => move() });
  const move = () => {
    container.style.setProperty('--swipe', `calc(${thumb / 2}px + (100% - ${thumb}px) * ${Number(slider.value) / 100})`);
    slider.setAttribute('aria-valuetext', `${month(before)} ${slider.value} %, ${month(after)} ${100 - Number(slider.value)} %`);
  };
  move();
  container.append(side, line, ...names, slider);
  const map = openAfter(side);
  return {
    map,
    close() {
      map.remove();
      [side, line, ...names, slider].forEach((each) => each.remove());
    },
  };
}
