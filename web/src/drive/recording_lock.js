// The right to record, which one page of several has at a time.
const lockName = 'macadam-drive-record';
const patience_ms = 1000; // a page that is closed or loaded anew lets go a moment later

// Takes the right. Returns null if another page keeps it, else a function that gives it back and resolves once other
// pages can have it.
export function holdRecording(locks = navigator.locks) {
  return new Promise((resolve, reject) => {
    const held = locks.request(lockName, { signal: AbortSignal.timeout(patience_ms) }, () => new Promise((release) => {
      resolve(async () => {
        release();
        await held;
        await locks.query(); // answered after the browser's other processes know
      });
    }));
    held.catch((error) => (error.name === 'TimeoutError' || error.name === 'AbortError' ? resolve(null) : reject(error)));
  });
}
