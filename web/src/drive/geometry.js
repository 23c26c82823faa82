const earthRadius_m = 6371008.8; // mean radius, WGS 84
const radPerDeg = Math.PI / 180;

// Distance by air, within 0.5 % (sphere); places are { lat, lon } in degrees.
export function distance_m(a, b) {
  const sinLat = Math.sin(((b.lat - a.lat) * radPerDeg) / 2);
  const sinLon = Math.sin(((b.lon - a.lon) * radPerDeg) / 2);
  const square = sinLat ** 2 + Math.cos(a.lat * radPerDeg) * Math.cos(b.lat * radPerDeg) * sinLon ** 2;
  return 2 * earthRadius_m * Math.asin(Math.min(1, Math.sqrt(square)));
}

export function median(values) {
  const sorted = Float64Array.from(values).sort();
  return sorted[sorted.length >> 1];
}
