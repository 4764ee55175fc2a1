// Expected energies and how far the measured ones are from them.

/** The value of a half float. */
function half(bits) {
    const [s, e, m] = [bits >> 15, (bits >> 10) & 31, bits & 1023];
    const v = e ? (1 + m / 1024) * 2 ** (e - 15) : m * 2 ** -24;
    return s ? -v : v;
}

/** A table as the page read it: its codes, and a bilinear reader at (roughness, cosine). */
export function halves({ width, height, data }) {
    const at = (x, y, c) => half(data[2 * (y * width + x) + c]);
    const mix = (a, b, t) => a + (b - a) * t;
    const near = (v, n) => {
        const x = Math.min(Math.max(v * n - 0.5, 0), n - 1);
        const i = Math.min(Math.floor(x), n - 2);
        return [i, x - i];
    };
    const read = (roughness, mu) => {
        const [[x, u], [y, v]] = [near(roughness, width), near(mu, height)];
        return [0, 1].map((c) => mix(mix(at(x, y, c), at(x + 1, y, c), u), mix(at(x, y + 1, c), at(x + 1, y + 1, c), u), v));
    };
    return { codes: data, read };
}

/** Accurate scale and bias at (index of the roughness, cosine), by a parabola in the square root of the cosine. */
export function expectation(csv) {
    const [header, ...lines] = csv.trim().split('\n').map((line) => line.split(','));
    const [scale, bias] = ['dfg.scale', 'dfg.bias'].map((name) => header.indexOf(name));
    if (scale < 0 || bias < 0) throw new Error(`expected.csv: columns ${header}`);
    const texels = lines.map((line) => [Number(line[scale]), Number(line[bias])]);
    const n = texels.length / 11;
    return (row, mu) => {
        const x = Math.sqrt(mu) * (n - 1);
        const i = Math.min(Math.max(Math.round(x), 1), n - 2);
        const t = x - i;
        return [0, 1].map((c) => {
            const [a, b, d] = [-1, 0, 1].map((k) => texels[row * n + i + k][c]);
            return b + (t * (d - a)) / 2 + ((t * t) / 2) * (a - 2 * b + d);
        });
    };
}

/** What three's shader makes of scale and bias in a white environment: single scattering and the multiple scattering of Fdez-Aguera. */
export function environment([scale, bias], f0) {
    const single = f0 * scale + bias;
    const missing = 1 - (scale + bias);
    const average = f0 + (1 - f0) / 21;
    return single + ((single * average) / (1 - missing * average)) * missing;
}

const round = (v) => Number(v.toFixed(5));
const mean = (values) => values.reduce((a, b) => a + b, 0) / values.length;
/** Largest error of the lights themselves, relative to the albedo, for a row to count. */
const LIGHTS = 1e-3;
const COSINES = [0.1, 0.25, 0.5, 0.75, 1];

/** The pixels of a sphere: cosine and radiance. */
function sphere(spheres, i, f, radius) {
    const found = [];
    for (let y = 0; y < spheres.height; y++) {
        for (let x = 2 * radius * i; x < 2 * radius * (i + 1); x++) {
            const at = y * spheres.width + x;
            if (spheres.cosine[at] > 0) found.push([spheres.cosine[at], spheres.radiance[f][at]]);
        }
    }
    return found;
}

/** Mean of measured values near a cosine, of one or the other table. */
function near(points, mu, value) {
    const width = 0.02;
    const some = points.filter(([c]) => Math.abs(c - mu) <= width);
    return some.length ? round(mean(some.map(value))) : null;
}

function spheresRow({ shipped, baked, expected, radius }, i, f, f0) {
    const seen = { shipped: sphere(shipped.spheres, i, f, radius), baked: sphere(baked.spheres, i, f, radius) };
    const want = seen.shipped.map(([mu]) => environment(expected(i, mu), f0));
    const row = { expected: round(mean(want)) };
    for (const [name, points] of Object.entries(seen)) {
        const off = points.map(([, v], k) => Math.abs(v - want[k]));
        row[name] = { energy: round(mean(points.map(([, v]) => v))), mean: mean(off), largest: Math.max(...off) };
        row[name].at = COSINES.map((mu) => near(points, mu, ([, v]) => v));
    }
    row.at = COSINES.map((mu) => near(seen.shipped.map(([c], k) => [c, want[k]]), mu, ([, v]) => v));
    return row;
}

function directRow({ shipped, baked, expected, direct, roughness }, y) {
    const i = roughness.indexOf(direct.roughness[y]);
    const mu = (x) => (x + 0.5) / direct.cosines;
    const row = { roughness: direct.roughness[y], expected: 1 };
    let lights = 0;
    for (const [name, of] of [['shipped', shipped], ['baked', baked]]) {
        const values = of.direct[y];
        const off = values.map((v) => Math.abs(v - 1));
        // a sphere shows each cosine in proportion to it
        const weight = values.map((_, x) => mu(x));
        const seen = (list) => list.reduce((s, v, x) => s + v * weight[x], 0) / weight.reduce((a, b) => a + b);
        row[name] = { energy: round(seen(values)), mean: seen(off), largest: Math.max(...off) };
        // compensated energy times the albedo that the table holds is the albedo that the lights make
        values.forEach((v, x) => {
            const [a, b] = of.table.read(direct.roughness[y], mu(x));
            const [s, t] = expected(i, mu(x));
            lights = Math.max(lights, Math.abs((v * (a + b)) / (s + t) - 1));
        });
    }
    return { ...row, lights };
}

function total(what, rows) {
    const of = (name) => ({ mean: mean(rows.map((r) => r[name].mean)), largest: Math.max(...rows.map((r) => r[name].largest)) });
    return { what, shipped: of('shipped'), baked: of('baked') };
}

/** All that is told: a row a sphere and reflectance, a row a roughness of direct light, and the means. */
export function compare(all) {
    const environments = all.f0.map((f0, f) => ({ f0, rows: all.roughness.map((roughness, i) => ({ roughness, ...spheresRow(all, i, f, f0) })) }));
    const direct = all.direct.roughness.map((_, y) => directRow(all, y));
    const summary = environments.filter(({ f0 }) => f0 !== 1).map(({ f0, rows }) => total(`metal of F0 = ${f0}, environment`, rows));
    // where the lights are no sphere, they are what is measured
    direct.forEach((row) => (row.counted = row.lights <= LIGHTS));
    summary.push(total('white metal, directional lights', direct.filter((row) => row.counted)));
    const whites = environments.find(({ f0 }) => f0 === 1).rows;
    const white = { largest: Math.max(...whites.flatMap((r) => [r.shipped.largest, r.baked.largest])) };
    return { cosines: COSINES, summary, white, environments, direct };
}
