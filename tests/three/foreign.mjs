// A browser reads what brdfbake writes: PNG by its own decoder, GLSL through WebGL 2, WGSL through WebGPU.
//
//     BRDFBAKE_FOREIGN=foreign-out cargo test --test files -- --ignored write_
//     NODE_PACKAGES=tests/three node tests/three/foreign.mjs foreign-out
//
// Exit code: 0 all agree, 1 a difference, 77 skipped.

import { readFileSync, readdirSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { withBrowser } from './browser.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const folder = resolve(process.argv[2] ?? '.');
const files = readdirSync(folder).filter((f) => f.endsWith('.png'));
const find = (path) => (path.startsWith('/files/') ? join(folder, path.slice(7)) : join(here, path));

/** Values that a file must hold, by channel. */
function expected(name) {
    const { width, height, storage, channels } = JSON.parse(readFileSync(join(folder, `${name}.expected.json`), 'utf8'));
    const bits = new DataView(new ArrayBuffer(8));
    const value = (word) => {
        bits.setBigUint64(0, BigInt(`0x${word}`));
        return bits.getFloat64(0);
    };
    // the metadata keeps the order of the channels; JSON objects do too
    return { width, height, storage, columns: Object.values(channels).map((column) => column.map(value)) };
}

/** Largest distance in codes of 8 bits between what a texture holds and the file. */
function codes(want, texel, c, value) {
    // in steps of the code, which the power makes uneven
    if (want.storage === 'rgbd') return Math.abs(255 * texel[c] - 255 * (value * texel[3]) ** (1 / 2.2));
    // of 16 bits the browser keeps the high byte in a texture of 8
    if (want.storage === 'unorm16') return Math.abs(255 * texel[c] - (Math.round(65535 * value) >> 8));
    return Math.abs(255 * texel[c] - 255 * value);
}

const srgb = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);

/** The same on a canvas of half floats, in steps of a half: sRGB of the linear number. */
const halves = (want, texel, c, value) => Math.abs(texel[c] - srgb(value)) / (2 ** -11 * Math.max(srgb(value), 2 ** -14));

function farthest(got, want, distance) {
    if (got.width !== want.width || got.height !== want.height) throw new Error(`${got.width} x ${got.height}`);
    const off = want.columns.flatMap((column, c) => column.map((value, i) => distance(want, got.pixels.slice(4 * i, 4 * i + 4), c, value)));
    return Math.max(...off);
}

/** Reads a picture both ways: what was found, and if that is right. */
async function png(page, name) {
    const want = expected(name);
    const off = farthest(await page.evaluate((url) => window.picture(url), `/files/${name}`), want, codes);
    const found = [`${name}: texture within ${off.toExponential(1)} codes of 8 bits`];
    let fine = off < 1e-3;
    // a canvas multiplies by the fourth component, and of grey Chromium keeps the high byte here too
    if (want.storage === 'unorm16' && [2, 3].includes(want.columns.length)) {
        const deep = await page.evaluate((url) => window.deep(url), `/files/${name}`);
        if (deep === null) console.log(`SKIPPED: this browser has no canvas of half floats, the low bytes of ${name} were not compared`);
        const steps = deep === null ? 0 : farthest(deep, want, halves);
        found.push(`canvas of half floats within ${steps.toFixed(2)} steps`);
        fine &&= steps <= 2;
    }
    return { fine, text: found.join(', ') };
}

function compare(what, got, table) {
    const want = table.want.flat();
    if (got.length !== want.length) throw new Error(`${what}: ${got.length} values, not ${want.length}`);
    const off = Math.max(...got.map((g, i) => Math.abs(g - want[i])));
    return { what: `${what}: ${table.at.length} points within ${off.toExponential(1)}`, fine: off <= table.tolerance };
}

async function run(open, version, faults) {
    const page = await open('/foreign.html');
    let [count, failed] = [0, 0];
    const tell = (fine, text) => {
        count += 1;
        failed += !fine;
        console.log(`${fine ? 'ok  ' : 'FAIL'} ${text}`);
    };
    for (const name of files) {
        const { fine, text } = await png(page, name).catch((e) => ({ fine: false, text: `${name}: ${e.message}` }));
        tell(fine, text);
    }
    const tables = JSON.parse(readFileSync(join(folder, 'shaders.json'), 'utf8'));
    for (const table of tables) {
        const { what, fine } = compare(`GLSL, ${table.name}`, await page.evaluate((t) => window.glsl(t), table), table);
        tell(fine, what);
    }
    const results = await page.evaluate((t) => window.wgsl(t), tables);
    if (results === null) console.log('SKIPPED: this browser has no WebGPU adapter, WGSL was not run');
    results?.forEach((got, i) => {
        const { what, fine } = compare(`WGSL, ${tables[i].name}`, got, tables[i]);
        tell(fine, what);
    });
    faults.forEach((fault) => tell(false, fault));
    console.log(`${version}: ${count} compared, ${failed} different`);
    return failed === 0 && count > 0 ? 0 : 1;
}

process.exit(await withBrowser(find, run));
