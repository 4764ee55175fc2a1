// A headless Chromium with a page from a loopback server, for the scripts of this folder.
//
// The npm packages are looked for where the script is called (or in the folder that NODE_PACKAGES names), not where it lies.
// The browser is that of CHROMIUM, or chromium or google-chrome on the path.

import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { extname, join, resolve } from 'node:path';

/** What is missing, for a visible skip; the scripts leave with this code then. */
export const SKIPPED = 77;

const FLAGS = [
    '--headless=new',
    '--no-sandbox',
    '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
    '--enable-unsafe-webgpu',
    '--use-webgpu-adapter=swiftshader',
    '--disable-quic',
    '--no-first-run',
    '--disable-background-networking',
    '--disable-component-update',
    '--disable-sync',
];

const packages = resolve(process.env.NODE_PACKAGES ?? '.');
const require = createRequire(join(packages, 'package.json'));

function missing(what) {
    console.log(`SKIPPED: ${what}`);
    process.exit(SKIPPED);
}

function chromium() {
    const names = process.env.CHROMIUM ? [process.env.CHROMIUM] : ['chromium', 'chromium-browser', 'google-chrome'];
    for (const name of names) {
        const found = spawnSync('which', [name], { encoding: 'utf8' });
        if (found.status === 0) return found.stdout.trim();
    }
    return missing('no chromium here (Debian: apt-get install chromium)');
}

/** The folder of an npm package. */
export function packageFolder(name) {
    const folder = join(packages, 'node_modules', name);
    return existsSync(folder) ? folder : missing(`npm package ${name} is not installed (npm install in tests/three)`);
}

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.png': 'image/png', '.json': 'application/json' };

/** Answers GET by `find(path)`, which gives the file for a path, or nothing. */
function serve(find) {
    const server = createServer((request, response) => {
        const path = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
        const file = find(path);
        if (!file || !statSync(file, { throwIfNoEntry: false })?.isFile()) {
            response.writeHead(404).end();
            return;
        }
        response.writeHead(200, { 'content-type': TYPES[extname(file)] ?? 'application/octet-stream' });
        response.end(readFileSync(file));
    });
    return new Promise((done) => server.listen(0, '127.0.0.1', () => done(server)));
}

/** Calls `use(open, version, faults)`; `open(path)` is a page that is ready. What `strict` pages say on the console is a fault, whatever it is. */
export async function withBrowser(find, use) {
    const { chromium: driver } = require(packageFolder('playwright-core'));
    const executablePath = chromium();
    const profile = mkdtempSync(join(tmpdir(), 'brdfbake-browser-'));
    const server = await serve(find);
    const context = await driver.launchPersistentContext(profile, { executablePath, args: FLAGS, headless: true, ignoreDefaultArgs: ['--headless'] });
    const faults = [];
    try {
        const open = async (path, ready = 'window.ready === true', strict = false) => {
            const page = await context.newPage();
            page.setDefaultTimeout(120_000);
            page.on('pageerror', (e) => faults.push(`${path}: ${e.message}`));
            page.on('console', (m) => (strict || m.type() === 'error') && faults.push(`${path}: ${m.text()} ${m.location().url}`));
            await page.goto(`http://127.0.0.1:${server.address().port}${path}`);
            await page.waitForFunction(ready).catch((e) => {
                throw new Error(`${e.message}; ${faults.join('; ')}`);
            });
            return page;
        };
        return await use(open, context.browser()?.version() ?? '', faults);
    } finally {
        await context.close();
        server.close();
        rmSync(profile, { recursive: true, force: true });
    }
}
