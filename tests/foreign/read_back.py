#!/usr/bin/env python3
"""Reads files of brdfbake with OpenEXR, OpenImageIO and NumPy and compares what they see.

    pip install OpenEXR OpenImageIO numpy
    BRDFBAKE_FOREIGN=foreign-out cargo test --test files -- --ignored write_
    python3 tests/foreign/read_back.py foreign-out

Every .exr, .png, .hdr, .npy and .pfm below the folder is read, and .dds of blocks. Next to a file, `<name>.expected.json` (written by tests/foreign.rs) says
which bits every channel must have; without it, the libraries are compared with each other and with the metadata in
the file (size, channels, sample type), which is how the outputs of the command are checked.

Exit code: 0 all agree, 1 a difference, 2 nothing to compare or a library is missing.
"""

import json
import sys
from pathlib import Path

try:
    import numpy as np
    import OpenEXR
    import OpenImageIO as oiio
except ImportError as e:
    print(f"{e}: pip install OpenEXR OpenImageIO numpy", file=sys.stderr)
    sys.exit(2)

ATTRIBUTE = "brdfbake"
STORAGE = {
    "float16": "half",
    "float32": "float",
    "float64": "double",
    "uint8": "unorm8",
    "uint16": "unorm16",
    "rgbd": "rgbd",
    "rgbe": "rgbe",
    "bc4": "bc4",
    "bc5": "bc5",
    "bc6h": "bc6h",
    "bc6h-signed": "bc6h-signed",
}


class Difference(Exception):
    """What two readers, or a reader and the expectation, do not agree on."""


def same(what, got, expected):
    if got != expected:
        raise Difference(f"{what}: got {got!r}, expected {expected!r}")


def openexr(path):
    """Channels, metadata text and custom attributes as OpenEXR sees them."""
    with OpenEXR.File(str(path), separate_channels=True) as f:
        channels = {name: np.array(c.pixels) for name, c in f.channels().items()}
        header = dict(f.header())
    return channels, header.get(ATTRIBUTE), header


def openimageio(path):
    """Channels and metadata text as OpenImageIO sees them, in the type of the file."""
    # The fourth channel is no opacity: without this OpenImageIO multiplies the other three by it.
    config = oiio.ImageSpec()
    config.attribute("oiio:UnassociatedAlpha", 1)
    image = oiio.ImageInput.open(str(path), config)
    if image is None:
        raise Difference(f"OpenImageIO: {oiio.geterror()}")
    spec = image.spec()
    pixels = image.read_image(spec.format)
    image.close()
    if pixels is None:
        raise Difference("OpenImageIO read no pixels")
    pixels = np.asarray(pixels).reshape(spec.height, spec.width, spec.nchannels)
    channels = {name: pixels[:, :, i] for i, name in enumerate(spec.channelnames)}
    return channels, spec.getattribute(ATTRIBUTE), spec


def bits(array):
    """Bits of the values as f64: tells -0 from 0 and one NaN from another."""
    return np.ascontiguousarray(array, dtype=np.float64).view(np.uint64)


def exr(path):
    """OpenEXR and OpenImageIO must see the same; returns values by channel and the metadata."""
    a, text_a, header = openexr(path)
    b, text_b, _ = openimageio(path)
    same("channels of OpenEXR and OpenImageIO", sorted(b), sorted(a))
    same("metadata of OpenEXR and OpenImageIO", text_b, text_a)
    for name, values in a.items():
        same(f"type of {name}", b[name].dtype, values.dtype)
        if not np.array_equal(bits(values), bits(b[name])):
            raise Difference(f"{name}: OpenEXR and OpenImageIO read different bits")
    same("compression", header["compression"], OpenEXR.ZIP_COMPRESSION)
    same("line order", header["lineOrder"], OpenEXR.INCREASING_Y)
    return a, text_a


def parts_of(path):
    return path.with_name(path.name + ".parts.json")


