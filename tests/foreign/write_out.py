#!/usr/bin/env python3
"""Writes pictures with OpenEXR and OpenImageIO, and what they hold as JSON, for brdfbake to read.

    pip install OpenEXR OpenImageIO numpy
    python3 tests/foreign/write_out.py foreign-out-in
    BRDFBAKE_FOREIGN_IN=foreign-out-in cargo test --test files -- --ignored files_of

The expected values are those that the same library reads back, so that lossy compressions are covered too.
"""

import json
import sys
from pathlib import Path

import numpy as np
import OpenEXR
import OpenImageIO as oiio

WIDTH, HEIGHT = 83, 61
rng = np.random.default_rng(7)


def expect(path, channels):
    """One list of f64 bits a channel."""
    columns = {
        name: [f"{b:016x}" for b in np.ascontiguousarray(v, dtype=np.float64).ravel().view(np.uint64)]
        for name, v in channels.items()
    }
    height, width = next(iter(channels.values())).shape
    told = {"width": width, "height": height, "channels": columns}
    Path(f"{path}.expected.json").write_text(json.dumps(told), encoding="utf-8")


def wave(dtype):
    x, y = np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT))
    value = (np.sin(x / 7) * np.cos(y / 5) + 1) / 2 + rng.normal(0, 1e-3, (HEIGHT, WIDTH))
    return value.astype(dtype) if dtype != np.uint32 else (value * 1e6).clip(0).astype(dtype)


def part(name, compression, **more):
    channels = {
        "h": wave(np.float16),
        "dfg.f": wave(np.float32),
        "u": wave(np.uint32),
    }
    header = {"compression": compression, "type": OpenEXR.scanlineimage, **more}
    return OpenEXR.Part(header, channels, name)


def exr(path, parts):
    OpenEXR.File(parts).write(str(path))
    channels = {}
    with OpenEXR.File(str(path), separate_channels=True) as f:
        for i, p in enumerate(f.parts):
            prefix = f"{p.name()}." if len(f.parts) > 1 else ""
            channels |= {prefix + name: np.array(c.pixels) for name, c in f.channels(i).items()}
    expect(path, channels)


def exr_files(folder):
    for name in ("NO", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB"):
        exr(folder / f"{name.lower()}.exr", [part("one", getattr(OpenEXR, f"{name}_COMPRESSION"))])
    window = (np.array([-11, 5], np.int32), np.array([WIDTH - 12, HEIGHT + 4], np.int32))
    exr(folder / "window.exr", [part("one", OpenEXR.ZIP_COMPRESSION, dataWindow=window)])
    zips = OpenEXR.ZIP_COMPRESSION
    exr(folder / "parts.exr", [part("first", zips), part("second", OpenEXR.PIZ_COMPRESSION)])
    exr(folder / "down.exr", [part("one", zips, lineOrder=OpenEXR.DECREASING_Y)])


def tiled(path):
    spec = oiio.ImageSpec(WIDTH, HEIGHT, 2, "half")
    spec.channelnames = ("A", "Z")
    spec.tile_width = spec.tile_height = 16
    spec.attribute("compression", "zip")
    pixels = np.dstack([wave(np.float16), wave(np.float16)])
    out = oiio.ImageOutput.create(str(path))
    out.open(str(path), spec)
    out.write_image(pixels)
    out.close()
    expect(path, {"A": pixels[:, :, 0], "Z": pixels[:, :, 1]})


def png(path, names, dtype):
    top = np.iinfo(dtype).max
    codes = rng.integers(0, top, (HEIGHT, WIDTH, len(names)), dtype=dtype, endpoint=True)
    spec = oiio.ImageSpec(WIDTH, HEIGHT, len(names), str(np.dtype(dtype)))
    spec.attribute("oiio:UnassociatedAlpha", 1)
    out = oiio.ImageOutput.create(str(path))
    out.open(str(path), spec)
    out.write_image(codes)
    out.close()
    expect(path, {n: codes[:, :, i].astype(np.float64) / top for i, n in enumerate(names)})


def main():
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    exr_files(folder)
    tiled(folder / "tiled.exr")
    for names in ("Y", "YA", "RGB", "RGBA"):
        png(folder / f"{names}8.png", names, np.uint8)
        png(folder / f"{names}16.png", names, np.uint16)


if __name__ == "__main__":
    main()
