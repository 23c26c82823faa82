// Samples of a phone's sensors as rows of numbers, with the times of the events that brought them.
//
// A motion row: time (ms since 1970), acceleration with gravity, acceleration without, rate of turn; x, y, z
// of the screen in its natural position (x right, y up, z towards the reader); m/s2 and rad/s; NaN is unknown.
// A fix row: time of the last motion event before it (the sensors' clock), the receiver's own time (both ms
// since 1970), latitude, longitude (deg), accuracy, altitude, its accuracy (m), speed (m/s), course (deg).

export const motionWidth = 10;
export const fixWidth = 9;

export const motionColumn = { t_ms: 0, acc: 1, linear: 4, gyro: 7 };
export const fixColumn = { t_ms: 0, stamp_ms: 1, lat: 2, lon: 3, accuracy: 4, alt: 5, altAccuracy: 6, speed: 7, course: 8 };

const radPerDeg = Math.PI / 180;

const numberOr = (value) => (Number.isFinite(value) ? value : NaN);

// timeOrigin_ms: of the page that received the event; its time stamp counts from there.
export function motionRow(event, timeOrigin_ms) {
  const { accelerationIncludingGravity: force, acceleration: linear, rotationRate: turn } = event;
  return [
    timeOrigin_ms + event.timeStamp,
    numberOr(force?.x), numberOr(force?.y), numberOr(force?.z),
    numberOr(linear?.x), numberOr(linear?.y), numberOr(linear?.z),
    numberOr(turn?.alpha) * radPerDeg, numberOr(turn?.beta) * radPerDeg, numberOr(turn?.gamma) * radPerDeg,
  ];
}

export function fixRow(position, sensorTime_ms) {
  const c = position.coords;
  return [
    sensorTime_ms, position.timestamp, c.latitude, c.longitude, numberOr(c.accuracy), numberOr(c.altitude),
    numberOr(c.altitudeAccuracy), numberOr(c.speed), numberOr(c.heading),
  ];
}

// The vertical (upward, length 1) in the phone's axes, by its orientation (W3C: beta about x, gamma about y).
export function upBy(beta_deg, gamma_deg) {
  const beta = beta_deg * radPerDeg;
  const gamma = gamma_deg * radPerDeg;
  return [-Math.cos(beta) * Math.sin(gamma), Math.sin(beta), Math.cos(beta) * Math.cos(gamma)];
}

// Force along the vertical: about +9.8 m/s2 at rest where a browser follows W3C, -9.8 where it turns all signs
// round (Safari on iOS).
export function uprightForce(motion, up) {
  return motion[1] * up[0] + motion[2] * up[1] + motion[3] * up[2];
}

export function* rowsOf(numbers, width) {
  for (let i = 0; i + width <= numbers.length; i += width) {
    yield numbers.subarray(i, i + width);
  }
}
