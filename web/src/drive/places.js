// Where a receiver says that the car was, without the jumps that receivers make.
import { distance_m } from './geometry.js';
import { fixColumn } from './samples.js';

export const fixError_m = 10; // beside the accuracy that the receiver states
export const fixesInRow = 3; // prove that the car is elsewhere: one jump, or two, count for nothing
const poor_m = 50; // a worse fix proves no distance
const topSpeed_mps = 70;

export const placeOf = (row, t_ms) => ({ t_ms, row, lat: row[fixColumn.lat], lon: row[fixColumn.lon], accuracy_m: row[fixColumn.accuracy] });

const isGood = ({ lat, lon, accuracy_m }) => accuracy_m <= poor_m && (lat !== 0 || lon !== 0);

// Whether a car can have gone from one place to the other in the time between.
export const isReachable = (a, b) =>
  distance_m(a, b) <= (topSpeed_mps * Math.abs(b.t_ms - a.t_ms)) / 1000 + fixError_m + a.accuracy_m + b.accuracy_m;

// Passes on places, in the order of time, that follow from those before. Others it keeps back until three in a row
// follow from each other: then the places before had been wrong, or the receiver is elsewhere now.
export class JumpFilter {
  #last = null;
  #doubted = [];

  // Returns the places that are believed now.
  add(place) {
    if (!isGood(place)) {
      return [];
    }
    const follows = this.#last === null || isReachable(this.#last, place);
    if (!follows && this.#doubted.length > 0 && !isReachable(this.#doubted.at(-1), place)) {
      this.#doubted = [];
    }
    this.#doubted.push(place);
    if (!follows && this.#doubted.length < fixesInRow) {
      return [];
    }
    const believed = follows ? [place] : this.#doubted;
    this.#doubted = [];
    this.#last = place;
    return believed;
  }
}

// Of places in the order of time those that are believed.
export function believed(places) {
  const filter = new JumpFilter();
  return places.flatMap((place) => filter.add(place));
}

// The same, and the poor ones that a car can have reached between their believed neighbours: a poor fix, too, shows about where it was.
export function plausible(places) {
  const sure = believed(places);
  let next = 0;
  return places.filter((place) => {
    if (place === sure[next]) {
      next += 1;
      return true;
    }
    const near = { ...place, accuracy_m: Math.min(place.accuracy_m, poor_m) };
    return !isGood(place) && [sure[next - 1], sure[next]].every((each) => each && isReachable(each, near));
  });
}
