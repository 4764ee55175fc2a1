// Programs that use three.js as npm has it, bundled as users do, with the plugin of out-examples/14-three-bundles: what they upload must
// be the baked tables, and without the plugin the shipped ones.
//
//     NODE_PACKAGES=tests/three node tests/three/bundles.mjs --brdfbake target/release/brdfbake -o DIR [--tables DIR]
//
// Vite, Rollup, esbuild and webpack bundle a program for WebGL (with an area light), esbuild one for `three/webgpu` too; a browser runs
// them, and what reaches the graphics card is compared with the texels of the baked files. Builds that replace nothing or too much must
// fail. Writes bundles.json, and DFGLUTData.js for those who have no baker; with no -o, the latter is compared with that of the example.
// Exit code: 0 all as it must be, 1 not, 77 skipped.

import { execFileSync } from 'node:child_process';
import { copyFileSync, cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { packageFolder, withBrowser } from './browser.mjs';

const { values: args } = parseArgs({ options: { brdfbake: { type: 'string' }, tables: { type: 'string' }, out: { type: 'string', short: 'o' } } });
const here = dirname(fileURLToPath(import.meta.url));
const example = join(here, '../../out-examples/14-three-bundles');
const work = mkdtempSync(join(tmpdir(), 'brdfbake-bundles-'));
const tables = resolve(args.tables ?? join(work, 'tables'));
const faults = [];

/** Imports an npm package from where the packages are, as `import` finds it. */
function load(name) {
    const folder = packageFolder(name);
    const { exports, main } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
    let entry = exports?.['.'] ?? exports ?? main;
    while (typeof entry === 'object') entry = entry.import ?? entry.default;
    return import(pathToFileURL(join(folder, entry)));
}

const SCENE = `
const scene = new Scene();
const light = new RectAreaLight(0xffffff, 1, 1, 1);
light.position.z = 2;
scene.add(light, new Mesh(new SphereGeometry(), new MeshStandardMaterial({ metalness: 1, roughness: 0.5 })));
const camera = new OrthographicCamera(-1, 1, 1, -1, 0, 10);
camera.position.z = 5;
`;
const CLASSES = 'Mesh, MeshStandardMaterial, OrthographicCamera, RectAreaLight, Scene, SphereGeometry';
const PROGRAMS = {
    'webgl.js': `import { ${CLASSES}, WebGLRenderer } from 'three';
import { RectAreaLightUniformsLib } from 'three/addons/lights/RectAreaLightUniformsLib.js';
${SCENE}
RectAreaLightUniformsLib.init();
const renderer = new WebGLRenderer();
renderer.render(scene, camera);
window.ready = true;
`,
    'webgpu.js': `import { ${CLASSES}, RectAreaLightNode, WebGPURenderer } from 'three/webgpu';
import { RectAreaLightTexturesLib } from 'three/addons/lights/RectAreaLightTexturesLib.js';
${SCENE}
RectAreaLightNode.setLTC(RectAreaLightTexturesLib.init());
// on WebGL 2: the software WebGPU of a headless browser is lost now and then
const renderer = new WebGPURenderer({ forceWebGL: true });
await renderer.init();
renderer.render(scene, camera);
window.ready = true;
`,
    'none.js': 'window.ready = true;\n',
    'twice.js': "import { WebGLRenderer } from 'three';\nimport * as old from './copy/three/build/three.module.js';\nwindow.ready = [WebGLRenderer, old.WebGLRenderer];\n",
};

/** One function a bundler: bundles `program` into the folder `to`, with or without the plugin. */
const bundlers = {
    async vite(program, to, plugin) {
        const { build } = await load('vite');
        const lib = { entry: program, formats: ['es'], fileName: () => 'bundle.js' };
        await build({ root: work, configFile: false, logLevel: 'silent', plugins: [plugin?.rollup], build: { lib, outDir: to, target: 'esnext' } });
    },
    async rollup(program, to, plugin) {
        const { rollup } = await load('rollup');
        const { nodeResolve } = await load('@rollup/plugin-node-resolve');
        const bundle = await rollup({ input: join(work, program), plugins: [nodeResolve({ browser: true }), plugin?.rollup], onLog: () => {} });
        await bundle.write({ file: join(to, 'bundle.js') });
        await bundle.close();
    },
    async esbuild(program, to, plugin) {
        const { build } = await load('esbuild');
        const options = { bundle: true, format: 'esm', minify: true, logLevel: 'silent', absWorkingDir: work };
        await build({ ...options, entryPoints: [program], outfile: join(to, 'bundle.js'), plugins: plugin ? [plugin.esbuild] : [] });
    },
    async webpack(program, to, plugin) {
        const { default: webpack } = await load('webpack');
        const options = { mode: 'production', context: work, entry: `./${program}`, output: { path: to, filename: 'bundle.js' } };
        // all of it but the minimiser, which takes ten seconds and sees the modules after the plugin
        const compiler = webpack({ ...options, optimization: { minimize: false }, performance: false, plugins: plugin ? [plugin.webpack] : [] });
        const stats = await new Promise((done, failed) => compiler.run((error, all) => (error ? failed(error) : done(all))));
        await new Promise((done) => compiler.close(done));
        if (stats.hasErrors()) throw new Error(stats.toString('errors-only'));
    },
};

const numbers = (text) => text.match(/-?\b(?:0x[0-9a-f]+|\d[\d.]*(?:e[-+]?\d+)?)/gi).map(Number);
/** The lists of texels of a module: all between brackets that is longer than a few numbers. */
const lists = (file) => [...readFileSync(file, 'utf8').matchAll(/\[([^[\]]{1000,})\]/g)].map((m) => numbers(m[1]));

const want = (true_, what) => true_ || faults.push(what);

async function refused(what, message, bundle) {
    const said = await bundle().then(() => 'nothing', (e) => `${e.message} ${e.errors?.map((x) => x.text ?? x.message).join(' ') ?? ''}`);
    want(said.includes('brdfbake-three: ') && said.includes(message), `${what}: expected a failure that says "${message}", got ${said}`);
}

/** Vite's server sends the modules of packages apart, changed like those of a build. */
async function served(plugin) {
    const { createServer } = await load('vite');
    const server = await createServer({ root: work, configFile: false, logLevel: 'silent', plugins: [plugin], server: { middlewareMode: true, ws: false, watch: null } });
    try {
        const program = await server.transformRequest('/webgl.js');
        const [, url] = program.code.match(/from "([^"]*three\.module[^"]*)"/) ?? [];
        const module = url && (await server.transformRequest(url));
        const texels = lists(join(tables, 'DFGLUTData.js'))[0];
        want(module && numbers(module.code.match(/Uint16Array\(\s*\[([^\]]{1000,})\]/)[1]).every((n, i) => n === texels[i]), `Vite's server sends another table: ${url}`);
    } finally {
        await server.close();
    }
}

async function run(open, browser) {
    const three = packageFolder('three');
    const { rollup, esbuild, webpack } = await import(pathToFileURL(join(example, 'brdfbake-three.js')));
    const options = { dfg: join(tables, 'DFGLUTData.js'), area: join(tables, 'RectAreaLightTexturesLib.js') };
    const plugin = (o) => ({ rollup: rollup(o), esbuild: esbuild(o), webpack: webpack(o) });
    const baked = { dfg: lists(options.dfg)[0], area: lists(options.area) };
    const shipped = { dfg: lists(join(three, 'src/renderers/shaders/DFGLUTData.js'))[0] };
    want(baked.dfg.length === 512 && baked.area.length === 2 && baked.dfg.some((n, i) => n !== shipped.dfg[i]), 'the baked tables have no texels of their own');
    const result = [];
    for (const [bundler, program, on] of [
        ['esbuild', 'webgl.js', false],
        ...Object.keys(bundlers).map((b) => [b, 'webgl.js', true]),
        ['esbuild', 'webgpu.js', true],
        ['vite', 'webgpu.js', true],
    ]) {
        const name = `${bundler}-${program.replace('.js', '')}-${on ? 'baked' : 'shipped'}`;
        const start = Date.now();
        await bundlers[bundler](program, join(work, name), on ? plugin(options) : undefined);
        copyFileSync(join(here, 'bundles.html'), join(work, name, 'bundles.html'));
        const bytes = readFileSync(join(work, name, 'bundle.js')).length;
        const page = await open(`/${name}/bundles.html`);
        const dfg = await page.evaluate(() => window.read(512));
        const area = await page.evaluate(() => window.read(16384));
        await page.close();
        const same = (read, texels) => read.length === 1 && read[0].data.every((n, i) => n === texels[i]);
        want(same(dfg, (on ? baked : shipped).dfg), `${name}: ${dfg.length} tables of 512 halves were uploaded, or another one`);
        const floats = area.filter((t) => t.kind === 'Float32Array');
        const lit = baked.area.every((texels) => floats.some(({ data }) => data.every((n, i) => n === Math.fround(texels[i]))));
        want(floats.length === 2 && lit === on, `${name}: ${floats.length} tables of area lights were uploaded, ${lit ? '' : 'not '}the baked ones`);
        result.push({ bundler, program, plugin: on, texelsUploaded: on ? 'baked' : 'shipped' });
        console.log(`${name}: ${bytes} bytes, ${Date.now() - start} ms`);
    }
    await served(rollup(options));
    const only = { dfg: options.dfg };
    for (const bundler of Object.keys(bundlers)) {
        await refused(`${bundler}, no three.js`, 'no DFG table was replaced', () => bundlers[bundler]('none.js', join(work, 'fails'), plugin(only)));
    }
    cpSync(join(three, 'build'), join(work, 'copy/three/build'), { recursive: true });
    for (const bundler of ['esbuild', 'webpack']) {
        await refused(`${bundler}, two copies`, 'in two copies of three.js', () => bundlers[bundler]('twice.js', join(work, 'fails'), plugin(only)));
    }
    return { browser, three: JSON.parse(readFileSync(join(three, 'package.json'), 'utf8')).version, result };
}

let code = 1;
try {
    if (!args.tables) execFileSync(resolve(args.brdfbake ?? 'target/release/brdfbake'), ['bake', '--engine', 'three', '-o', tables, '--quiet'], { stdio: 'inherit' });
    symlinkSync(resolve(process.env.NODE_PACKAGES ?? '.', 'node_modules'), join(work, 'node_modules'), 'dir');
    for (const [name, text] of Object.entries(PROGRAMS)) writeFileSync(join(work, name), text);
    const find = (path) => (path.includes('..') ? undefined : join(work, path));
    const { browser, three, result } = await withBrowser(find, async (open, version, said) => {
        const all = await run(open, version);
        faults.push(...said);
        return all;
    });
    const out = args.out && resolve(args.out);
    if (out) {
        mkdirSync(out, { recursive: true });
        writeFileSync(join(out, 'bundles.json'), `${JSON.stringify({ three, result }, null, 1)}\n`);
        copyFileSync(join(tables, 'DFGLUTData.js'), join(out, 'DFGLUTData.js'));
    } else {
        const kept = join(example, 'DFGLUTData.js');
        const fresh = readFileSync(join(tables, 'DFGLUTData.js'), 'utf8');
        want(existsSync(kept) && readFileSync(kept, 'utf8') === fresh, `${kept} is stale: run the command of its command.txt`);
    }
    console.log(`${browser}, three ${three}`);
    faults.forEach((f) => console.error(`FAIL ${f}`));
    code = faults.length === 0 ? 0 : 1;
} finally {
    rmSync(work, { recursive: true, force: true });
}
process.exit(code);
