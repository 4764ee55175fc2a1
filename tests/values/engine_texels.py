"""Writes engine_texels.csv: for every table of every engine one texel by its position in the file, far from any symmetry.

Where a texel lies follows from what each engine's own source says (the comments below), not from the recipes in presets/engines.
Values are plain double quadrature of the textbook integrals: over directions for what is reflected and transmitted, over facet
normals for means over visible normals; Gauss-Legendre in every variable. Rows of sheens are texels of the table that Zeltner,
Burley and Chiang ship (Apache-2.0, five decimals). Run: python3 engine_texels.py > engine_texels.csv
"""
from math import acos, cos, exp, log, pi, sin, sqrt


def gauss(n, a, b):
    """Nodes and weights of Gauss-Legendre by Newton's method on Legendre's polynomial."""
    out = []
    for i in range(n):
        x = cos(pi * (i + 0.75) / (n + 0.5))
        for _ in range(50):
            p, q = 1.0, x
            for k in range(2, n + 1):
                p, q = q, ((2 * k - 1) * x * q - (k - 1) * p) / k
            d = n * (x * q - p) / (x * x - 1)
            step = q / d
            x -= step
            if abs(step) < 1e-15:
                break
        out.append((a + (b - a) * (x + 1) / 2, (b - a) / ((1 - x * x) * d * d)))
    return out


def direction(mu, phi):
    s = sqrt(max(0.0, 1 - mu * mu))
    return (s * cos(phi), s * sin(phi), mu)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def unit(v):
    n = sqrt(dot(v, v))
    return (v[0] / n, v[1] / n, v[2] / n)


def ggx_d(alpha, h):
    e = (h[0] * h[0] + h[1] * h[1]) / (alpha * alpha) + h[2] * h[2]
    return 1 / (pi * alpha * alpha * e * e)


def ggx_lambda(alpha, mu):
    t2 = (1 - mu * mu) / (mu * mu)
    return (sqrt(1 + alpha * alpha * t2) - 1) / 2


def correlated(alpha):
    return lambda mu_o, mu_i: 1 / (1 + ggx_lambda(alpha, mu_o) + ggx_lambda(alpha, mu_i))


def separable(alpha):
    g1 = lambda mu: 1 / (1 + ggx_lambda(alpha, mu))
    return lambda mu_o, mu_i: g1(mu_o) * g1(mu_i)


def schlick_ibl(alpha):
    """Karis 2013: each side mu / (mu (1 - k) + k), k = alpha / 2."""
    g1 = lambda mu: mu / (mu * (1 - alpha / 2) + alpha / 2)
    return lambda mu_o, mu_i: g1(mu_o) * g1(mu_i)


N = 160


def over_light(mu_o, f, n=N):
    """int f(wo, wi) mu_i dwi, f even in phi; mu = x^2 and a split of phi bring out what is narrow."""
    wo = direction(mu_o, 0.0)
    total = 0.0
    phis = gauss(n, 0, pi / 4) + gauss(n, pi / 4, pi)
    for x, wx in gauss(n, 0, 1):
        mu = x * x
        for phi, wp in phis:
            total += wx * 2 * x * wp * 2 * f(wo, direction(mu, pi - phi)) * mu
    return total


def split(mu_o, alpha, weights, masking=correlated):
    """int D G2 / (4 mu_o mu_i) weight(wo.wh) mu_i dwi, for each weight."""
    g = masking(alpha)

    def one(weight):
        def f(wo, wi):
            h = unit((wo[0] + wi[0], wo[1] + wi[1], wo[2] + wi[2]))
            return ggx_d(alpha, h) * g(wo[2], wi[2]) / (4 * wo[2] * wi[2]) * weight(dot(wo, h))
        return over_light(mu_o, f)

    return [one(w) for w in weights]


FC = lambda v: (1 - v) ** 5
SCALE = lambda v: 1 - (1 - v) ** 5
TOTAL = lambda v: 1.0
F82_X16 = lambda v: 16 * v * (1 - v) ** 6


def cloth(mu_o, alpha):
    """Charlie's D with r = alpha, V = 1 / (4 (mu_o + mu_i - mu_o mu_i)), no Fresnel factor: Filament."""
    def f(wo, wi):
        h = unit((wo[0] + wi[0], wo[1] + wi[1], wo[2] + wi[2]))
        s = sqrt(max(0.0, 1 - h[2] * h[2]))
        d = (2 + 1 / alpha) * s ** (1 / alpha) / (2 * pi)
        return d / (4 * (wo[2] + wi[2] - wo[2] * wi[2]))
    return over_light(mu_o, f)


