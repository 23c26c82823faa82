import { distance_m } from './geometry.js';
import { JumpFilter, isReachable } from './places.js';

const step_m = 10; // a parked car's receiver wanders
const silence_ms = 300_000; // as long as a stop at which the log is cut in two

// Length of a trip by its fixes, in the order of time.
export class Odometer {
  length_m = 0;
  #filter = new JumpFilter();
  #counted = null; // place up to which the length is counted
  #last = null;

  add(place) {
    for (const next of this.#filter.add(place)) {
      const goesOn = this.#last !== null && isReachable(this.#last, next) && next.t_ms - this.#last.t_ms < silence_ms;
      const gone_m = goesOn ? distance_m(this.#counted, next) : 0;
      if (!goesOn || gone_m > step_m) {
        this.length_m += gone_m;
        this.#counted = next;
      }
      this.#last = next;
    }
  }
}
