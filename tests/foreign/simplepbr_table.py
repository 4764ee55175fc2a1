#!/usr/bin/env python3
"""The table of `bake --engine simplepbr` in panda3d-simplepbr itself, put there by the lines of its page.

    python3 tests/foreign/simplepbr_table.py OUT      (pip install panda3d panda3d-simplepbr)

The texture is read as the shader reads it, at a texel of `tests/values/engine_texels.csv` and between four.
"""
import csv
import os
import re
import sys
from pathlib import Path

import panda3d.core as p3d

here = Path(__file__).resolve().parent
page = (here / "../../presets/engines/simplepbr.md").read_text(encoding="utf-8")
lines = re.search(r"```python\n(.*?)```", page, re.S)[1]
os.chdir(sys.argv[1])
p3d.load_prc_file_data("", "window-type offscreen\naudio-library-name null")
exec(lines)

import simplepbr  # noqa: E402
from direct.showbase.ShowBase import ShowBase  # noqa: E402

base = ShowBase()
simplepbr.init()
texture = base.render.get_shader_input("brdf_lut").get_texture()
assert (texture.x_size, texture.y_size) == (128, 128), (texture.x_size, texture.y_size)
peek, colour = texture.peek(), p3d.LColor()


def look(mu, roughness):
    peek.lookup_bilinear(colour, mu, roughness)
    return colour[0], colour[1]


rows = [r for r in csv.reader(open(here / "../values/engine_texels.csv")) if r[0] == "simplepbr"]
assert len(rows) == 2, rows
for row in rows:
    x, y, component, value = int(row[2]), int(row[3]), int(row[5]), float(row[6])
    got = look((x + 0.5) / 128, (y + 0.5) / 128)[component]
    # its texels are fitted to the reader: that moves them by less than what a texel bends
    assert abs(got - value) < 1e-4, (x, y, component, got, value)
# white at normal incidence reflects nearly all: scale + bias falls with roughness only
assert all(abs(sum(look(1.0, r)) - 1) < 0.7 * r**2 + 1e-3 for r in (0.02, 0.1, 0.3, 0.5)), [sum(look(1.0, r)) for r in (0.02, 0.1, 0.3, 0.5)]
print("simplepbr", simplepbr.__name__, "reads", look(0.5, 0.5))
