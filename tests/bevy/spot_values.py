#!/usr/bin/env python3
"""Split sums of GGX at texels of Bevy's dfg.ktx2, integrated with NumPy and nothing of brdfbake.

    pip install numpy
    python3 tests/bevy/spot_values.py > tests/bevy/spot_values.csv

f = D G2 F / (4 mu_o mu_i) with D of GGX (Walter 2007, Eq. 33), alpha = roughness^2, height-correlated G2 (Heitz 2014, Eq. 99) and
F = F0 + (1 - F0) Fc, Fc = (1 - wo.wh)^5, so that the albedo is F0 * scale + bias. Over half vectors the integral is

    int D G2 (wo.wh) / mu_o dwh,    mu_i = 2 (wo.wh) cos(theta) - mu_o > 0

With tan^2(theta) = alpha^2 u / (1 - u) the density D cos(theta) becomes du dphi / (2 pi). For each u the azimuth goes from 0 to where
mu_i = 0; u is split where that begins to cut, and where nothing is left. Gauss rules, with a cubic that takes the roots at the ends away;
the last column is the difference between 200 and 300 nodes.
"""

import numpy as np

SIZE = 64
TEXELS = [(0, 40), (0, 63), (1, 20), (2, 55), (5, 8), (8, 32), (13, 3), (20, 20), (31, 31), (32, 60), (40, 12), (47, 47), (55, 2), (60, 35), (63, 0), (63, 63)]


def rule(n):
    """Nodes and weights on [0, 1], dense towards both ends."""
    t, w = np.polynomial.legendre.leggauss(n)
    t, w = (t + 1) / 2, w / 2
    return t * t * (3 - 2 * t), w * 6 * t * (1 - t)


def split_sum(mu, roughness, n):
    alpha = roughness**2
    sin_v = np.sqrt(1 - mu * mu)
    theta_v = np.arccos(mu)
    t, w = rule(n)

    def smith(c):
        return (np.sqrt(1 + alpha**2 * (1 - c * c) / (c * c)) - 1) / 2

    def piece(a, b):
        u, wu = a + (b - a) * t, (b - a) * w
        theta = np.arctan(alpha * np.sqrt(u / (1 - u)))[:, None]
        end = np.arccos(np.clip((mu / (2 * np.cos(theta)) - mu * np.cos(theta)) / (sin_v * np.sin(theta)), -1, 1))
        phi = end * t
        vh = sin_v * np.sin(theta) * np.cos(phi) + mu * np.cos(theta)
        mu_i = np.maximum(2 * vh * np.cos(theta) - mu, 1e-150)
        g = vh / (mu * np.cos(theta)) / (1 + smith(mu) + smith(mu_i)) * end / np.pi
        fc = (1 - vh) ** 5
        return np.array([(wu[:, None] * w * g * f).sum() for f in (1 - fc, fc)])

    def u_of(theta):
        q = (np.tan(theta) / alpha) ** 2
        return q / (1 + q)

    cuts = [u_of(np.pi / 4 - theta_v / 2), u_of(np.pi / 4 + theta_v / 2)]
    ends = sorted({0.0, *cuts, *(p for p in (0.5, 0.99) if p < cuts[1])})
    return sum(piece(a, b) for a, b in zip(ends, ends[1:]))


def main():
    print("x,y,mu,roughness,scale,bias,doubt")
    for x, y in TEXELS:
        mu, roughness = (x + 0.5) / SIZE, (y + 0.5) / SIZE
        coarse, fine = (split_sum(mu, roughness, n) for n in (200, 300))
        print(f"{x},{y},{mu!r},{roughness!r},{fine[0]:.14g},{fine[1]:.14g},{abs(fine - coarse).max():.1e}")


if __name__ == "__main__":
    main()
