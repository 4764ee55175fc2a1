// `brdfbake preview --engine three` beside three.js itself, in a browser, with the baked tables in place of the shipped ones.
//
//     NODE_PACKAGES=... node tests/three/preview.mjs --brdfbake target/release/brdfbake [--short]
//
// --short: smaller spheres, the panel on spheres of metal alone.
//
// Both are turned to 8-bit sRGB without tone mapping and compared where the sphere covers the whole pixel. Exit code: 0 if the RMSE of
// every sphere is at most 2 of 255, 1 if not, 77 skipped.

import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { packageFolder, withBrowser } from './browser.mjs';

const BOUND = 2;
const short = process.argv.includes('--short');
const SIZE = short ? 48 : 128;
// three.js widens the roughness by the change of the normal over a pixel: pixels are small here
const MESH = 256;
const here = dirname(fileURLToPath(import.meta.url));
const at = process.argv.indexOf('--brdfbake');
const brdfbake = resolve(at < 0 ? 'target/release/brdfbake' : process.argv[at + 1]);
const three = packageFolder('three');
const temporary = mkdtempSync(join(tmpdir(), 'brdfbake-preview-'));
const roughness = [0.1, 0.3, 0.5, 0.7, 1];
const CASES = [
    { name: 'gold', base: [1, 0.77, 0.34], metallic: 1 },
    { name: 'plastic', base: [0.2, 0.4, 0.6], metallic: 0 },
    { name: 'white metal in a furnace', base: [1, 1, 1], metallic: 1, furnace: true },
    { name: 'gold under the panel', base: [1, 0.77, 0.34], metallic: 1, panel: true },
    { name: 'plastic under the panel', base: [0.2, 0.4, 0.6], metallic: 0, panel: true },
].filter((c) => !c.panel || !short || c.metallic === 1);
const MESHES = [{ name: 'mesh' }, { name: 'mesh under the panel', panel: true }].filter((m) => !m.panel || !short);

execFileSync(brdfbake, ['bake', '--engine', 'three', '-o', temporary, '--quiet'], { stdio: 'inherit' });
CASES.forEach((c, n) => {
    const options = ['--engine', 'three', '--base', c.base.join(','), '--metallic', c.metallic, '--roughness', roughness.join(','), '--size', SIZE];
    execFileSync(brdfbake, ['preview', ...options, ...(c.furnace ? ['--furnace'] : []), ...(c.panel ? ['--panel'] : []), '-o', join(temporary, `${n}.png`)], { stdio: 'ignore' });
});

MESHES.forEach((m, n) => {
    const options = ['--engine', 'three', '--scene', join(here, '../scenes/knot/knot.gltf'), '--mesh', '--size', MESH];
    execFileSync(brdfbake, ['preview', ...options, ...(m.panel ? ['--panel'] : []), '-o', join(temporary, `${CASES.length + n}.png`)], { stdio: 'ignore' });
});

const REPLACED = { 'src/renderers/shaders/DFGLUTData.js': 'DFGLUTData.js', 'examples/jsm/lights/RectAreaLightTexturesLib.js': 'RectAreaLightTexturesLib.js' };
const served = new Set();
function find(path) {
    const rest = path.slice(1);
    if (rest.includes('..')) return undefined;
    if (/^\d+\.png$/.test(rest)) return join(temporary, rest);
    if (/^knot\.(gltf|bin)$/.test(rest)) return join(here, '../scenes/knot', rest);
    if (!rest.startsWith('three/')) return join(here, rest);
    const baked = REPLACED[rest.slice(6)];
    if (baked) served.add(baked);
    return baked ? join(temporary, baked) : join(three, rest.slice(6));
}

const srgb = (v) => {
    const c = Math.min(Math.max(v, 0), 1);
    return Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
};

