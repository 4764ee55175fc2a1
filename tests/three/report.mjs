// Reports in a headless browser: nothing on the console, every picture there, no violation of axe-core, texels that the arrow keys reach;
// and the Nu HTML checker where there is a java.
//
//     NODE_PACKAGES=... node tests/three/report.mjs FOLDER... [--shots DIR]
//
// Exit code: 0 sound, 1 not, 77 skipped.

import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readdirSync, readFileSync } from 'node:fs';
import { basename, join, resolve } from 'node:path';
import { packageFolder, withBrowser } from './browser.mjs';

const words = process.argv.slice(2);
const at = words.indexOf('--shots');
const shots = at < 0 ? undefined : words.splice(at, 2)[1];
const folders = words.map((f) => resolve(f));
// of the pages of an index the first: all are made alike
const pages = folders.flatMap((folder, n) => readdirSync(folder).filter((f) => /^report(-1)?\.html$/.test(f)).map((f) => ({ n, file: join(folder, f), path: `/${n}/${f}` })));
if (pages.length === 0) throw new Error('no report in these folders');
const axe = readFileSync(join(packageFolder('axe-core'), 'axe.min.js'), 'utf8');

const find = (path) => {
    const [, n, file] = path.match(/^\/(\d+)\/([\w.-]+)$/) ?? [];
    return file === undefined ? undefined : join(folders[n], file);
};

/** What is wrong with a page as it stands. */
async function faults(page) {
    return page.evaluate(async () => {
        const found = [];
        for (const image of document.images) {
            await image.decode().catch(() => found.push(`no picture: ${image.alt}`));
            if (!image.alt) found.push(`a picture without text: ${image.src.slice(0, 60)}`);
        }
        if (document.documentElement.scrollWidth > innerWidth) found.push(`wider than the window: ${document.documentElement.scrollWidth} > ${innerWidth}`);
        const { violations } = await window.axe.run(document, { resultTypes: ['violations'] });
        for (const v of violations) found.push(`axe ${v.id}: ${v.help}: ${v.nodes.slice(0, 3).map((n) => n.html).join(' ')}`);
        return found;
    });
}

/** Every table names the texel under a cursor, and the worst texels lead to theirs. */
async function hover(page) {
    const found = [];
    for (const map of await page.$$('.map')) {
        await map.focus();
        await page.keyboard.press('ArrowRight');
        const text = await map.evaluate((m) => m.closest('.maps').querySelector('.read').textContent);
        if (!/^Texel \d+, \d+: .* = /.test(text)) found.push(`the cursor says: ${text}`);
    }
    for (const button of (await page.$$('button[data-at]')).slice(0, 2)) {
        await button.click();
        const told = await button.evaluate((b) => {
            const row = [...b.closest('tr').children].map((c) => c.textContent);
            return { text: b.closest('.table').querySelector('.read').textContent, channel: row[0], cross: b.closest('.table').querySelectorAll('.cross').length };
        });
        if (!told.text.includes(told.channel) || told.cross === 0) found.push(`a worst texel leads nowhere: ${told.text}`);
    }
    return found;
}

const wrong = await withBrowser(find, async (open, version, console_) => {
    const found = [];
    for (const { path, n } of pages) {
        const page = await open(path, 'document.readyState === "complete"', true);
        await page.evaluate(axe);
        for (const [width, scheme] of [[1600, 'light'], [390, 'dark']]) {
            await page.setViewportSize({ width, height: 900 });
            await page.emulateMedia({ colorScheme: scheme });
            found.push(...(await faults(page)).map((f) => `${path} at ${width}: ${f}`));
            if (shots) {
                mkdirSync(shots, { recursive: true });
                await page.screenshot({ path: join(shots, `${basename(folders[n])}-${basename(path, '.html')}-${width}.png`), fullPage: true });
            }
        }
        found.push(...(await hover(page)).map((f) => `${path}: ${f}`));
        await page.close();
    }
    console.log(`${pages.length} pages in ${version}`);
    return [...found, ...console_];
});

const java = spawnSync('java', ['-version']).status === 0;
const jar = java ? join(packageFolder('vnu-jar'), 'build/dist/vnu.jar') : undefined;
if (jar && existsSync(jar)) {
    const { status, stderr } = spawnSync('java', ['-jar', jar, '--errors-only', '--format', 'text', ...pages.map((p) => p.file)], { encoding: 'utf8' });
    if (status !== 0) wrong.push(stderr);
} else {
    console.log('SKIPPED: no java or no vnu-jar here, the pages were not checked as HTML');
}
for (const fault of wrong) console.error(fault);
process.exit(wrong.length > 0 ? 1 : 0);
