// Bundles the page into dist/: agentface.js, which needs nothing else, with the licences of what is in it, and face3d.js,
// the face alone for a scene whose page brings three.js.

import { build } from 'esbuild';
import { copyFile, mkdir, readFile, rm, writeFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const dist = join(here, 'dist');

await rm(dist, { recursive: true, force: true });
await mkdir(dist);
const options = { bundle: true, minify: true, format: 'esm', target: 'es2022', legalComments: 'none', metafile: true };
const result = await build({
  ...options, entryPoints: [join(here, 'src/index.js')], outfile: join(dist, 'agentface.js'),
  banner: { js: '/* agentface, MIT; three.js, MIT: see licences.txt */' },
});

// for a page that has three.js already
await build({
  ...options, entryPoints: [join(here, 'src/face3d.js')], outfile: join(dist, 'face3d.js'), external: ['three'],
  banner: { js: '/* agentface, MIT */' },
});

const packages = new Set();
for (const input of Object.keys(result.metafile.inputs)) {
  const match = input.match(/node_modules\/((?:@[^/]+\/)?[^/]+)\//);
  if (match) packages.add(match[1]);
}
const texts = [];
for (const name of [...packages].sort()) {
  const { version, license } = JSON.parse(await readFile(join(here, 'node_modules', name, 'package.json'), 'utf8'));
  texts.push(`${name} ${version} (${license})\n\n${await readFile(join(here, 'node_modules', name, 'LICENSE'), 'utf8')}`);
}
await writeFile(join(dist, 'licences.txt'), texts.join('\n\n'));
for (const name of ['index.html', 'recording.html']) await copyFile(join(here, name), join(dist, name));
