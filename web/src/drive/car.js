// Kinds of car with the kerb masses and wheelbases that the program accepts (estimator/vehicle/vehicle_prior.cpp; a test
// compares them).
export const carBodies = {
  small: { mass_kg: [600, 1600], wheelbase_m: [1.7, 2.65] },
  compact: { mass_kg: [800, 2200], wheelbase_m: [2.35, 2.9] },
  saloon: { mass_kg: [900, 2700], wheelbase_m: [2.35, 3.4] },
  estate: { mass_kg: [900, 2700], wheelbase_m: [2.35, 3.2] },
  suv: { mass_kg: [1000, 4300], wheelbase_m: [2.2, 4.6] },
  van: { mass_kg: [1100, 3500], wheelbase_m: [2.5, 4.7] },
  pickup: { mass_kg: [1300, 4300], wheelbase_m: [2.6, 4.6] },
};

// Parses what the driver said, with a decimal point or comma; metres may be given as millimetres, as papers do. Returns
// { car } ({} if he does not know) or { wrong: 'mass_kg' | 'wheelbase_m', range }.
export function parseCar({ body, mass, wheelbase }) {
  const number = (text) => Number(String(text).trim().replace(',', '.'));
  const limits = carBodies[body];
  if (!limits || mass.trim() === '' || wheelbase.trim() === '') {
    return { car: {} };
  }
  const mass_kg = number(mass);
  const given = number(wheelbase);
  const wheelbase_m = given > 1000 ? given / 1000 : given;
  const isIn = (value, [min, max]) => value >= min && value <= max;
  if (!isIn(mass_kg, limits.mass_kg)) {
    return { wrong: 'mass_kg', range: limits.mass_kg };
  }
  if (!isIn(wheelbase_m, limits.wheelbase_m)) {
    return { wrong: 'wheelbase_m', range: limits.wheelbase_m };
  }
  return { car: { body, mass_kg, wheelbase_m } };
}