def check_parts(path):
    """A set of tables: each part has its name, its metadata and its values, in both libraries."""
    expected = json.loads(parts_of(path).read_text(encoding="utf-8"))
    with OpenEXR.File(str(path), separate_channels=True) as f:
        parts = [(p.name(), dict(p.header), {n: np.array(c.pixels) for n, c in p.channels.items()}) for p in f.parts]
    same("parts", [name for name, _, _ in parts], list(expected))
    image = oiio.ImageInput.open(str(path))
    for i, (name, header, channels) in enumerate(parts):
        told = expected[name]
        same(f"metadata of {name}", header.get(ATTRIBUTE), told["brdfbake"])
        same(f"{name} in OpenImageIO", image.seek_subimage(i, 0), True)
        spec = image.spec()
        same(f"part {i} in OpenImageIO", spec.getattribute("oiio:subimagename"), name)
        pixels = np.asarray(image.read_image(spec.format)).reshape(spec.height, spec.width, spec.nchannels)
        same(f"channels of {name}", sorted(channels), sorted(told["channels"]))
        same(f"channels of {name} in OpenImageIO", sorted(spec.channelnames), sorted(channels))
        for c, column in told["channels"].items():
            same(f"{name}.{c}", [f"{b:016x}" for b in bits(channels[c]).ravel()], column)
            again = pixels[:, :, list(spec.channelnames).index(c)]
            same(f"{name}.{c} in OpenImageIO", [f"{b:016x}" for b in bits(again).ravel()], column)
    image.close()
    return f"{len(parts)} parts, every bit as expected"


def png(path):
    """The codes of the channels that the metadata names, as values."""
    codes, text, spec = openimageio(path)
    told = json.loads(text)
    named, storage = told["channels"], told["encoding"]["storage"]
    width = 16 if storage == "unorm16" else 8
    same("bits", spec.get_int_attribute("oiio:BitsPerSample", width), width)
    space = spec.getattribute("oiio:ColorSpace") or ""
    same("linear colour space", space.startswith("lin"), True)
    samples = list(codes.values())
    values = {}
    if storage == "rgbd":
        same("samples a pixel", len(samples), 4)
        divisor = samples[3].astype(np.float64) / 255.0
        for channel, code in zip(named, samples):
            same(f"type of {channel['id']}", str(code.dtype), "uint8")
            values[channel["id"]] = ((code.astype(np.float64) / 255.0) ** 2.2 / divisor, "rgbd")
        return values, text
    same("samples a pixel", len(samples), 3 if len(named) == 2 else len(named))
    if len(named) == 2 and samples[2].any():
        raise Difference("the blue of two channels is not empty")
    top = float(2**width - 1)
    for channel, code in zip(named, samples):
        same(f"type of {channel['id']}", str(code.dtype), f"uint{width}")
        lo, hi = channel["range"]
        values[channel["id"]] = (lo + code.astype(np.float64) / top * (hi - lo), f"uint{width}")
    return values, text


def hdr(path):
    """Channels of a Radiance picture; the metadata is a line of its header."""
    channels, _, _ = openimageio(path)
    head = path.read_bytes().split(b"\n\n", 1)[0].split(b"\n")
    text = next(line for line in head if line.startswith(b"brdfbake=")).split(b"=", 1)[1].decode()
    named = [c["id"] for c in json.loads(text)["channels"]]
    planes = list(channels.values())
    same("channels", len(planes), 3)
    for rest in planes[len(named) :]:
        if rest.any():
            raise Difference("a component without channel is not empty")
    return {name: (p.astype(np.float64), "rgbe") for name, p in zip(named, planes)}, text


def sidecar_of(path):
    return path.with_name(path.name + ".expected.json")


def made_of_blocks(path):
    sidecar = sidecar_of(path)
    return sidecar.exists() and json.loads(sidecar.read_text(encoding="utf-8"))["storage"].startswith("bc")


def dds(path):
    """Blocks as OpenImageIO decodes them: halfs of BC6H, 8 bits of BC4 and BC5. The expectation names the channels."""
    expected = json.loads(sidecar_of(path).read_text(encoding="utf-8"))
    channels, _, _ = openimageio(path)
    named, storage = json.loads(expected["brdfbake"])["channels"], expected["storage"]
    planes = list(channels.values())
    same("channels", len(planes), {"bc4": 1, "bc5": 2}.get(storage, 3))
    for rest in planes[len(named) :]:
        if rest.any():
            raise Difference("a component without channel is not empty")
    values = {}
    for channel, plane in zip(named, planes):
        ramp = storage in ("bc4", "bc5")
        same(f"type of {channel['id']}", str(plane.dtype), "uint8" if ramp else "float16")
        lo, hi = channel["range"] if ramp else (0.0, 1.0)
        values[channel["id"]] = (lo + plane.astype(np.float64) / (255.0 if ramp else 1.0) * (hi - lo), storage)
    return values, expected["brdfbake"]


