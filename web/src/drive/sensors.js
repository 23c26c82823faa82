// The phone's sensors and its screen, as browsers give them.

// Asks for leave to read the sensors of motion; iOS does it only in answer to a tap. Must be called before anything
// else is awaited.
export async function askForMotion() {
  const asks = [globalThis.DeviceMotionEvent, globalThis.DeviceOrientationEvent]
    .filter((type) => typeof type?.requestPermission === 'function')
    .map((type) => type.requestPermission());
  const answers = await Promise.allSettled(asks);
  return answers.every((answer) => answer.value === 'granted');
}

// Calls back for each reading until the returned function is called.
export function listen({ onMotion, onOrientation, onPosition, onPositionError }) {
  addEventListener('devicemotion', onMotion);
  addEventListener('deviceorientation', onOrientation);
  const watch = navigator.geolocation?.watchPosition(onPosition, onPositionError,
    { enableHighAccuracy: true, maximumAge: 0, timeout: 30_000 });
  return () => {
    removeEventListener('devicemotion', onMotion);
    removeEventListener('deviceorientation', onOrientation);
    navigator.geolocation?.clearWatch(watch);
  };
}

// Keeps the screen awake until the returned function is called. Browsers let it sleep whenever the page was hidden, so
// that it is asked for again. onChange(isAwake).
export function keepAwake(onChange) {
  let lock = null;
  let isWanted = true;
  const ask = async () => {
    if (!isWanted || document.visibilityState !== 'visible' || (lock && !lock.released)) {
      return;
    }
    try {
      lock = await navigator.wakeLock.request('screen');
      lock.addEventListener('release', () => onChange(false));
      onChange(true);
      if (!isWanted) {
        await lock.release();
      }
    } catch {
      onChange(false);
    }
  };
  document.addEventListener('visibilitychange', ask);
  ask();
  return () => {
    isWanted = false;
    document.removeEventListener('visibilitychange', ask);
    lock?.release();
  };
}
