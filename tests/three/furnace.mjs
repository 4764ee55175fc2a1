// three.js in a white furnace, with the table that it ships and with the one that brdfbake writes in its place.
//
//     cd tests/three && npm install && cd ../..
//     NODE_PACKAGES=tests/three node tests/three/furnace.mjs --brdfbake target/release/brdfbake -o OUT
//
// Metal spheres (metalness 1, roughness 0 to 1) in a uniform white environment are rendered by three's own renderer; nothing is changed
// but the answer of the server for src/renderers/shaders/DFGLUTData.js. Patches under 2^16 directional lights, together a white sphere,
// show the compensation of direct light. Expected are the formulas of three's shader with accurate integrals (expected.toml), not with
// texels of a table.
//
// `--texels least-squares` bakes the table with texels that are fitted to the reader; `--tables DIR` takes it from there.
//
// Writes furnace.json, furnace.md and furnace.png. Exit code: 0 the baked table was loaded and is nearer on average, 1 not, 77 skipped.

import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { packageFolder, withBrowser } from './browser.mjs';
import { compare, expectation, halves } from './energy.mjs';
import { markdown, picture } from './show.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const option = (name, otherwise) => {
    const at = process.argv.indexOf(name);
    return at < 0 ? otherwise : process.argv[at + 1];
};
const brdfbake = resolve(option('--brdfbake', 'target/release/brdfbake'));
const out = resolve(option('-o', 'brdfbake-three'));

const RADIUS = 40;
const ROUGHNESS = Array.from({ length: 11 }, (_, i) => i / 10);
const F0 = [1, 0.5, 0.04];
const DIRECT = { cosines: 32, roughness: ROUGHNESS.slice(3), lights: 2 ** 16, batch: 32 };
const REPLACED = 'src/renderers/shaders/DFGLUTData.js';

const three = packageFolder('three');
const temporary = mkdtempSync(join(tmpdir(), 'brdfbake-three-'));
const tables = resolve(option('--tables', temporary));
const bake = (...what) => execFileSync(brdfbake, ['bake', ...what, '-o', temporary, '--quiet'], { stdio: 'inherit' });

/** What to bake: the engine's tables, or the same recipe with a line more. */
function table() {
    const texels = option('--texels');
    if (texels === undefined) return ['--engine', 'three'];
    const preset = readFileSync(join(here, '../../presets/engines/three.toml'), 'utf8');
    const recipe = join(temporary, 'recipe.toml');
    writeFileSync(recipe, preset.replace('texels = "auto"', `texels = "${texels}"`));
    return [recipe];
}

/** The files of the two pages: /shipped/ and /baked/ differ in one. */
let served = 0;
function find(path) {
    const [, table, rest] = path.match(/^\/(shipped|baked)\/(.*)$/) ?? [];
    if (rest === undefined || rest.includes('..')) return undefined;
    if (table === 'baked' && rest === `three/${REPLACED}`) {
        served += 1;
        return join(tables, 'DFGLUTData.js');
    }
    return rest.startsWith('three/') ? join(three, rest.slice(6)) : join(here, rest);
}

async function measure(open, table) {
    const page = await open(`/${table}/page.html`);
    const read = await page.evaluate(() => window.table());
    const spheres = await page.evaluate((o) => window.spheres(o), { radius: RADIUS, roughness: ROUGHNESS, f0: F0 });
    const direct = await page.evaluate((o) => window.patches(o), DIRECT);
    return { page, table: halves(read), spheres, direct };
}

async function run(open, browser, faults) {
    const [shipped, baked] = [await measure(open, 'shipped'), await measure(open, 'baked')];
    const expected = expectation(readFileSync(join(temporary, 'expected.csv'), 'utf8'));
    const result = compare({ shipped, baked, expected, roughness: ROUGHNESS, f0: F0, direct: DIRECT, radius: RADIUS });
    result.three = JSON.parse(readFileSync(join(three, 'package.json'), 'utf8')).version;
    mkdirSync(out, { recursive: true });
    writeFileSync(join(out, 'furnace.json'), `${JSON.stringify(result, null, 1)}\n`);
    writeFileSync(join(out, 'furnace.md'), markdown(result));
    const png = await picture(shipped.page, { shipped, baked, expected, roughness: ROUGHNESS, f0: F0, radius: RADIUS, result });
    writeFileSync(join(out, 'furnace.png'), Buffer.from(png, 'base64'));
    console.log(markdown(result));
    console.log(`${browser}, three ${result.three}`);

    const text = readFileSync(join(tables, 'DFGLUTData.js'), 'utf8');
    const written = text.slice(text.indexOf('Uint16Array( ['), text.indexOf('] )')).match(/0x[0-9a-f]{4}|\b\d+\b/g);
    const same = baked.table.codes.length === 512 && written.slice(-512).every((w, i) => Number(w) === baked.table.codes[i]);
    const wrong = [...faults];
    if (served === 0 || !same) wrong.push('the renderer did not read the baked table');
    if (shipped.table.codes.every((c, i) => c === baked.table.codes[i])) wrong.push('both pages read the same table');
    for (const { what, shipped: s, baked: b } of result.summary) {
        if (!(b.mean <= s.mean) && s.mean > 1e-6) wrong.push(`${what}: the baked table is off by ${b.mean} on average, the shipped by ${s.mean}`);
    }
    if (result.white.largest > 1e-3) wrong.push(`a white metal in the environment is off by ${result.white.largest}`);
    wrong.forEach((w) => console.error(`FAIL ${w}`));
    return wrong.length === 0 ? 0 : 1;
}

let code = 1;
try {
    if (tables === temporary) bake(...table());
    bake(join(here, 'expected.toml'));
    code = await withBrowser(find, run);
} finally {
    rmSync(temporary, { recursive: true, force: true });
}
process.exit(code);