def npy(path):
    """An array says nothing of itself: the expectation names its channels."""
    array = np.load(path, allow_pickle=False)
    same("C order", array.flags["C_CONTIGUOUS"], True)
    sidecar = sidecar_of(path)
    if not sidecar.exists():
        return {f"c{i}": (array[..., i].reshape(-1, array.shape[-2]), str(array.dtype)) for i in range(array.shape[-1])}, None
    expected = json.loads(sidecar.read_text(encoding="utf-8"))
    same("shape", array.shape, (expected["height"], expected["width"], len(expected["channels"])))
    names = [c["id"] for c in json.loads(expected["brdfbake"])["channels"]]
    return {n: (array[..., i], str(array.dtype)) for i, n in enumerate(names)}, expected["brdfbake"]


def pfm(path):
    """A map says nothing of itself: the expectation names its channels; components beyond them are 0."""
    planes = list(openimageio(path)[0].values())
    sidecar = sidecar_of(path)
    if not sidecar.exists():
        return {f"c{i}": (p, str(p.dtype)) for i, p in enumerate(planes)}, None
    expected = json.loads(sidecar.read_text(encoding="utf-8"))
    names = [c["id"] for c in json.loads(expected["brdfbake"])["channels"]]
    same("channels", len(planes), 1 if len(names) == 1 else 3)
    for rest in planes[len(names) :]:
        if rest.any():
            raise Difference("a component without channel is not empty")
    return {n: (p, str(p.dtype)) for n, p in zip(names, planes)}, expected["brdfbake"]


def check(path):
    if parts_of(path).exists():
        return check_parts(path)
    if path.suffix == ".exr":
        arrays, text = exr(path)
        channels = {name: (values, str(values.dtype)) for name, values in arrays.items()}
    else:
        channels, text = {".png": png, ".hdr": hdr, ".npy": npy, ".pfm": pfm, ".dds": dds}[path.suffix](path)
    if text is None and path.suffix in (".npy", ".pfm"):
        return "numbers without metadata"
    if text is None:
        raise Difference("no metadata")
    told = json.loads(text)
    height, width = next(iter(channels.values()))[0].shape
    lengths = [axis["len"] for axis in told["axes"]] + [1, 1, 1]
    same("width", width, lengths[0])
    same("height", height, int(np.prod(lengths[1:])))
    # names by position, where loaders of colours are to read the file
    names = (told.get("encoding") or {}).get("names") or [c["id"] for c in told["channels"]]
    same("channels", sorted(channels), sorted(names))
    for name, (values, dtype) in channels.items():
        same(f"storage of {name}", STORAGE.get(dtype), told["encoding"]["storage"])
        if not np.isfinite(values).all():
            raise Difference(f"{name}: a value is not finite")
    sidecar = sidecar_of(path)
    if not sidecar.exists():
        return "libraries and metadata agree"
    expected = json.loads(sidecar.read_text(encoding="utf-8"))
    same("metadata text", text, expected["brdfbake"])
    same("width", width, expected["width"])
    same("height", height, expected["height"])
    for name, column in expected["channels"].items():
        got = [f"{b:016x}" for b in bits(channels[name][0]).ravel()]
        for i, (g, e) in enumerate(zip(got, column, strict=True)):
            if expected["storage"] == "rgbd":
                # a power is no exact operation
                g, e = (np.uint64(int(x, 16)).view(np.float64) for x in (g, e))
                same(f"{name}, texel {i}: {g} for {e}", bool(abs(g - e) <= 1e-14 * abs(e)), True)
                continue
            if expected["storage"] in ("bc4", "bc5"):
                # decoded to 8 bits there, in steps of a ramp that are rounded too
                g, e = (np.uint64(int(x, 16)).view(np.float64) for x in (g, e))
                same(f"{name}, texel {i}: {g} for {e}", bool(abs(g - e) <= 1 / 255), True)
                continue
            same(f"{name}, texel {i}", g, e)
    return f"{len(expected['channels'])} channels, every bit as expected"


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    files = sorted(
        p
        for p in Path(sys.argv[1]).rglob("*")
        if p.suffix in (".exr", ".png", ".hdr", ".npy", ".pfm") or p.suffix == ".dds" and made_of_blocks(p)
    )
    if not files:
        print(f"no picture below {sys.argv[1]}", file=sys.stderr)
        return 2
    failed = 0
    for path in files:
        try:
            print(f"ok   {path}: {check(path)}")
        except (Difference, OSError, RuntimeError, ValueError, KeyError) as e:
            failed += 1
            print(f"FAIL {path}: {type(e).__name__}: {e}")
    print(f"{len(files)} files, {failed} different")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
