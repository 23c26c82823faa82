// A log as it is kept and sent (gzip, about a quarter of its size), and as people read it.
const gzip = 'application/gzip';

const through = async (blob, stream, type) => new Blob([await new Response(blob.stream().pipeThrough(stream)).arrayBuffer()], { type });

// Compresses a log; browsers that cannot leave it plain.
export const compressed = async (log) => (globalThis.CompressionStream ? through(log, new CompressionStream('gzip'), gzip) : log);

export const plain = async (log) => (log.type === gzip ? through(log, new DecompressionStream('gzip'), 'text/csv') : log);
