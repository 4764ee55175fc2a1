// Reads the OpenEXR files of tests/foreign.rs whose channels are named by position, with three.js' EXRLoader as users call it.
//
//     npm install --no-save three
//     BRDFBAKE_FOREIGN=foreign-out cargo test --test files -- --ignored write_
//     node tests/foreign/read_exr.mjs foreign-out
//
// Exit code: 0 all agree, 1 a difference, 2 nothing to compare.

import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

// the package is looked for where the script is called, not where it lies; the loader imports the same module
const of = (path) => import(pathToFileURL(join(process.cwd(), 'node_modules', 'three', path)));
const { EXRLoader } = await of('examples/jsm/loaders/EXRLoader.js');
const { DataUtils, FloatType, HalfFloatType, RedFormat, RGBAFormat } = await of('build/three.module.js');

const folder = process.argv[2];
const files = readdirSync(folder).filter((f) => /\.(positional|y)\.exr$/.test(f));
const bits = new DataView(new ArrayBuffer(8));
let failed = 0;

for (const name of files) {
    const expected = JSON.parse(readFileSync(join(folder, `${name}.expected.json`), 'utf8'));
    const bytes = readFileSync(join(folder, name));
    const half = expected.storage === 'half';
    const loader = new EXRLoader().setDataType(half ? HalfFloatType : FloatType);
    const faults = [];
    try {
        const { data, width, height, format } = loader.parse(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength));
        if (width !== expected.width || height !== expected.height) faults.push(`${width} x ${height}`);
        const names = format === RedFormat ? ['Y'] : ['R', 'G', 'B', 'A'];
        if (format !== RedFormat && format !== RGBAFormat) faults.push(`format ${format}`);
        for (const [channel, column] of Object.entries(expected.channels)) {
            // the loader puts luminance into red where it makes four components
            const c = channel === 'Y' ? 0 : names.indexOf(channel);
            if (c < 0) faults.push(`no channel ${channel}`);
            column.forEach((word, i) => {
                bits.setBigUint64(0, BigInt(`0x${word}`));
                const want = bits.getFloat64(0);
                // the loader turns rows over, as WebGL wants them
                const row = height - 1 - Math.floor(i / width);
                const stored = data[(row * width + (i % width)) * names.length + c];
                const got = half ? DataUtils.fromHalfFloat(stored) : stored;
                if (got !== want) faults.push(`${channel}[${i}]: ${got} for ${want}`);
            });
        }
    } catch (e) {
        faults.push(String(e.message ?? e));
    }
    failed += faults.length > 0;
    console.log(faults.length ? `FAIL ${name}: ${faults.slice(0, 3).join('; ')}` : `ok   ${name}`);
}
console.log(`${files.length} files by EXRLoader, ${failed} different`);
process.exit(files.length === 0 ? 2 : failed ? 1 : 0);
