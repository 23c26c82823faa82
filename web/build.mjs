// Builds the page into a folder: node build.mjs FOLDER
// Our own code is one file, site.js; libraries lie beside it as their authors built them.
import { build } from 'esbuild';
import { copyFile, mkdir, readFile, readdir, rm, writeFile } from 'node:fs/promises';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const [given] = process.argv.slice(2);
if (!given) {
  console.error('usage: node build.mjs FOLDER');
  process.exit(2);
}
const out = resolve(given); // esbuild knows another current folder
const assets = join(out, 'assets');
const options = { bundle: true, minify: true, format: 'esm', target: 'es2022', legalComments: 'inline', absWorkingDir: here, logLevel: 'warning' };

await rm(out, { recursive: true, force: true });
await mkdir(assets, { recursive: true });
// Libraries that the page imports are files of their own, so that what is ours can be measured.
const beside = {
  name: 'beside',
  setup({ onResolve }) {
    onResolve({ filter: /^(maplibre-gl|pmtiles)$/ }, ({ path, kind }) =>
      kind === 'entry-point' ? null : { path: `./${path === 'pmtiles' ? 'pmtiles.js' : 'maplibre-gl.mjs'}`, external: true });
  },
};
await build({ ...options, entryPoints: [join(here, 'src/site.js')], outfile: join(assets, 'site.js'), plugins: [beside] });
await build({ ...options, entryPoints: ['pmtiles'], outfile: join(assets, 'pmtiles.js') });
await build({ ...options, entryPoints: [join(here, 'src/site.css')], outfile: join(assets, 'site.css') });
for (const file of ['maplibre-gl.mjs', 'maplibre-gl-worker.mjs', 'maplibre-gl.css']) {
  await copyFile(join(here, 'node_modules/maplibre-gl/dist', file), join(assets, file));
}
// The recorder is a page of its own in drive/, which does without libraries.
for (const file of ['drive.js', 'drive.css']) {
  await build({ ...options, entryPoints: [join(here, 'src/drive', file)], outfile: join(out, 'drive', file) });
}
for (const file of ['index.html', 'service_worker.js', 'manifest.webmanifest', 'icon.svg', 'icon-180.png', 'icon-512.png']) {
  await copyFile(join(here, 'static/drive', file), join(out, 'drive', file));
}
// So is that of a queue, for operators of a server.
for (const file of ['queue.js', 'queue.css']) {
  await build({ ...options, entryPoints: [join(here, 'src/queue', file)], outfile: join(out, 'queue', file) });
}
await copyFile(join(here, 'static/queue/index.html'), join(out, 'queue/index.html'));
for (const file of ['index.html', 'service_worker.js', 'assets/icon.svg']) {
  await copyFile(join(here, 'static', file), join(out, file));
}

// The words of the licences of all that came from npm go with the page.
const { packages } = JSON.parse(await readFile(join(here, 'package-lock.json'), 'utf8'));
let licences = '';
for (const [path, { dev, version, license }] of Object.entries(packages)) {
  if (!path || dev) continue;
  const folder = join(here, path);
  const files = (await readdir(folder)).filter((name) => /^licen[cs]e/i.test(name));
  const words = await Promise.all(files.map((name) => readFile(join(folder, name), 'utf8')));
  licences += `${path.replace('node_modules/', '')} ${version}: ${license}\n\n${words.join('\n').trim()}\n\n----\n\n`;
}
await writeFile(join(assets, 'licences.txt'), licences);
