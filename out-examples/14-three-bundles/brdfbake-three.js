// A plugin for Vite, Rollup, esbuild and webpack: programs that use three.js as npm has it get the baked tables. The modules of its
// `build/` hold a copy of the DFG table each (three.module.js for WebGL, three.tsl.js for three.webgpu.js), and it is changed there.
// Lay this file beside those of `brdfbake bake --engine three`, `import * as brdfbake from './brdfbake-three.js'`, then:
//
//     vite.config.js, rollup.config.js    plugins: [brdfbake.rollup()]
//     options of esbuild                  plugins: [brdfbake.esbuild()]
//     webpack.config.js                   plugins: [brdfbake.webpack()]
//
// Options: { dfg: PATH of DFGLUTData.js (the one beside this file; false: leave the table), area: PATH of RectAreaLightTexturesLib.js }.
// A build fails where a table that was asked for was replaced nowhere, where a module holds none or two of them or one of another size,
// where two copies of three.js are bundled, and where a cache brought the shipped table back.

import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

const NAME = 'brdfbake-three';
const MODULE = /[\\/]three[\\/](build|src|examples)[\\/][^?]*\.js(\?.*)?$/;
const AREA = /[\\/]three[\\/]examples[\\/]jsm[\\/]lights[\\/]RectAreaLightTexturesLib\.js(\?.*)?$/;

function fail(what) {
    throw new Error(`${NAME}: ${what}`);
}
const texels = (list) => list.match(/\w+/g).length / 2;

/** Where the DFG table stands in a module: the last list of numbers before the one place that names its texture. */
function find(text, file) {
    const parts = text.split(/['"`]DFG_LUT['"`]/);
    const list = [...parts[0].matchAll(/new Uint16Array\(\s*\[([^\]]*)\]\s*\)/g)].at(-1);
    if (parts.length === 2 && list) return list;
    return fail(`${file}: ${parts.length - 1} textures are named DFG_LUT, and 1 with its texels before it was expected: another three.js?`);
}

/** The text of a module of three.js with the DFG table of the text of a baked file. */
export function replaceTable(text, baked, file = 'module') {
    const [from, to] = [find(text, file), find(baked, 'the baked file')];
    const [old, size] = [texels(from[1]), texels(to[1])];
    if (old !== size) fail(`${file}: its table has ${old} texels, the baked one ${size}: bake it with the axes of this three.js`);
    return text.slice(0, from.index) + to[0] + text.slice(from.index + from[0].length);
}

/** What the plugins share: `change(file, text)` is the new text or nothing, `end()` fails if that was too little or too much. */
function tables({ dfg, area } = {}) {
    const read = (path) => readFileSync(path, 'utf8');
    const baked = dfg === false ? undefined : read(dfg ?? fileURLToPath(new URL('DFGLUTData.js', import.meta.url)));
    const lights = area && read(area);
    const done = new Set();
    return {
        begin: () => done.clear(),
        change(file, text) {
            const light = AREA.test(file);
            if (light ? !lights : !(baked && MODULE.test(file) && /['"`]DFG_LUT['"`]/.test(text))) return undefined;
            done.add(file.split('?')[0]);
            return light ? lights : replaceTable(text, baked, file);
        },
        end() {
            const [files, names] = [[...done], [...done].map((f) => f.split(/[\\/]/).at(-1))];
            if (baked && files.every((f) => AREA.test(f))) fail('no DFG table was replaced: no module of three.js that holds one is bundled');
            if (lights && !files.some((f) => AREA.test(f))) fail('no table of area lights was replaced: none is bundled');
            const twice = files.filter((_, i) => names.indexOf(names[i]) !== names.lastIndexOf(names[i]));
            if (twice.length) fail(`replaced twice, in two copies of three.js: ${twice.join(', ')}`);
        },
    };
}

export function rollup(options) {
    const { begin, change, end } = tables(options);
    const transform = (text, file) => ((code) => code && { code, map: null })(change(file, text));
    // a bundle for a server, or a rebuild after a change, may well not load three.js (again)
    const asked = (context) => !context.meta?.watchMode && (context.environment?.name ?? 'client') === 'client';
    // Vite's server bundles packages beforehand, without plugins, but for those that are excluded
    const config = () => ({ optimizeDeps: { exclude: ['three', 'three/webgpu', 'three/tsl'] } });
    return { name: NAME, enforce: 'pre', config, buildStart: begin, transform, buildEnd(error) { error || !asked(this) || end(); } };
}

export function esbuild(options) {
    const { begin, change, end } = tables(options);
    const setup = (build) => {
        build.onStart(begin);
        build.onLoad({ filter: MODULE }, ({ path }) => ({ contents: change(path, readFileSync(path, 'utf8')) ?? readFileSync(path) }));
        build.onEnd(({ errors }) => void (errors.length > 0 || end()));
    };
    return { name: NAME, setup };
}

export function webpack(options) {
    const taps = (compilation, { NormalModule }) => {
        const { change, end } = tables(options);
        const swap = ([text, ...rest], { resource }) => [change(resource ?? '', String(text)) ?? text, ...rest];
        NormalModule.getCompilationHooks(compilation).processResult.tap(NAME, swap);
        compilation.hooks.finishModules.tap(NAME, (modules) => {
            for (const module of modules) {
                const [file, text] = [module.resource ?? '', String(module.originalSource()?.source() ?? '')];
                if ((change(file, text) ?? text) !== text) fail(`${file}: a cache brought the shipped table back: remove it`);
            }
            end();
        });
    };
    return { apply: (compiler) => compiler.hooks.thisCompilation.tap(NAME, (compilation) => taps(compilation, compiler.webpack)) };
}
