// Filtered maps in three.js: a far view must be nearer to a supersampled one with them than with the engine's own levels, and a near view
// must stay as it is.
//
//     NODE_PACKAGES=tests/three node tests/three/maps.mjs --brdfbake target/release/brdfbake -o DIR
//
// Bakes tests/scenes/bumps, and writes maps.json and maps.png (far view: the engine's levels, the maps, 64 times supersampled).
// Exit code: 0 all as it must be, 1 not, 77 skipped.

import { spawnSync } from 'node:child_process';
import { copyFileSync, mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { deflateSync } from 'node:zlib';
import { packageFolder, withBrowser } from './browser.mjs';

const { values: args } = parseArgs({ options: { brdfbake: { type: 'string' }, out: { type: 'string', short: 'o' } } });
const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, '../..');
const three = packageFolder('three');
const work = mkdtempSync(join(tmpdir(), 'brdfbake-maps-'));
const SCENE = join(root, 'tests/scenes/bumps/bumps.gltf');
const PLUGIN = join(root, 'out-examples/13-three-maps/brdfbake-maps.js');
const FAR = { size: 48, zoom: 1, samples: 8 };
const NEAR = { size: 256, zoom: 24, samples: 1 };
const KINDS = ['roughness', 'normal', 'anisotropy'];

function bake(kind) {
    const folder = join(work, kind);
    const list = kind === 'roughness' ? '--maps' : `--maps=${kind}`;
    const words = ['bake', '--scene', SCENE, list, '-o', join(folder, 'tables'), '--write', join(folder, 'bumps.gltf'), '--quiet'];
    const done = spawnSync(resolve(args.brdfbake), words, { stdio: 'inherit' });
    if (done.status !== 0) throw new Error(`brdfbake ${words.join(' ')}: ${done.status}`);
}

const find = (path) => {
    if (path.startsWith('/three/')) return join(three, path.slice(7));
    if (path === '/plugin.js') return PLUGIN;
    if (path.startsWith('/old/')) return join(dirname(SCENE), path.slice(5));
    if (path.startsWith('/new/')) return join(work, path.slice(5));
    return join(here, path);
};

/** Root of the mean square of the differences. */
function distance(a, b) {
    return Math.sqrt(a.reduce((sum, value, i) => sum + (value - b[i]) ** 2, 0) / a.length);
}

const crc = (bytes) => {
    let c = ~0;
    for (const byte of bytes) {
        c ^= byte;
        for (let k = 0; k < 8; k++) c = (c >>> 1) ^ (c & 1 ? 0xedb88320 : 0);
    }
    return ~c >>> 0;
};

/** Pictures side by side, four pixels a pixel, as a PNG. */
function png(pictures, size, largest) {
    const scale = 4;
    const [width, height] = [(size * pictures.length) * scale, size * scale];
    const rows = Buffer.alloc(height * (width + 1));
    for (let y = 0; y < height; y++) {
        for (let x = 0; x < width; x++) {
            const column = Math.floor(x / scale);
            // the first row of WebGL is the lowest one
            const row = size - 1 - Math.floor(y / scale);
            const value = pictures[Math.floor(column / size)][row * size + (column % size)] / largest;
            rows[y * (width + 1) + 1 + x] = Math.round(255 * Math.min(1, Math.max(0, value)) ** (1 / 2.2));
        }
    }
    const chunk = (type, data) => {
        const [length, end, body] = [Buffer.alloc(4), Buffer.alloc(4), Buffer.concat([Buffer.from(type), data])];
        length.writeUInt32BE(data.length);
        end.writeUInt32BE(crc(body));
        return Buffer.concat([length, body, end]);
    };
    const header = Buffer.alloc(13);
    header.writeUInt32BE(width, 0);
    header.writeUInt32BE(height, 4);
    header.set([8, 0, 0, 0, 0], 8);
    const parts = [chunk('IHDR', header), chunk('IDAT', deflateSync(rows)), chunk('IEND', Buffer.alloc(0))];
    return Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), ...parts]);
}

async function run(open) {
    const found = {};
    let [fine, pictures] = [true, null];
    for (const kind of KINDS) {
        bake(kind);
        const page = await open('/maps.html');
        const look = ({ size, zoom, samples }) =>
            page.evaluate((a) => window.compare(...a), ['/old/bumps.gltf', `/new/${kind}/bumps.gltf`, size, zoom, samples]);
        const [far, near] = [await look(FAR), await look(NEAR)];
        await page.close();
        const largest = Math.max(...far.truth);
        const of = {
            far_engine: distance(far.engine, far.truth) / largest,
            far_maps: distance(far.maps, far.truth) / largest,
            near_difference: distance(near.engine, near.maps) / Math.max(...near.engine),
        };
        found[kind] = Object.fromEntries(Object.entries(of).map(([key, value]) => [key, Number(value.toPrecision(3))]));
        // a view of one colour would be equal too
        const seen = new Set(near.engine.map((v) => Math.round(v * 255))).size > 8;
        const good = seen && of.far_maps < 0.5 * of.far_engine && of.near_difference < 1 / 255;
        fine &&= good;
        pictures ??= [[far.engine, far.maps, far.truth], largest];
        console.log(`${good ? 'ok  ' : 'FAIL'} ${kind}: ${JSON.stringify(found[kind])}`);
    }
    mkdirSync(args.out, { recursive: true });
    writeFileSync(join(args.out, 'maps.json'), `${JSON.stringify({ unit: 'largest radiance of the supersampled view, root mean square', ...found }, null, 2)}\n`);
    writeFileSync(join(args.out, 'maps.png'), png(pictures[0], FAR.size, pictures[1]));
    if (resolve(args.out) !== dirname(PLUGIN)) copyFileSync(PLUGIN, join(args.out, 'brdfbake-maps.js'));
    return fine ? 0 : 1;
}

try {
    process.exitCode = await withBrowser(find, run);
} finally {
    rmSync(work, { recursive: true, force: true });
}
