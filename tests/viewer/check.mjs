// SPDX-License-Identifier: MIT
// What three.js shows of a baked lightmap, beside the radiance that it stands for: node check.mjs MAKE_LIGHTMAP
// Exits 77 (skipped) where there is no Chromium or three.js is not installed (`npm ci` here; scripts/test does).
import { execFileSync, spawn } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { dirname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const three = join(here, 'node_modules/three');
const names = ['chromium', 'chromium-browser', 'google-chrome'];
const folders = (process.env.PATH ?? '').split(':');
const browser = process.env.CHROMIUM ?? names.flatMap((n) => folders.map((f) => join(f, n))).find((p) => existsSync(p));
if (!existsSync(three) || !browser) {
  console.log(`skipped: ${browser ? 'three.js is not installed' : 'there is no Chromium'}`);
  process.exit(77);
}

const folder = mkdtempSync(join(tmpdir(), 'relume_viewer_'));
const scene = join(folder, 'scene.glb');
execFileSync(process.argv[2], [scene, join(folder, 'expected.json')], { stdio: 'inherit' });
const validator = join(here, '../validate');
if (existsSync(join(validator, 'node_modules'))) execFileSync('node', [join(validator, 'validate.mjs'), scene], { stdio: 'inherit' });
const expected = JSON.parse(readFileSync(join(folder, 'expected.json')));

/** Serves the page, and gives what it posts back. */
function show() {
  return new Promise((resolve, reject) => {
    const give = (response, path, type) => response.writeHead(200, { 'content-type': type }).end(readFileSync(path));
    const server = createServer((request, response) => {
      const path = normalize(request.url);
      if (request.method === 'POST') {
        let body = '';
        request.on('data', (part) => (body += part)).on('end', () => (response.end(), done(JSON.parse(body))));
      } else if (path === '/') give(response, join(here, 'page.html'), 'text/html');
      else if (path === '/scene.glb') give(response, scene, 'model/gltf-binary');
      else if (path.startsWith('/three/') && existsSync(join(three, path.slice(7)))) give(response, join(three, path.slice(7)), 'text/javascript');
      else response.writeHead(404).end();
    });
    let process_ = null;
    const limit = setTimeout(() => done(null), 90e3);
    const done = (result) => {
      clearTimeout(limit);
      server.close();
      server.closeAllConnections();
      process_.once('exit', () => (result ? resolve(result) : reject(new Error('the browser did not answer'))));
      process_.kill();
    };
    server.listen(0, '127.0.0.1', () => {
      const options = ['--headless', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader',
        '--disable-dev-shm-usage', `--user-data-dir=${join(folder, 'profile')}`];
      process_ = spawn(browser, [...options, `http://127.0.0.1:${server.address().port}/`], { stdio: 'ignore' });
      process_.once('error', reject);
    });
  });
}

const srgb = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * Math.min(v, 1) ** (1 / 2.4) - 0.055);

/** The errors of what was shown: in linear light within a step of the page, and on a screen within 2/255. */
function compare(shown) {
  const errors = [];
  for (const { x, radiance, step } of expected) {
    const at = Math.floor(((x - shown.left) / (shown.right - shown.left)) * shown.row.length);
    radiance.forEach((value, channel) => {
      const seen = shown.row[at][channel];
      const where = `x = ${x.toFixed(2)}, channel ${channel}: ${seen.toFixed(5)} is shown, ${value.toFixed(5)} is right`;
      if (Math.abs(seen - value) > step[channel] + 0.002 * value) errors.push(where);
      // Where a step of the page is a small one on the screen.
      if (step[channel] < 0.01 * value && Math.abs(srgb(seen) - srgb(value)) > 2 / 255) errors.push(`${where} (on a screen)`);
    });
  }
  return errors;
}

try {
  const shown = await show();
  const errors = shown.error ? [shown.error] : compare(shown);
  errors.forEach((error) => console.error(error));
  console.log(`three.js r${shown.three}: ${expected.length} places, ${errors.length} errors`);
  process.exitCode = errors.length > 0 ? 1 : 0;
} finally {
  rmSync(folder, { recursive: true, force: true, maxRetries: 5 });
}
