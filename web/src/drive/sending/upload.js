// Client of a server's trips and tokens (docs/reference/recorder.md).

export const maxUpload_bytes = 64 * 2 ** 20; // of a log as it is sent

export async function sha256Hex(bytes) {
  const digest = await crypto.subtle.digest('SHA-256', bytes);
  return [...new Uint8Array(digest)].map((byte) => byte.toString(16).padStart(2, '0')).join('');
}

const pauses_s = [5, 15, 60, 300, 900];

function retryAfter_s(response, attempt) {
  const stated = Number(response?.headers.get('Retry-After'));
  return stated > 0 ? Math.min(stated, 3600) : pauses_s[Math.min(attempt, pauses_s.length - 1)];
}

async function reasonOf(response) {
  try {
    const body = await response.json();
    return String(body.detail ?? body.error ?? body.title ?? '').slice(0, 300);
  } catch {
    return '';
  }
}

const patience_ms = 30_000; // of requests without a log

const authorisation = (token) => (token ? { Authorization: `Bearer ${token}` } : {});

async function outcomeOf(response, attempt) {
  if (response.status === 200 || response.status === 202) {
    return { outcome: 'received' };
  }
  if (response.status === 401 || response.status === 403) {
    return { outcome: 'no_leave' };
  }
  if ([404, 405, 501].includes(response.status)) {
    return { outcome: 'no_server' };
  }
  if (response.status === 413) {
    return { outcome: 'too_large' };
  }
  if (response.status === 408 || response.status === 429 || response.status >= 500) {
    return { outcome: 'later', after_s: retryAfter_s(response, attempt) };
  }
  return { outcome: 'refused', reason: (await reasonOf(response)) || `HTTP ${response.status}` };
}

// Sends a log once. A trip that was tried before is asked for first: the server may have it, although its answer was
// lost on the way.
//
// trip: { sha256, body (a Blob, whose type is sent), attempt }. Returns { outcome: received | later (after_s) | no_leave |
// no_server | too_large | refused (reason) }.
export async function sendTrip(trip, { token, base, signal, fetch = globalThis.fetch }) {
  const url = new URL(`v1/trips/${trip.sha256}`, base);
  const headers = authorisation(token);
  try {
    if (trip.attempt > 0) {
      const known = await fetch(url, { headers, signal });
      if (known.ok) {
        return { outcome: 'received' };
      }
    }
    const response = await fetch(url, {
      method: 'PUT',
      headers: { ...headers, 'Content-Type': trip.body.type },
      body: trip.body,
      signal,
    });
    return await outcomeOf(response, trip.attempt);
  } catch {
    return { outcome: 'later', after_s: retryAfter_s(null, trip.attempt) };
  }
}

// Exchanges an invitation for a token. Returns the token; null: the server does not take it (any more); undefined: the
// server does not answer now.
export async function acceptInvitation(invitation, { base, fetch = globalThis.fetch }) {
  try {
    const response = await fetch(new URL('v1/tokens', base), {
      method: 'POST', headers: authorisation(invitation), signal: AbortSignal.timeout(patience_ms),
    });
    if (response.status === 408 || response.status === 429 || response.status >= 500) {
      return undefined;
    }
    return response.ok ? (await response.json()).token : null;
  } catch {
    return undefined;
  }
}

// Asks for a trip to be deleted at the server. Returns gone; deleting (it will be); missing: the token's name has no such
// trip there; undefined: the server did not do it.
export async function deleteAtServer(sha256, { token, base, fetch = globalThis.fetch }) {
  try {
    const response = await fetch(new URL(`v1/trips/${sha256}`, base), {
      method: 'DELETE', headers: authorisation(token), signal: AbortSignal.timeout(patience_ms),
    });
    return response.status === 404 ? 'missing' : response.status === 202 ? 'deleting' : response.ok ? 'gone' : undefined;
  } catch {
    return undefined;
  }
}

// Asks for the trips of the token's name. Returns { trips } as docs/reference/serve.md describes them, the latest first,
// { problem: 'no_leave' }, or {} if the server does not answer.
export async function listAtServer({ token, base, fetch = globalThis.fetch }) {
  try {
    const response = await fetch(new URL('v1/trips', base), {
      headers: authorisation(token), cache: 'no-store', signal: AbortSignal.timeout(patience_ms),
    });
    if (response.status === 401 || response.status === 403) {
      return { problem: 'no_leave' };
    }
    return response.ok ? { trips: (await response.json()).trips } : {};
  } catch {
    return {};
  }
}
