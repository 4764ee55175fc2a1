"""A knot of gold before a ball of plastic, each with a transform of its own: `python3 make.py` writes knot.gltf and knot.bin.

The knot is a tube of radius 0.28 round c(t) = 0.4 ((2 + cos 3t) cos 2t, (2 + cos 3t) sin 2t, sin 3t); its normals are those of the tube.
"""

import json
import math
import struct

ALONG, ROUND = 96, 16
BALL = (32, 20)


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    n = math.sqrt(sum(x * x for x in a))
    return [x / n for x in a]


def curve(t):
    r = 2 + math.cos(3 * t)
    return [0.4 * v for v in (r * math.cos(2 * t), r * math.sin(2 * t), math.sin(3 * t))]


def grid(columns, rows, place):
    """Vertices of a grid that wraps, and two triangles a cell."""
    vertices = [place(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
    at = lambda i, j: j * (columns + 1) + i
    triangles = []
    for j in range(rows):
        for i in range(columns):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            triangles += [a, b, c, a, c, d]
    return vertices, triangles


def knot(u, v):
    t, s = 2 * math.pi * u, 2 * math.pi * v
    middle, step = curve(t), 1e-4
    tangent = unit(sub(curve(t + step), curve(t - step)))
    side = unit(cross(tangent, [0, 0, 1]))
    up = cross(side, tangent)
    normal = [math.cos(s) * x + math.sin(s) * y for x, y in zip(side, up)]
    return [m + 0.28 * n for m, n in zip(middle, normal)], normal


def ball(u, v):
    phi, theta = 2 * math.pi * u, math.pi * (1 - v)
    normal = [math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)]
    return normal, normal


data, views, accessors = b"", [], []


def add(numbers, form, component, kind, count, **more):
    global data
    part = struct.pack(f"<{len(numbers)}{form}", *numbers)
    views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(part)})
    accessors.append({"bufferView": len(views) - 1, "componentType": component, "type": kind, "count": count, **more})
    data += part + b"\0" * (-len(part) % 4)
    return len(accessors) - 1


def primitive(mesh, material):
    vertices, triangles = mesh
    positions = [struct.unpack("<3f", struct.pack("<3f", *p)) for p, _ in vertices]
    ends = {"min": [min(p[c] for p in positions) for c in range(3)], "max": [max(p[c] for p in positions) for c in range(3)]}
    place = add([x for p in positions for x in p], "f", 5126, "VEC3", len(vertices), **ends)
    normal = add([x for _, n in vertices for x in n], "f", 5126, "VEC3", len(vertices))
    indices = add(triangles, "H", 5123, "SCALAR", len(triangles))
    return {"attributes": {"POSITION": place, "NORMAL": normal}, "indices": indices, "material": material}


def material(name, base, metallic, roughness):
    return {"name": name, "pbrMetallicRoughness": {"baseColorFactor": base, "metallicFactor": metallic, "roughnessFactor": roughness}}


scene = {
    "asset": {"version": "2.0", "generator": "make.py"},
    "scene": 0,
    "scenes": [{"nodes": [0]}],
    "nodes": [
        {"children": [1, 2], "translation": [3, -1, 2], "scale": [2, 2, 2]},
        {"name": "knot", "mesh": 0, "rotation": [0.28, 0.0, 0.0, 0.96]},
        {"name": "ball", "mesh": 1, "translation": [0, 0, -1.2], "scale": [1.1, 0.8, 0.5]},
    ],
    "materials": [material("gold", [1, 0.77, 0.34, 1], 1, 0.3), material("plastic", [0.2, 0.4, 0.6, 1], 0, 0.5)],
    "meshes": [{"primitives": [primitive(grid(ALONG, ROUND, knot), 0)]}, {"primitives": [primitive(grid(*BALL, ball), 1)]}],
}
scene.update(accessors=accessors, bufferViews=views, buffers=[{"byteLength": len(data), "uri": "knot.bin"}])
with open("knot.gltf", "w") as out:
    out.write(json.dumps(scene, indent=1) + "\n")
with open("knot.bin", "wb") as out:
    out.write(data)
