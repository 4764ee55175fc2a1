// A browser reads what brdfbake writes: PNG by its own decoder, GLSL through WebGL 2, WGSL through WebGPU.
//
//     BRDFBAKE_FOREIGN=foreign-out cargo test --test foreign --test containers -- --ignored write_
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

/** Largest distance between the codes that the browser gives and those of the file, and what is allowed. */
async function png(page, name) {
    const want = expected(name);
    const float = want.storage === 'unorm16';
    const got = await page.evaluate(([url, f]) => window.picture(url, f), [`/files/${name}`, float]);
    if (got.width !== want.width || got.height !== want.height) throw new Error(`${got.width} x ${got.height}`);
    let [largest, allowed] = [0, 0];
    want.columns.forEach((column, c) =>
        column.forEach((value, i) => {
            const texel = got.pixels.slice(4 * i, 4 * i + 4);
            if (want.storage === 'rgbd') {
                // in steps of the code, which the power makes uneven
                const code = 255 * (value * texel[3]) ** (1 / 2.2);
                largest = Math.max(largest, Math.abs(255 * texel[c] - code) / 255);
                allowed = 1e-4 / 255;
                return;
            }
            largest = Math.max(largest, Math.abs(texel[c] - value));
            allowed = float ? HIGH : 1e-6;
        }),
    );
    return { largest, allowed };
}

// a 16-bit picture reaches a texture as 8-bit codes: browsers say nothing of more
const HIGH = 0.5 / 255 + 1e-6;

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
        const result = await png(page, name).catch((e) => ({ largest: NaN, fault: e.message }));
        tell(result.largest <= result.allowed, `${name}: ${result.fault ?? `codes within ${result.largest.toExponential(1)}`}`);
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
