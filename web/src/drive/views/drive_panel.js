import { element } from '../dom.js';
import { button, heading, number, presentLanguage, words } from '../page.js';

const figures = ['time', 'distance', 'rate', 'gnss', 'mounting'];

function timeOf({ begun_ms, now_ms }) {
  const s = Math.max(0, Math.round((now_ms - (begun_ms ?? now_ms)) / 1000));
  return `${Math.floor(s / 60)}:${String(s % 60).padStart(2, '0')}`;
}

function textsOf(state, quality) {
  return {
    time: timeOf(state),
    distance: `${number(state.length_m / 1000, 1)} km`,
    rate: words('per_second', { n: number(quality.rate_hz) }),
    gnss: Number.isFinite(quality.accuracy_m) ? words('within', { n: number(quality.accuracy_m) }) : words('none'),
    mounting: Number.isFinite(quality.tilt_deg)
      ? words(quality.isSteady ? 'tilt_steady' : 'tilt_moves', { n: number(quality.tilt_deg) })
      : words('measuring'),
  };
}

function problemsOf(state, quality) {
  return [
    ...(state.failed ? ['no_room'] : []), ...(state.isPositionRefused ? ['no_leave_position'] : []),
    ...quality.problems.filter((problem) => !(state.isPositionRefused && problem === 'no_gnss')),
  ];
}

// Figures of the running trip and advice in words. Advice changes only when it differs, so that it is read out once.
export function drivePanel(stop) {
  let cells = {};
  let advice;
  let shown;
  const content = () => {
    cells = Object.fromEntries(figures.map((key) => [key, element('dd', { id: `figure-${key}` }, '–')]));
    advice = element('ul', { class: 'advice', id: 'advice', role: 'list' });
    shown = null;
    return [
      heading('driving'),
      element('div', { role: 'status' }, advice),
      element('dl', { class: 'figures' }, ...figures.map((key) => element('div', {}, element('dt', {}, words(key)), cells[key]))),
      button('stop', stop, { class: 'main' }),
    ];
  };
  const draw = (state, quality) => {
    for (const [key, text] of Object.entries(textsOf(state, quality))) {
      cells[key].textContent = text;
    }
    const problems = problemsOf(state, quality);
    const key = `${presentLanguage()} ${problems} ${state.awake}`;
    if (key === shown) {
      return;
    }
    shown = key;
    const values = { slow_motion: { n: number(quality.rate_hz) }, poor_gnss: { n: number(quality.accuracy_m) } };
    advice.replaceChildren(
      ...problems.map((problem) => element('li', { class: 'bad' }, words(problem, values[problem]))),
      problems.length === 0 ? element('li', {}, words('all_well')) : '',
      element('li', {}, words(state.awake ? 'awake' : 'not_awake')));
  };
  return { content, draw };
}
