"""Reads a MERL binary and prints f (red, green, blue, 1/sr) at theta_in phi_in theta_out phi_out, in radians.

    python3 read_merl.py FILE 0.3 0 0.8 2.5

Needs nothing but Python. Written from the index functions of the reader published with the database.
"""

import math
import struct
import sys


def rotate(v, axis, angle):
    c, s = math.cos(angle), math.sin(angle)
    dot = sum(a * b for a, b in zip(axis, v)) * (1 - c)
    cross = (
        axis[1] * v[2] - axis[2] * v[1],
        axis[2] * v[0] - axis[0] * v[2],
        axis[0] * v[1] - axis[1] * v[0],
    )
    return tuple(v[i] * c + axis[i] * dot + cross[i] * s for i in range(3))


def half_diff(theta_in, phi_in, theta_out, phi_out):
    def spherical(t, p):
        return (math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t))

    a, b = spherical(theta_in, phi_in), spherical(theta_out, phi_out)
    h = [x + y for x, y in zip(a, b)]
    length = math.sqrt(sum(x * x for x in h))
    h = [x / length for x in h]
    theta_h, phi_h = math.acos(max(-1.0, min(1.0, h[2]))), math.atan2(h[1], h[0])
    d = rotate(rotate(a, (0, 0, 1), -phi_h), (0, 1, 0), -theta_h)
    return theta_h, math.acos(max(-1.0, min(1.0, d[2]))), math.atan2(d[1], d[0])


def main():
    path, *angles = sys.argv[1:]
    with open(path, "rb") as f:
        dims = struct.unpack("<3i", f.read(12))
        if dims != (90, 90, 180):
            sys.exit(f"{path}: dimensions {dims}, not 90 90 180")
        plane = 90 * 90 * 180
        data = f.read()
    if len(data) != 24 * plane:
        sys.exit(f"{path}: {len(data)} bytes of values, not {24 * plane}")
    theta_h, theta_d, phi_d = half_diff(*map(float, angles))
    if phi_d < 0:
        phi_d += math.pi
    i = min(89, int(math.sqrt(max(0.0, theta_h) / (math.pi / 2) * 90 * 90)))
    j = min(89, max(0, int(theta_d / (math.pi / 2) * 90)))
    k = min(179, max(0, int(phi_d / math.pi * 180)))
    index = k + 180 * (j + 90 * i)
    for colour, scale in enumerate((1 / 1500, 1.15 / 1500, 1.66 / 1500)):
        (value,) = struct.unpack_from("<d", data, 8 * (index + colour * plane))
        print(value * scale)


main()
