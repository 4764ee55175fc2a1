// The result as a table and as a picture.

import { environment } from './energy.mjs';

const fixed = (v, n = 4) => v.toFixed(n);
const power = (v, n = 1) => v.toExponential(n);

/** Energies side by side, in Markdown. */
export function markdown({ summary, white, environments, direct, three }) {
    const lines = [`three.js ${three}; mean energy of a sphere with the shipped and the baked table, and mean error over its pixels.`, ''];
    for (const { f0, rows } of environments.filter((e) => e.f0 !== 1)) {
        lines.push(`Metal of F0 = ${f0} in a white environment:`, '');
        lines.push('| roughness | expected | shipped | baked | error shipped | error baked |', '|---|---|---|---|---|---|');
        for (const r of rows) {
            const cells = [r.roughness, fixed(r.expected), fixed(r.shipped.energy), fixed(r.baked.energy), power(r.shipped.mean), power(r.baked.mean)];
            lines.push(`| ${cells.join(' | ')} |`);
        }
        lines.push('');
    }
    lines.push('White metal under directional lights that are a white sphere together (furnace: 1); a row counts if the lights are off by less than 1e-3:', '');
    lines.push('| roughness | shipped | baked | error shipped | error baked | error of the lights |', '|---|---|---|---|---|---|');
    for (const r of direct) {
        const cells = [r.roughness, fixed(r.shipped.energy), fixed(r.baked.energy), power(r.shipped.mean), power(r.baked.mean), power(r.lights)];
        lines.push(`| ${cells.join(' | ')} |`);
    }
    lines.push('', '| all of them | shipped: mean, largest | baked: mean, largest |', '|---|---|---|');
    for (const { what, shipped: s, baked: b } of summary) {
        lines.push(`| ${what} | ${power(s.mean, 3)}, ${power(s.largest)} | ${power(b.mean, 3)}, ${power(b.largest)} |`);
    }
    lines.push('', `White metal in a white environment is within ${power(white.largest)} of 1 with either: the compensation cancels the table.`);
    return `${lines.join('\n')}\n`;
}

const srgb = (v) => 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);

/** White where nothing is off; red above, blue below, full at 0.02. */
function fault(off) {
    const t = Math.min(Math.abs(off) / 0.02, 1);
    return off > 0 ? [255, 255 * (1 - t), 255 * (1 - t)] : [255 * (1 - t), 255 * (1 - t), 255];
}

/** Spheres of F0 = 0.5 as rendered, and what is off, with the shipped and with the baked table. */
export function picture(page, { shipped, baked, expected, f0, radius, result }) {
    const f = f0.indexOf(0.5);
    const pixels = (of, colour) =>
        of.spheres.cosine.flatMap((mu, at) => {
            if (mu <= 0) return [255, 255, 255];
            const row = Math.floor((at % of.spheres.width) / (2 * radius));
            return colour(of.spheres.radiance[f][at], row, mu).map(Math.round);
        });
    const plain = (v) => [srgb(v), srgb(v), srgb(v)];
    const off = (v, row, mu) => fault(v - environment(expected(row, mu), 0.5));
    const told = result.environments[f].rows;
    const energy = (name) => told.map((r) => fixed(r[name].energy));
    const error = (name) => told.map((r) => power(r[name].mean));
    const rows = [
        { text: 'shipped table: metal of F0 = 0.5 in a white furnace, roughness 0 to 1, mean energy', rgb: pixels(shipped, plain), labels: energy('shipped') },
        { text: 'baked table', rgb: pixels(baked, plain), labels: energy('baked') },
        { text: 'shipped table: too bright (red), too dark (blue), full colour at 0.02; mean error', rgb: pixels(shipped, off), labels: error('shipped') },
        { text: 'baked table: the same', rgb: pixels(baked, off), labels: error('baked') },
    ];
    const { width, height } = shipped.spheres;
    return page.evaluate((o) => window.draw(o), { rows, width, height });
}
