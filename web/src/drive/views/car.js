import { carBodies, parseCar } from '../car.js';
import { element } from '../dom.js';
import { button, heading, number, words } from '../page.js';
import { randomName } from '../trips.js';

function bodies(known) {
  const option = (name) => element('option', { value: name, selected: name === known }, words(`body_${name}`));
  return element('select', { id: 'body' }, element('option', { value: '' }, words('body_unknown')), ...Object.keys(carBodies).map(option));
}

const input = (id, value) =>
  element('input', { type: 'text', inputmode: 'decimal', id, autocomplete: 'off', 'aria-describedby': 'wrong', value: value ?? '' });

// Asks for the car; a driver who has one already may say that it is another.
export async function carView({ store, begin }) {
  const known = (await store.setting('car')) ?? {};
  const body = bodies(known.body);
  const mass = input('mass', known.mass_kg);
  const wheelbase = input('wheelbase', known.wheelbase_m);
  const wrong = element('p', { id: 'wrong', class: 'wrong', role: 'alert' });
  const hasVehicle = Boolean(await store.setting('vehicle_id'));
  const other = element('input', { type: 'checkbox', id: 'other' });
  const refuse = (name, [min, max]) => {
    const digits = min % 1 ? 2 : 0;
    wrong.textContent = words(`${name}_wrong`, { min: number(min, digits), max: number(max, digits) });
    const field = name === 'mass_kg' ? mass : wheelbase;
    field.setAttribute('aria-invalid', 'true');
    field.focus();
  };
  const keep = async () => {
    const parsed = parseCar({ body: body.value, mass: mass.value, wheelbase: wheelbase.value });
    for (const field of [mass, wheelbase]) {
      field.removeAttribute('aria-invalid');
    }
    if (parsed.wrong) {
      refuse(parsed.wrong, parsed.range);
      return;
    }
    await store.setSettings({ car: parsed.car, ...(hasVehicle && !other.checked ? {} : { vehicle_id: randomName('web-', 8) }) });
    await begin();
  };
  return [
    heading('car_heading'), element('p', {}, words('car_why')),
    element('label', { for: 'body' }, words('car_body')), body,
    element('label', { for: 'mass' }, words('car_mass')), mass,
    element('label', { for: 'wheelbase' }, words('car_wheelbase')), wheelbase,
    hasVehicle ? element('label', { class: 'tick' }, other, words('other_car')) : null,
    wrong, button('save_car', keep, { class: 'main' }),
  ].filter(Boolean);
}
