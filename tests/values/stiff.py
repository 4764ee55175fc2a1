"""Writes stiff.csv: terms at the stiff ends of their ranges, by the textbook formulas in 60-digit arithmetic (mpmath).

Every input is a number of 32 bits, so that both precisions are compared with the value at exactly their own input.
Directions are the given components, not rescaled to length 1. Run: python3 stiff.py > stiff.csv
"""
import struct
import mpmath as mp

mp.mp.dps = 60


def f32(x):
    return struct.unpack("f", struct.pack("f", x))[0]


def row(term, inputs, value):
    cells = ["%.17g" % v for v in inputs] + [""] * (8 - len(inputs))
    print(",".join([term] + cells + [mp.nstr(value, 20, min_fixed=0, max_fixed=0)]))


def exact(*values):
    return [mp.mpf(v) for v in values]


def up(mu, phi):
    s = mp.sqrt((1 - mp.mpf(mu)) * (1 + mp.mpf(mu)))
    return [f32(s * mp.cos(phi)), f32(s * mp.sin(phi)), f32(mu)]


print("# By stiff.py in this folder; mpmath, 60 digits. Inputs are exact numbers of 32 bits.")
print("term,a,b,c,d,e,f,g,h,value")

WIDTHS = [(a, a) for a in (1e-7, 1e-5, 1e-3, 0.03, 0.5, 1.0)] + [(1e-4, 0.1), (1e-3, 1.0), (1.0, 1e-3)]
for ax, ay in WIDTHS:
    ax, ay = f32(ax), f32(ay)
    for t in (0.0, 0.3, 1.0, 3.0, 100.0):
        for phi in (0.0, 0.7, 1.5):
            tx, ty = ax * t * mp.cos(phi), ay * t * mp.sin(phi)
            n = mp.sqrt(1 + tx * tx + ty * ty)
            h = [f32(tx / n), f32(ty / n), f32(1 / n)]
            x, y, z, a, b = exact(*h, ax, ay)
            q = (x / a) ** 2 + (y / b) ** 2 + z * z
            row("ggx-d", [ax, ay] + h, 1 / (mp.pi * a * b * q * q))
            e = ((x / a) ** 2 + (y / b) ** 2) / (z * z)
            if e < 60:
                row("beckmann-d", [ax, ay] + h, mp.exp(-e) / (mp.pi * a * b * z**4))
    for mu in (1e-8, 1e-4, 0.1, 0.9, 1 - 1e-6):
        w = up(mu, 0.7)
        x, y, z, a, b = exact(*w, ax, ay)
        t = ((a * x) ** 2 + (b * y) ** 2) / (z * z)
        row("ggx-lambda", [ax, ay] + w, (mp.sqrt(1 + t) - 1) / 2)
        c = 1 / mp.sqrt(t)
        value = (mp.exp(-c * c) / (c * mp.sqrt(mp.pi)) - mp.erfc(c)) / 2
        if value > 1e-30:
            row("beckmann-lambda", [ax, ay] + w, value)
        for mu_i in (1e-8, 0.5):
            v = up(mu_i, 2.5)
            vx, vy, vz = exact(*v)
            ti = ((a * vx) ** 2 + (b * vy) ** 2) / (vz * vz)
            lo, li = (mp.sqrt(1 + t) - 1) / 2, (mp.sqrt(1 + ti) - 1) / 2
            row("ggx-visibility", [ax, ay] + w + v, 1 / (4 * z * vz * (1 + lo + li)))

for eta in (1e-3, 0.5, 0.6875, 1 - 1e-6, 1 + 1e-6, 1 + 1e-4, 1.5, 40.0, 1e3):
    eta = f32(eta)
    n = mp.mpf(eta)
    cosines = [1e-8, 1e-4, 0.05, 0.5, 0.95, 1.0]
    if eta < 1:
        critical = mp.sqrt((1 - n) * (1 + n))
        cosines += [critical * s for s in (1 - mp.mpf("1e-3"), 1 + mp.mpf("1e-3"), 1 + mp.mpf("0.02"))]
    for c in cosines:
        c = f32(min(float(c), 1.0))
        k = mp.mpf(c)
        g2 = n * n - 1 + k * k
        if g2 <= 0:
            row("dielectric", [c, eta], mp.mpf(1))
            continue
        g = mp.sqrt(g2)
        s, p = ((k - g) / (k + g)) ** 2, ((n * n * k - g) / (n * n * k + g)) ** 2
        row("dielectric", [c, eta], (s + p) / 2)

