// Reads the KTX2 files of tests/foreign.rs with npm ktx-parse (and fzstd for Zstandard) and compares what it sees.
//
//     npm install --no-save ktx-parse fzstd
//     BRDFBAKE_FOREIGN=foreign-out cargo test --test files -- --ignored write_
//     node tests/foreign/read_ktx2.mjs foreign-out
//
// Exit code: 0 all agree, 1 a difference, 2 nothing to compare.

import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';

// the packages are looked for where the script is called, not where it lies
const require = createRequire(join(process.cwd(), 'package.json'));
const { read } = await import(pathToFileURL(require.resolve('ktx-parse')));
const { decompress } = require('fzstd');

const folder = process.argv[2];
const files = readdirSync(folder).filter((f) => f.endsWith('.ktx2'));
let failed = 0;

function half(bits) {
    const [s, e, m] = [bits >> 15, (bits >> 10) & 31, bits & 1023];
    const v = e ? (1 + m / 1024) * 2 ** (e - 15) : m * 2 ** -24;
    return s ? -v : v;
}

/** Components of a texel, by storage; channel ranges are [0, 1]. Nothing for a storage that this script cannot decode. */
function texels(data, storage, n) {
    const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
    const out = [];
    const each = (size, f) => {
        for (let i = 0; i < data.byteLength; i += size) out.push(f(i));
    };
    const packed = (f) => {
        for (let i = 0; i < data.byteLength; i += 4) out.push(...f(view.getUint32(i, true)).slice(0, n));
    };
    const small = (bits, mantissa) => half(bits << (10 - mantissa));
    const reader = {
        half: () => each(2, (i) => half(view.getUint16(i, true))),
        float: () => each(4, (i) => view.getFloat32(i, true)),
        unorm8: () => each(1, (i) => view.getUint8(i) / 255),
        unorm16: () => each(2, (i) => view.getUint16(i, true) / 65535),
        rgb10a2: () => packed((w) => [0, 10, 20].map((s) => ((w >>> s) & 1023) / 1023)),
        r11g11b10: () => packed((w) => [small(w & 2047, 6), small((w >>> 11) & 2047, 6), small(w >>> 22, 5)]),
        rgb9e5: () => packed((w) => [0, 9, 18].map((s) => ((w >>> s) & 511) * 2 ** ((w >>> 27) - 24))),
        rgbd: () => packed((w) => [0, 8, 16].map((s) => (((w >>> s) & 255) / 255) ** 2.2 / ((w >>> 24) / 255))),
    };
    if (!(storage in reader)) return undefined;
    reader[storage]();
    return out;
}

for (const name of files) {
    const expected = JSON.parse(readFileSync(join(folder, `${name}.expected.json`), 'utf8'));
    const faults = [];
    const file = read(new Uint8Array(readFileSync(join(folder, name))));
    if (file.pixelWidth !== expected.width || file.pixelHeight !== expected.height) faults.push('size');
    if (file.levels.length !== 1 || file.faceCount !== 1) faults.push('levels or faces');
    if (file.pixelDepth !== (expected.depth ?? 0) || file.layerCount !== (expected.layers ?? 0)) faults.push('depth or layers');
    if ((file.supercompressionScheme === 2) !== name.includes('zstd')) faults.push('supercompression');
    const dfd = file.dataFormatDescriptor[0];
    // colour models of the data format specification: 1 is RGBSDA, blocks have their own
    const model = { bc4: 131, bc5: 132, bc6h: 133, 'bc6h-signed': 133 }[expected.storage] ?? 1;
    if (dfd.colorModel !== model || dfd.transferFunction !== 1) faults.push('descriptor');
    const text = file.keyValue.brdfbake;
    const plain = typeof text === 'string' ? text : new TextDecoder().decode(text);
    if (plain.replace(/\0$/, '') !== expected.brdfbake) faults.push('metadata');
    const names = JSON.parse(expected.brdfbake).channels.map((c) => c.id);
    const level = file.levels[0];
    const data = file.supercompressionScheme === 2 ? decompress(level.levelData) : level.levelData;
    if (data.byteLength !== level.uncompressedByteLength) faults.push('length of the level');
    // packed words are cut to the channels; other texels may have components beyond them
    const components = ['rgb10a2', 'rgb9e5', 'rgbd'].includes(expected.storage) ? names.length : (expected.components ?? names.length);
    const got = texels(data, expected.storage, components);
    if (got === undefined) {
        console.log(`SKIPPED: the texels of ${name}; its header is read`);
        failed += faults.length > 0;
        if (faults.length) console.log(`FAIL ${name}: ${faults.join('; ')}`);
        continue;
    }
    if (got.length !== components * expected.channels[names[0]].length) faults.push(`${got.length} values`);
    for (let c = names.length; c < components; c++) {
        if (got.some((v, i) => i % components === c && v !== expected.fill[c - names.length])) faults.push(`component ${c}`);
    }
    const bits = new DataView(new ArrayBuffer(8));
    names.forEach((channel, c) => {
        expected.channels[channel].forEach((word, i) => {
            bits.setBigUint64(0, BigInt(`0x${word}`));
            const want = bits.getFloat64(0);
            const g = got[i * components + c];
            const close = expected.storage === 'rgbd' && Math.abs(g - want) <= 1e-14 * want;
            if (!Object.is(g, want) && !close) faults.push(`${channel}[${i}]: ${g} for ${want}`);
        });
    });
    failed += faults.length > 0;
    console.log(faults.length ? `FAIL ${name}: ${faults.slice(0, 3).join('; ')}` : `ok   ${name}`);
}
console.log(`${files.length} files, ${failed} different`);
process.exit(files.length === 0 ? 2 : failed ? 1 : 0);
