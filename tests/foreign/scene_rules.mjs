// The official glTF validator on scenes before and after brdfbake wrote its tables into them: errors and warnings are those of the
// old scene; infos are too, but for one UNSUPPORTED_EXTENSION and one UNUSED_OBJECT for each buffer view that holds a table or map.
//
//     cd PACKAGES && node scene_rules.mjs OLD NEW [OLD NEW ...]      PACKAGES has the npm package gltf-validator
//
// Exit code: 0 all as it must be, 1 not.

import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';

const { validateBytes } = createRequire(join(process.cwd(), 'package.json'))('gltf-validator');

/** How often each message comes, by severity and code. */
async function messages(path) {
    const report = await validateBytes(new Uint8Array(readFileSync(path)), {
        uri: path,
        maxIssues: 0,
        externalResourceFunction: async (uri) => new Uint8Array(readFileSync(join(dirname(path), decodeURIComponent(uri)))),
    });
    const counts = {};
    for (const { severity, code } of report.issues.messages) counts[`${severity} ${code}`] = (counts[`${severity} ${code}`] ?? 0) + 1;
    return counts;
}

/** The JSON of a .gltf or .glb file. */
function scene(path) {
    const bytes = readFileSync(path);
    return JSON.parse(bytes.subarray(0, 4).toString() === 'glTF' ? bytes.subarray(20, 20 + bytes.readUInt32LE(12)).toString() : bytes.toString());
}

let failed = 0;
const paths = process.argv.slice(2).map((path) => resolve(path));
for (let i = 0; i + 1 < paths.length; i += 2) {
    const [wanted, got] = [await messages(paths[i]), await messages(paths[i + 1])];
    // a scene that needs no table has none
    const object = scene(paths[i + 1]).extensions?.BRDFBAKE_lookup_tables;
    const files = [...(object?.tables ?? []), ...(object?.maps ?? [])].flatMap((unit) => unit.files);
    const views = new Set(files.map((file) => file.bufferView).filter((view) => view !== undefined)).size;
    const add = (key, n) => n > 0 && (wanted[key] = (wanted[key] ?? 0) + n);
    add('2 UNSUPPORTED_EXTENSION', object ? 1 : 0);
    add('2 UNUSED_OBJECT', views);
    const text = (counts) => JSON.stringify(Object.entries(counts).sort());
    const fine = text(wanted) === text(got);
    failed += !fine;
    console.log(`${fine ? 'ok  ' : 'FAIL'} ${paths[i + 1]}: ${views} files inside${fine ? '' : `, ${text(got)}, expected ${text(wanted)}`}`);
}
console.log(`${paths.length / 2} scenes, ${failed} that the validator judges otherwise`);
process.exit(failed === 0 && paths.length > 1 ? 0 : 1);
