"""Checks rows of dfg.csv by slope-space quadrature in 30-digit arithmetic (needs mpmath): python3 check_dfg.py [rows]

With wi = (s, 0, c), T = s/c, slopes x = r cos p, y = r sin p and r = alpha sinh(t):
  E = int int P22(r) (1 + T x) w(v) G2 r dr dp over r < r_max(p) = T cos p + sqrt(T^2 cos^2 p + 1)
which shares no chart with the program. w = 1 - (1-v)^5 for scale and (1-v)^5 for bias.
"""
import csv
import sys
from mpmath import mp, mpf, sqrt, cos, asinh, sinh, cosh, pi, quad, linspace

mp.dps = 30


def dfg(mu, alpha):
    mu, a = mpf(mu), mpf(alpha)
    s = sqrt(1 - mu * mu)
    T = s / mu

    def lam(m):
        t2 = a * a * (1 - m * m) / (m * m)
        return t2 / (2 * (1 + sqrt(1 + t2)))

    lo = lam(mu)

    def inner(p, power):
        c = cos(p)
        root = sqrt(T * T * c * c + 1)
        rmax = T * c + root if c > 0 else 1 / (root - T * c)

        def f(t):
            r = a * sinh(t)
            x = r * c
            cos2 = 1 / (1 + r * r)
            v = sqrt(cos2) * (s * x + mu)
            m = mu * cos2 * (rmax - r) * (r + 1 / rmax)
            if m <= 0:
                return mpf(0)
            p22 = 1 / (pi * a * a * cosh(t) ** 4)
            fc = (1 - v) ** 5
            w = fc if power else 1 - fc
            return p22 * (1 + T * x) * w / (1 + lo + lam(m)) * r * a * cosh(t)

        top = asinh(rmax / a)
        return quad(f, linspace(0, top, 6))

    return [2 * quad(lambda p: inner(p, k), [0, pi / 4, pi / 2, 3 * pi / 4, pi]) for k in (0, 1)]


def main():
    limit = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    rows = [r for r in csv.DictReader(l for l in open("dfg.csv") if not l.startswith("#"))]
    for row in rows[137 :: max(1, len(rows) // limit)][:limit]:
        got = dfg(row["mu"], mpf(row["roughness"]) ** 2)
        off = [abs(g - mpf(row[k])) for g, k in zip(got, ("scale", "bias"))]
        print(row["mu"], row["roughness"], "off by", [mp.nstr(o, 3) for o in off])
        if max(off) > mpf(10) ** -12:
            sys.exit("a row is wrong")


main()
