#!/usr/bin/env python3
"""Makes eight.gltf, its two pictures and expected.json: eight texels of specular-glossiness, and what the published conversion
(KHR_materials_pbrSpecularGlossiness, example convert-between-workflows) makes of them. Nothing of brdfbake is used.

Usage: python3 make.py   (in this folder)
"""
import base64
import json
import math
import struct
import zlib

DIFFUSE = [(188, 137, 89), (0, 0, 0), (188, 137, 89), (149, 124, 89), (89, 89, 89), (231, 231, 231), (255, 255, 255), (188, 188, 188)]
SPECGLOSS = [(56, 56, 56, 178), (250, 209, 194, 230), (39, 39, 39, 255), (124, 124, 124, 128),
             (188, 170, 149, 64), (56, 56, 56, 0), (255, 255, 255, 128), (188, 188, 188, 128)]


def linear(code):
    c = code / 255
    return c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4


def code(x):
    s = 12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055
    return round(255 * min(max(s, 0), 1))


def brightness(c):
    return math.sqrt(0.299 * c[0] ** 2 + 0.587 * c[1] ** 2 + 0.114 * c[2] ** 2)


def solve(diffuse, specular, a=0.04, eps=1e-6):
    rest = 1 - max(specular)
    d, s = brightness(diffuse), brightness(specular)
    metallic = 0.0
    if s >= a:
        b = d * rest / (1 - a) + s - 2 * a
        metallic = min(max((-b + math.sqrt(max(b * b - 4 * a * (a - s), 0))) / (2 * a), 0), 1)
    base = []
    for k in range(3):
        one = diffuse[k] * rest / (1 - a) / max(1 - metallic, eps)
        two = (specular[k] - a * (1 - metallic)) / max(metallic, eps)
        base.append(min(max(one + (two - one) * metallic ** 2, 0), 1))
    return base, metallic


def png(name, pixels, width):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes(sum(pixels[i:i + width], ())) for i in range(0, len(pixels), width))
    head = struct.pack(">IIBBBBB", width, len(pixels) // width, 8, 6, 0, 0, 0)
    data = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
    open(name, "wb").write(data)


expected = []
for i, (d, s) in enumerate(zip(DIFFUSE, SPECGLOSS)):
    base, metallic = solve([linear(c) for c in d], [linear(c) for c in s[:3]])
    expected.append({
        "texel": i, "diffuse8": [*d, 255], "specgloss8": list(s), "base_linear": [round(b, 9) for b in base],
        "base8": [code(b) for b in base], "metallic": round(metallic, 9), "metallic8": round(255 * metallic), "roughness8": 255 - s[3],
    })
json.dump(expected, open("expected.json", "w"), indent=1)
png("sg-diffuse.png", [(*d, 255) for d in DIFFUSE], 4)
png("sg-specgloss.png", SPECGLOSS, 4)
floats = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 1, 1, 0, 0]
data = struct.pack("<24f", *floats)
view = [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 36}, {"buffer": 0, "byteOffset": 72, "byteLength": 24}]
scene = {
    "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_pbrSpecularGlossiness"],
    "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "material": 0}]}],
    "materials": [{"name": "eight", "extensions": {"KHR_materials_pbrSpecularGlossiness": {
        "diffuseTexture": {"index": 0}, "specularGlossinessTexture": {"index": 1}}}}],
    "textures": [{"source": 0}, {"source": 1}], "images": [{"uri": "sg-diffuse.png"}, {"uri": "sg-specgloss.png"}],
    "buffers": [{"byteLength": 96, "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
    "bufferViews": [{**v, "target": 34962} for v in view],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                  {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3"},
                  {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC2"}],
}
json.dump(scene, open("eight.gltf", "w"), indent=2)