/** RMSE and largest difference in codes over the pixels of a sphere that lie inside by a pixel. */
function compare(rendered, { width, data }, sphere) {
    let [sum, n, largest] = [0, 0, 0];
    for (let y = 0; y < SIZE; y++) {
        for (let x = 0; x < SIZE; x++) {
            const r = Math.hypot(x + 0.5 - SIZE / 2, y + 0.5 - SIZE / 2);
            if (r > SIZE / 2 - 1) continue;
            const [a, b] = [4 * (y * SIZE + x), 4 * ((SIZE + y) * width + sphere * SIZE + x)];
            for (let c = 0; c < 3; c++) {
                const d = srgb(rendered[a + c]) - data[b + c];
                [sum, n, largest] = [sum + d * d, n + 1, Math.max(largest, Math.abs(d))];
            }
        }
    }
    return { rmse: Math.sqrt(sum / n), largest };
}

/** The same of a mesh, over the pixels whose neighbours show the same part of it, from no farther round than 75 degrees. */
function compareMesh({ rendered, normals }, { data }) {
    let [sum, n, largest] = [0, 0, 0];
    const normal = (x, y) => [0, 1, 2].map((c) => 2 * normals[4 * (y * MESH + x) + c] - 1);
    const seen = (x, y) => x >= 0 && y >= 0 && x < MESH && y < MESH && rendered[4 * (y * MESH + x) + 3] === 1 && normal(x, y)[2] > 0.26;
    const near = (a, b) => Math.hypot(...a.map((v, c) => v - b[c])) < 0.5;
    for (let y = 0; y < MESH; y++) {
        for (let x = 0; x < MESH; x++) {
            const inside = (dx, dy) => seen(x + dx, y + dy) && near(normal(x, y), normal(x + dx, y + dy));
            if (!seen(x, y) || ![-1, 0, 1].every((dy) => [-1, 0, 1].every((dx) => inside(dx, dy)))) continue;
            const [a, b] = [4 * (y * MESH + x), 4 * ((MESH + y) * MESH + x)];
            for (let c = 0; c < 3; c++) {
                const d = srgb(rendered[a + c]) - data[b + c];
                [sum, n, largest] = [sum + d * d, n + 1, Math.max(largest, Math.abs(d))];
            }
        }
    }
    return { rmse: Math.sqrt(sum / n), largest, pixels: n / 3 };
}

const worst = await withBrowser(find, async (open, version) => {
    const page = await open('/preview.html');
    let worst = 0;
    for (const [n, c] of CASES.entries()) {
        const surfaces = roughness.map((r) => ({ base: c.base, metallic: c.metallic, roughness: r }));
        const rendered = await page.evaluate((o) => window.spheres(o), { size: SIZE, surfaces, furnace: c.furnace, panel: c.panel });
        const picture = await page.evaluate((url) => window.decoded(url), `/${n}.png`);
        const found = rendered.map((r, i) => compare(r, picture, i));
        worst = Math.max(worst, ...found.map((f) => f.rmse));
        console.log(`${c.name}: RMSE ${found.map((f) => f.rmse.toFixed(2)).join(', ')} of 255 at roughness ${roughness.join(', ')}; largest ${Math.max(...found.map((f) => f.largest))}`);
    }
    for (const [n, m] of MESHES.entries()) {
        const rendered = await page.evaluate((o) => window.mesh(o), { size: MESH, url: '/knot.gltf', panel: m.panel });
        const picture = await page.evaluate((url) => window.decoded(url), `/${CASES.length + n}.png`);
        const found = compareMesh(rendered, picture);
        if (found.pixels < 10 * MESH) throw new Error(`${found.pixels} pixels of the mesh are compared`);
        worst = Math.max(worst, found.rmse);
        console.log(`${m.name}: RMSE ${found.rmse.toFixed(2)} of 255 over ${found.pixels} pixels; largest ${found.largest}`);
    }
    console.log(`largest RMSE ${worst.toFixed(2)} of 255, ${version}`);
    return worst;
});
rmSync(temporary, { recursive: true, force: true });
if (served.size !== 2) throw new Error(`the page loaded ${[...served]} of the baked files`);
process.exit(worst <= BOUND ? 0 : 1);
