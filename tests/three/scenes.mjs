// Scenes before and after brdfbake wrote its tables into them, as three.js shows them: the same messages of the loader, the same view.
//
//     NODE_PACKAGES=tests/three node tests/three/scenes.mjs OLD NEW [OLD NEW ...]
//
// Exit code: 0 all agree, 1 a difference, 77 skipped.

import { basename, dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { packageFolder, withBrowser } from './browser.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const three = packageFolder('three');
const pairs = [];
for (let i = 2; i + 1 < process.argv.length; i += 2) pairs.push([resolve(process.argv[i]), resolve(process.argv[i + 1])]);
const folders = pairs.flat().map((path) => dirname(path));
const find = (path) => {
    if (path.startsWith('/three/')) return join(three, path.slice(7));
    const [, number, rest] = path.match(/^\/scene(\d+)\/(.*)$/) ?? [];
    return rest === undefined ? join(here, path) : join(folders[number], rest);
};

/** Root of the mean square of the differences of codes, in units of the largest code. */
function distance(a, b) {
    const sum = a.reduce((all, value, i) => all + (value - b[i]) ** 2, 0);
    return Math.sqrt(sum / a.length) / 255;
}

async function run(open, version) {
    let [failed, empty, tables] = [0, 0, 0];
    for (const [i, [old, written]] of pairs.entries()) {
        const page = await open('/scene.html');
        const look = (k, path) => page.evaluate((url) => window.view(url), `/scene${2 * i + k}/${encodeURIComponent(basename(path))}`);
        const [before, after] = [await look(0, old), await look(1, written)];
        await page.close();
        const rmse = distance(before.pixels, after.pixels);
        const said = (view) => view.said.join('; ').replaceAll(/scene\d+/g, 'scene');
        const seen = new Set(before.pixels).size > 8;
        empty += !seen;
        const fine = rmse < 1 / 255 && said(before) === said(after);
        tables += after.tables;
        failed += !fine;
        const words = after.said.length ? `, messages before and after: ${said(before)} | ${said(after)}` : '';
        console.log(`${fine ? 'ok  ' : 'FAIL'} ${basename(written)}: RMSE ${rmse.toExponential(1)}, ${after.tables} tables${seen ? '' : ' (a view of one colour)'}${words}`);
    }
    console.log(`${version}: ${pairs.length} scenes, ${failed} different`);
    // views that show nothing would be equal too
    return failed === 0 && tables > 0 && empty < pairs.length ? 0 : 1;
}

process.exit(await withBrowser(find, run));