def disney_diffuse(mu_o, r, bias, scale, factor):
    """(1 / pi) int (1 + (F90 - 1)(1 - mu_o)^5)(1 + (F90 - 1)(1 - mu_i)^5) mu_i dwi factor, F90 = bias + scale r v^2."""
    def f(wo, wi):
        h = unit((wo[0] + wi[0], wo[1] + wi[1], wo[2] + wi[2]))
        v = dot(wo, h)
        f90 = bias + scale * r * v * v
        return factor / pi * (1 + (f90 - 1) * (1 - wo[2]) ** 5) * (1 + (f90 - 1) * (1 - wi[2]) ** 5)
    return over_light(mu_o, f)


def dielectric(v, eta):
    """Unpolarised Fresnel reflectance for light from the side of index 1 onto index eta."""
    s2 = (1 - v * v) / (eta * eta)
    if s2 >= 1:
        return 1.0
    t = sqrt(1 - s2)
    a, b = (v - eta * t) / (v + eta * t), (eta * v - t) / (eta * v + t)
    return (a * a + b * b) / 2


def over_facets(mu_o, f, least, most, breaks, n):
    """int f(h, v) dwh over facet normals h with least(v) < h.z < most(v), v = wo.wh, in polar coordinates about wo: what
    depends on v alone has no edge inside, and the limits of the azimuth are known."""
    s_o = sqrt(1 - mu_o * mu_o)
    total = 0.0
    ends = [0.0] + [b for b in breaks if 0 < b < 1] + [1.0]
    for a, b in zip(ends, ends[1:]):
        # v = a + (b - a) u^2 (3 - 2 u): roots at either end are smoothed away
        for u, wu in gauss(n, 0, 1):
            v = a + (b - a) * u * u * (3 - 2 * u)
            s = sqrt(1 - v * v)
            jacobian = wu * (b - a) * 6 * u * (1 - u)
            cosine = lambda z: max(-1.0, min(1.0, (z - v * mu_o) / (s * s_o)))
            near, far = acos(cosine(most(v))), acos(cosine(least(v)))
            for phi, wp in gauss(n // 2, near, far):
                total += 2 * jacobian * wp * f(v * mu_o + s * s_o * cos(phi), v)
    return total


def meets(mu_o, edge):
    """The v in (0, 1) at which edge(v) begins or ceases to cut the circle of facets: its azimuth limit has a corner there."""
    s_o = sqrt(1 - mu_o * mu_o)
    side = lambda v: (edge(v) - v * mu_o) / (sqrt(1 - v * v) * s_o)
    found = []
    grid = [k / 4000 for k in range(1, 4000)]
    for target in (-1.0, 1.0):
        for a, b in zip(grid, grid[1:]):
            if (side(a) - target) * (side(b) - target) < 0:
                for _ in range(60):
                    m = (a + b) / 2
                    a, b = (a, m) if (side(a) - target) * (side(m) - target) <= 0 else (m, b)
                found.append(a)
    return found


def glass(mu_o, alpha, eta, n=100, masking=correlated):
    """R + T of a rough interface, Walter 2007, with the same G in both lobes, 1 / (1 + Lambda_o + Lambda_i) for one; T as radiant flux."""
    g = masking(alpha)

    def d(z):
        e = (1 - z * z) / (alpha * alpha) + z * z
        return 1 / (pi * alpha * alpha * e * e)

    inside = lambda v: 1 - (1 - v * v) / (eta * eta)
    critical = [sqrt(1 - eta * eta)] if eta < 1 else []
    reflected = lambda z, v: d(z) * g(mu_o, max(2 * v * z - mu_o, 1e-12)) * dielectric(v, eta) * v / mu_o
    lowest = lambda v: mu_o / (2 * v)
    one = lambda v: 1.0
    r = over_facets(mu_o, reflected, lowest, one, sorted(critical + meets(mu_o, lowest)), n)

    def transmitted(z, v):
        t2 = inside(v)
        if t2 <= 0:
            return 0.0
        mu_t = mu_o / eta - (v / eta - sqrt(t2)) * z
        return d(z) * g(mu_o, max(mu_t, 1e-12)) * (1 - dielectric(v, eta)) * v / mu_o

    def highest(v):
        # above, a ray that leaves a denser medium ends on the side it came from
        slope = v / eta - sqrt(max(0.0, inside(v)))
        return min(1.0, mu_o / eta / slope) if slope > 0 else 1.0

    zero = lambda v: 0.0
    breaks = sorted(critical + meets(mu_o, zero) + (meets(mu_o, highest) if eta < 1 else []))
    t = over_facets(mu_o, transmitted, zero, highest, breaks, n)
    return r + t


def average(e, n=24):
    """2 int mu E(mu) dmu, mu = x^2."""
    return sum(w * 2 * x * 2 * x * x * e(x * x) for x, w in gauss(n, 0, 1))


def visible(mu_o, alpha, s, n=400):
    """Mean of s(wo.wh) over visible normals, 0 where the reflection goes below the horizon: what Cycles averages."""
    wo = direction(mu_o, 0.0)
    g1 = 1 / (1 + ggx_lambda(alpha, mu_o))
    total = 0.0
    # facets whose reflection is above: 2 v h.z > mu_o; theta_h up to the edge, found by bisection
    for phi, wp in gauss(n, 0, pi):
        def above(theta):
            h = direction(cos(theta), phi)
            return 2 * dot(wo, h) * h[2] > mu_o
        lo, hi = 0.0, pi / 2
        # the set is an interval of theta that holds 0
        for _ in range(60):
            mid = (lo + hi) / 2
            lo, hi = (mid, hi) if above(mid) else (lo, mid)
        for theta, wt in gauss(40, 0, lo / 4) + gauss(40, lo / 4, lo):
            h = direction(cos(theta), phi)
            v = dot(wo, h)
            total += 2 * wp * wt * sin(theta) * ggx_d(alpha, h) * g1 * v / mu_o * s(v)
    return total


def sphere(z, sin2):
    """Irradiance of a sphere cut by the horizon, over that of the whole one facing the surface: cosine z to its centre,
    sin^2 of its angular radius."""
    radius = acos(sqrt(1 - sin2))
    centre = (sqrt(1 - z * z), 0.0, z)
    total = 0.0
    for t, wt in gauss(200, 0, radius):
        for phi, wp in gauss(200, 0, pi):
            # about the centre: frame (centre, y, centre x y)
            c, s = cos(t), sin(t)
            up = c * centre[2] + s * cos(phi) * centre[0]
            total += 2 * wt * wp * s * max(0.0, up)
    return total / (pi * sin2)


def row(engine, table, at, values, bound):
    x, y, z = (list(at) + [0, 0])[:3]
    for component, value in enumerate(values):
        print("%s,%s,%d,%d,%d,%d,%.10g,%g" % (engine, table, x, y, z, component, value, bound))


def centre(i, n):
    return (i + 0.5) / n


print("# By engine_texels.py in this folder: one texel of every table by its place in the file.")
print("engine,table,x,y,z,component,value,bound")

# DFG textures read at (mu, roughness), texel centres, row 0 smooth; scale and bias
for engine, table, n, x, y, masking in [
    ("bevy", "bevy-dfg", 64, 20, 46, correlated),
    ("unreal", "unreal-dfg", 128, 40, 90, schlick_ibl),
    ("simplepbr", "simplepbr-dfg", 128, 33, 84, schlick_ibl),
    ("gltf-sample-renderer", "gltf-ggx", 1024, 320, 740, correlated),
]:
    row(engine, table, (x, y), split(centre(x, n), centre(y, n) ** 2, [SCALE, FC], masking), 1e-6)
# three.js: x is roughness, y is mu
row("three", "three-dfg", (11, 4), split(centre(4, 16), centre(11, 16) ** 2, [SCALE, FC]), 1e-6)
# MaterialX: y is alpha, not roughness
row("materialx", "materialx-albedo", (40, 90), split(centre(40, 128), centre(90, 128), [SCALE, FC]), 1e-6)
# O3DE: row = size - 1 - y, row 0 rough
row("o3de", "o3de-dfg", (80, 70), split(centre(80, 256), centre(255 - 70, 256) ** 2, [SCALE, FC]), 1e-6)
# cmgen of Filament: roughness (y + 1.5) / 64, capped at 1; Fc, total, cloth
for engine, offset in [("filament", 1.5), ("filament-centre", 0.5)]:
    mu, r = centre(20, 64), (46 + offset) / 64
    row(engine, "filament-dfg", (20, 46), split(mu, r * r, [FC, TOTAL]) + [cloth(mu, r * r)], 1e-6)
mu, r = centre(80, 256), (180 + 1.5) / 256
row("babylon", "babylon-environment-brdf", (80, 180), split(mu, r * r, [FC, TOTAL]) + [cloth(mu, r * r)], 1e-6)
mu, r = centre(20, 128), centre(90, 128)
row("babylon", "babylon-openpbr-brdf", (20, 90), split(mu, r * r, [FC, TOTAL, F82_X16]), 1e-6)
# Godot and both OGREs: read at (mu, 1 - roughness), rows as cmgen's: the row that is k from the smooth end has (k + 1.5) / n
mu, r = centre(40, 128), (127 - 40 + 1.5) / 128
row("godot", "godot-dfg", (40, 40), split(mu, r * r, [FC, TOTAL], schlick_ibl) + [cloth(mu, r * r)], 1e-6)
mu, r = centre(20, 64), (63 - 18 + 1.5) / 64
row("ogre", "ogre-dfg", (20, 18), split(mu, r * r, [FC, TOTAL]), 1e-6)
# Ogre-Next holds scale, bias, and Frostbite's diffuse lobe: F90 = r / 2 + 2 r v^2, factor 1 - r (1 - 1 / 1.51)
frostbite = disney_diffuse(mu, r, r / 2, 2, 1 - r * (1 - 1 / 1.51))
row("ogre-next", "ogre-next-dfg", (20, 18), split(mu, r * r, [SCALE, FC]) + [frostbite], 1e-6)
# HDRP: x is sqrt(mu), both on the ends; Disney's diffuse lobe over 1.03571 with F90 = 1/2 + r + r cos(2 theta_d), which is 1/2 + 2 r v^2
mu, r = (20 / 63) ** 2, 45 / 63
hdrp = disney_diffuse(mu, r, 0.5, 2, 1 / 1.03571)
row("unity-hdrp", "hdrp-ggx-disney-diffuse", (20, 45), split(mu, r * r, [FC, TOTAL]) + [hdrp], 1e-6)

# Area lights: x is roughness, y is sqrt(1 - mu), both on the ends; magnitude, Fresnel, 0, form factor of a sphere
# (cosine 2 x - 1 to its centre, sin^2 of its radius y)
factor = sphere(2 * 45 / 63 - 1, 18 / 63)
magnitude = lambda alpha: split(1 - (18 / 63) ** 2, alpha, [TOTAL, FC]) + [0.0, factor]
for engine, table in [
    ("selfshadow-ltc", "ltc-2"),
    ("three", "three-ltc-magnitude"),
    ("playcanvas", "playcanvas-ltc-magnitude"),
    ("bevy", "bevy-ltc-magnitude"),
    ("ogre", "ogre-ltc-magnitude"),
]:
    row(engine, table, (45, 18), magnitude((45 / 63) ** 2), 1e-4)
# Ogre-Next: x is alpha
row("ogre-next", "ogre-next-ltc-magnitude", (45, 18), magnitude(45 / 63), 1e-4)

# Cycles: corners i / (n - 1), roughness fastest, then mu, then z; F0 = z^4, index (1 + z^2) / (1 - z^2)
r, mu = 22 / 31, 9 / 31
row("cycles", "cycles-ggx-E", (22, 9), split(mu, r * r, [TOTAL]), 1e-6)
row("cycles", "cycles-ggx-Eavg", (22,), [average(lambda m: split(m, r * r, [TOTAL])[0])], 1e-6)
r, mu, z = 11 / 15, 4 / 15, 7 / 15
ior = (1 + z * z) / (1 - z * z)
row("cycles", "cycles-ggx-glass-E", (11, 4, 7), [glass(mu, r * r, ior)], 1e-8)
row("cycles", "cycles-ggx-glass-Eavg", (11, 7), [average(lambda m: glass(m, r * r, ior, 24))], 1e-6)
row("cycles", "cycles-ggx-glass-inv-E", (11, 4, 7), [glass(mu, r * r, 1 / ior)], 1e-8)
row("cycles", "cycles-ggx-glass-inv-Eavg", (11, 7), [average(lambda m: glass(m, r * r, 1 / ior, 24), 40)], 1e-5)
# mean over visible normals of (F - F0) / (1 - F0), and of (1 - v)^(5 (1 - z) / z)
f0 = z**4
row("cycles", "cycles-ggx-gen-schlick-ior-s", (11, 4, 7), [visible(mu, r * r, lambda v: (dielectric(v, ior) - f0) / (1 - f0))], 1e-8)
row("cycles", "cycles-ggx-gen-schlick-s", (11, 4, 7), [visible(mu, r * r, lambda v: (1 - v) ** (5 * (1 - z) / z))], 1e-8)

# Transforms of the colour-matching functions, x, y, z, real then imaginary: path difference 60000 k / (1022 pi) nm, times 60 / (1000 pi)
def observer():
    rows = [line.split(",") for line in open("../../src/terms/cie_xyz_1931_2deg.csv") if line[0] != "#"]
    return [[float(cell) for cell in cells] for cells in rows]


def transform(d, c, wave):
    total = 0.0
    rows = observer()
    for low, high in zip(rows, rows[1:]):
        for t, w in gauss(6, 0, 1):
            eye = low[c] + t * (high[c] - low[c])
            total += w * eye * wave(2 * pi * d / (low[0] + t))
    return 60 / (1000 * pi) * total


d = 60000 * 137 / (1022 * pi)
row("cycles", "cycles-thin-film-cmf", (137,), [transform(d, c, f) for f in (cos, lambda x: -sin(x)) for c in (1, 2, 3)], 1e-6)

# OSL: 1 - E; cosines are squares of equal steps for the lobe, equal steps for the interface, whose index is 1.001 + 3.999 t^2
r = 11 / 15
row("osl", "osl-mini-microfacet-ggx", (6, 11), [1 - split((6 / 15) ** 2, r * r, [TOTAL])[0]], 1e-6)
eta = 1.001 + 3.999 * (20 / 31) ** 2
row("osl", "osl-dielectric-front", (6, 11, 20), [1 - glass(6 / 15, r * r, eta)], 1e-8)

# Sheen: A, B, R at mu = 4 / 31, roughness = 20 / 31; the array of the authors is [mu][r], that of Cycles [r][mu], Babylon's
# picture has views as rows, and A = 0.005 + 0.875 r, B = -0.18 + 0.182 g, R = 0.75 b
a, b, reflectance = 0.47706, -0.14135, 0.57114
row("ltc-sheen", "ltc-sheen-volume", (20, 4), [a, b, reflectance], 2e-3)
row("cycles", "cycles-sheen-ltc", (4, 20), [a, b, reflectance], 2e-3)
row("babylon", "babylon-fuzz-brdf", (20, 4), [(a - 0.005) / 0.875, (b + 0.18) / 0.182, reflectance / 0.75], 3e-3)

# OpenPBR: corners, mu fastest, then roughness, then the index: 16 evenly in 1 / ior from 2.5 down to 1, 16 evenly in ior from 1 to
# 2.5, separable masking. What is lost by the interface (R + T), by its reflection alone, by a metal of F = 1; and the means of it
mu, alpha = 9 / 31, (22 / 31) ** 2
for side, eta in [("", 1 + 1.5 * 5 / 15), ("-inside", 1 / (1 + 1.5 * 10 / 15))]:
    through = lambda m, n=100: 1 - glass(m, alpha, eta, n, separable)
    opaque = lambda m: 1 - split(m, alpha, [lambda v: dielectric(v, eta)], separable)[0]
    row("openpbr", "openpbr-dielectric" + side, (9, 22, 5), [through(mu)], 1e-6)
    row("openpbr", "openpbr-dielectric-avg" + side, (22, 5), [average(lambda m: through(m, 32))], 1e-5)
    row("openpbr", "openpbr-opaque" + side, (9, 22, 5), [opaque(mu)], 1e-5)
    row("openpbr", "openpbr-opaque-avg" + side, (22, 5), [average(opaque)], 1e-5)
metal = lambda m: 1 - split(m, alpha, [TOTAL], separable)[0]
row("openpbr", "openpbr-metal", (9, 22), [metal(mu)], 1e-6)
row("openpbr", "openpbr-metal-avg", (0, 22), [average(metal)], 1e-6)
row("openpbr", "openpbr-sheen", (4, 20), [a, b, reflectance], 2e-3)