for n, k in ((0.01, 1000.0), (0.06, 64.0), (0.2, 3.5), (1.0, 1e-4), (1.5, 0.0), (3.0, 3.0), (1000.0, 1000.0)):
    n, k = f32(n), f32(k)
    for c in (1e-8, 1e-3, 0.1, 0.7, 1.0):
        c = f32(c)
        m, u = mp.mpc(n, k), mp.mpf(c)
        q = mp.sqrt(m * m - 1 + u * u)
        s, p = abs((u - q) / (u + q)) ** 2, abs((m * m * u - q) / (m * m * u + q)) ** 2
        row("conductor", [c, n, k], (s + p) / 2)
        row("conductor-absorptance", [c, n, k], 1 - (s + p) / 2)

for n in (0.0, 1.0, 100.0, 1e4, 1e6, 1e7):
    for t in (0.0, 0.1, 1.0, 3.0):
        theta = t / mp.sqrt(n + 4)
        h = [f32(mp.sin(theta) * 0.8), f32(mp.sin(theta) * 0.6), f32(mp.cos(theta))]
        x, y, z = exact(*h)
        # cos^n of the direction that the horizontal part fixes, as shaders that carry h do
        s2 = x * x + y * y
        c2 = 1 - s2 if s2 < 0.5 else z * z
        row("blinn-phong-d", [n] + h, (n + 2) / (2 * mp.pi) * c2 ** (mp.mpf(n) / 2))

for g in (-0.9999, 0.0, 1e-5, 0.1, 0.9, 0.999, 0.9999):
    g = f32(g)
    for d in (0.0, 1e-8, 1e-4, 0.5, 2.0):
        d = f32(d)
        a, u = mp.mpf(g), mp.mpf(d)
        row("henyey-greenstein", [g, d], (1 - a * a) / (4 * mp.pi * (1 + a * a - 2 * a * (1 - u)) ** mp.mpf("1.5")))

for a in (1e-3, 0.5, 0.999, 1.0):
    a = f32(a)
    for gamma in (0.5, 1.0, 1 + 2**-20, 2.0, 3.0):
        for mu in (0.01, 0.9, 1 - 1e-6):
            h = up(mu, 0.7)
            x, y, z, w, e = exact(*h, a, gamma)
            s = x * x + y * y
            base = w * w * z * z + s
            if e == 1:
                c = (w * w - 1) / (mp.pi * mp.log(w * w)) if w != 1 else 1 / mp.pi
            elif w == 1:
                c = 1 / mp.pi
            else:
                c = (e - 1) * (w * w - 1) / (mp.pi * (1 - w ** (2 * (1 - e))))
            row("gtr-d", [a, gamma] + h, c / base**e)

for r in (0.07, 0.3, 1.0):
    r = f32(r)
    for mu in (1e-6, 0.3, 0.99, 1 - 1e-6):
        h = up(mu, 0.7)
        x, y, z, w = exact(*h, r)
        s2 = x * x + y * y
        s2 = s2 if s2 < 0.5 else 1 - z * z
        row("charlie-d", [r] + h, (2 + 1 / w) * s2 ** (1 / (2 * w)) / (2 * mp.pi))

for v in (0.0, 1e-8, 1e-4, 0.5, 0.999999, 1.0):
    for f0 in (0.0, 0.04, 1.0):
        v, f0 = f32(v), f32(f0)
        u, a = exact(v, f0)
        row("schlick", [f0, v], a + (1 - a) * (1 - u) ** 5)
