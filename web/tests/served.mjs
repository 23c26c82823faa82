// A running server of a database; its tiles are made.
import { spawn } from 'node:child_process';
import { createInterface } from 'node:readline';

export async function served(database, ...words) {
  const server = spawn(process.env.MACADAM_PROGRAM, ['serve', database, '--listen', '127.0.0.1:0', ...words], { stdio: ['ignore', 'ignore', 'pipe'] });
  let url;
  for await (const line of createInterface(server.stderr)) {
    url = /serving on (http:\/\/[\d.]+:\d+)\//.exec(line)?.[1];
    if (url) break;
  }
  server.stderr.resume();
  const waitFor = async (path) => {
    while ((await fetch(url + path)).status !== 200) await new Promise((resolve) => { setTimeout(resolve, 200); });
  };
  await waitFor('/tiles.json');
  return { url, waitFor, close: () => server.kill() };
}
