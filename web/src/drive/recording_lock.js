// The right to record, which one page of several has at a time.
const lockName = 'macadam-drive-record';
const patience_ms = 1000; // a page that is closed or loaded anew lets go a moment later

const isHeld = async (locks) => (await locks.query()).held.some(({ name }) => name === lockName);

// Waits for the right for a second; null: it did not come.
function waitForRight(locks) {
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

// Takes the right. Returns null if another page keeps it, else a function that gives it back and resolves once other
// pages can have it.
export async function holdRecording(locks = navigator.locks) {
  for (;;) {
    const letGo = await waitForRight(locks);
    if (letGo || (await isHeld(locks))) {
      return letGo;
    }
  } // a busy phone took its time
}
