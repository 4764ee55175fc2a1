#!/usr/bin/env python3
"""Checks KTX2 files against the rules of the KTX 2.0 specification, numbered as `ktx validate` of KTX-Software numbers them.

    BRDFBAKE_FOREIGN=foreign-out cargo test --test files -- --ignored write_
    python3 tests/foreign/ktx2_rules.py foreign-out
    python3 tests/foreign/ktx2_rules.py --broken foreign-out

Every .ktx2 below the folder is read; nothing but the standard library is needed. With `--broken`, each file is also broken in one way
after another, and every fault must be found under its number.

Sources: KTX File Format Specification 2.0.4; Khronos Data Format Specification 1.3, section 5. The validator warns of keys that are not
KTX's (7010), which is no fault here. Numbers from 9501 on are rules of brdfbake beyond the specification.

Exit code: 0 valid (and every fault found), 1 not, 2 nothing to check.
"""

import math
import struct
import sys
from pathlib import Path

MAGIC = b"\xabKTX 20\xbb\r\n\x1a\n"
ONE, MINUS_ONE, ALL = 0x3F800000, 0xBF800000, 0xFFFFFFFF
FLOAT, SIGNED, EXPONENT = 0x80, 0x40, 0x20
CHANNELS = [0, 1, 2, 15]
ZSTD, NONE = 2, 0
# formats that have an sRGB twin
SRGB_TWIN = (9, 16, 23, 37, 145)
NO_NUL = {b"KTXorientation": 7107, b"KTXwriter": 7122, b"KTXwriterScParams": 7126}
# transfer functions and primaries that the data format specification knows
TRANSFERS, PRIMARIES = range(0, 20), range(0, 12)


def plain(bits, count, kind, lower, upper):
    """Samples of components of the same length, one behind the other."""
    return [(bits * i, bits, kind | CHANNELS[i], lower, upper) for i in range(count)]


def rgb9e5():
    samples = []
    for c in range(3):
        samples += [(9 * c, 9, c, 0, 8448), (27, 5, EXPONENT | c, 15, 31)]
    return samples


def formats():
    """By VkFormat: bytes of a block, its texels each way, colour model, typeSize, samples (offset, bits, channel, lower, upper)."""
    known = {}
    for count in range(1, 5):
        known[[9, 16, 23, 37][count - 1]] = (count, 1, 1, 1, plain(8, count, 0, 0, 0xFF))
        known[[70, 77, 84, 91][count - 1]] = (2 * count, 1, 1, 2, plain(16, count, 0, 0, 0xFFFF))
        known[[76, 83, 90, 97][count - 1]] = (2 * count, 1, 1, 2, plain(16, count, FLOAT | SIGNED, MINUS_ONE, ONE))
        known[[100, 103, 106, 109][count - 1]] = (4 * count, 1, 1, 4, plain(32, count, FLOAT | SIGNED, MINUS_ONE, ONE))
    known[64] = (4, 1, 1, 4, plain(10, 3, 0, 0, 1023) + [(30, 2, 15, 0, 3)])
    known[122] = (4, 1, 1, 4, [(0, 11, FLOAT, 0, ONE), (11, 11, FLOAT | 1, 0, ONE), (22, 10, FLOAT | 2, 0, ONE)])
    known[123] = (4, 1, 1, 4, rgb9e5())
    known[139] = (8, 4, 131, 1, [(0, 64, 0, 0, ALL)])
    known[141] = (16, 4, 132, 1, [(0, 64, 0, 0, ALL), (64, 64, 1, 0, ALL)])
    known[143] = (16, 4, 133, 1, [(0, 128, FLOAT, 0, ONE)])
    known[144] = (16, 4, 133, 1, [(0, 128, FLOAT | SIGNED, MINUS_ONE, ONE)])
    known[145] = (16, 4, 134, 1, [(0, 128, 0, 0, ALL)])
    return known


FORMATS = formats()


def up(n, to):
    return -(-n // to) * to


def utf8(text):
    try:
        text.decode()
    except UnicodeDecodeError:
        return False
    return True


def zstd_size(data):
    """Length that the frame header of Zstandard states (RFC 8878, 3.1.1.1); none if it states none."""
    if data[:4] != b"\x28\xb5\x2f\xfd":
        return None
    flag = data[4]
    at = 5 + (0 if flag & 0x20 else 1) + [0, 1, 2, 4][flag & 3]
    width = [1 if flag & 0x20 else 0, 2, 4, 8][flag >> 6]
    if not width:
        return None
    return int.from_bytes(data[at : at + width], "little") + (256 if width == 2 else 0)


class File:
    """Words of the header, and what is found wrong: (number, sentence)."""

    def __init__(self, data):
        self.data = data
        self.faults = []
        if len(data) < 80 or data[:12] != MAGIC:
            self.fault(2001, "not a KTX2 file")
            return
        names = "format type_size width height depth layers faces levels scheme dfd_at dfd_len kvd_at kvd_len"
        for name, word in zip(names.split(), struct.unpack_from("<13I", data, 12)):
            setattr(self, name, word)
        self.sgd_at, self.sgd_len = struct.unpack_from("<2Q", data, 64)
        self.level_count = max(self.levels, 1)
        self.known = FORMATS.get(self.format)
        if 80 + 24 * self.level_count > len(data):
            self.fault(1003, "the level index lies beyond the end")
            self.header()
            return
        self.index = [struct.unpack_from("<3Q", data, 80 + 24 * i) for i in range(self.level_count)]
        for check in (self.header, self.places, self.descriptor, self.level_index, self.keys, self.paddings, self.pixels):
            check()

    def fault(self, number, text):
        self.faults.append((number, text))

    def rule(self, number, holds, text):
        if not holds:
            self.fault(number, text)
        return holds

    def header(self):
        self.rule(3002, self.known is not None, f"VkFormat {self.format} is none that is written")
        block = self.known is not None and self.known[1] > 1
        if self.known is not None:
            right = self.known[3]
            self.rule(3005 if block else 3012, self.type_size == right, f"typeSize {self.type_size}, not {right}")
        self.rule(3006, self.width > 0, "pixelWidth is 0")
        self.rule(3007, not block or self.height > 0, "pixelHeight of a block format is 0")
        self.rule(3009, self.depth == 0 or self.height > 0, "a depth without height")
        self.rule(3013, self.faces != 6 or self.depth == 0, "a cube with depth")
        self.rule(3014, self.depth == 0 or self.layers == 0, "an array of volumes, which no API has")
        if self.rule(3015, self.faces in (1, 6), f"faceCount {self.faces}") and self.faces == 6:
            self.rule(3008, self.width == self.height, "a cube that is no square")
        most = max(self.width, self.height, self.depth)
        self.rule(3016, most >= 1 << (self.level_count - 1), f"{self.level_count} levels of {most} texels")
        self.rule(3017, not block or self.levels > 0, "levelCount of a block format is 0")
        self.rule(3019, self.scheme in (NONE, ZSTD), f"supercompression {self.scheme}")

    def places(self):
        self.rule(3020, self.dfd_at > 0 and self.dfd_len > 0, "no data format descriptor")
        at = up(80 + 24 * self.level_count, 4)
        self.rule(3021, self.dfd_at == at, f"descriptor at {self.dfd_at}, not {at}")
        if self.kvd_at:
            self.rule(3028, self.dfd_len == self.kvd_at - self.dfd_at, "descriptor does not end where the keys begin")
        if self.kvd_len:
            at = up(at + self.dfd_len, 4)
            self.rule(3022, self.kvd_at == at, f"keys at {self.kvd_at}, not {at}")
        else:
            self.rule(3023, self.kvd_at == 0, "an offset of keys without length")
        self.rule(3027, self.sgd_len == 0, "global data without a scheme that has any")
        self.rule(3025, self.sgd_len or self.sgd_at == 0, "an offset of global data without length")

    def descriptor(self):
        end = self.dfd_at + self.dfd_len
        if not self.rule(1003, end <= len(self.data), "the descriptor ends beyond the file") or self.dfd_len < 28:
            self.rule(6004, self.dfd_len >= 28, "no room for a basic descriptor")
            return
        total, vendor, version_size = struct.unpack_from("<3I", self.data, self.dfd_at)
        self.rule(6001, total == self.dfd_len, f"dfdTotalSize {total}, not {self.dfd_len}")
        size = version_size >> 16
        self.rule(6008, vendor == 0, "the first block is no basic descriptor of Khronos")
        self.rule(6007, 4 + size <= self.dfd_len, "the block is longer than the descriptor")
        self.rule(6010, size >= 24, f"descriptorBlockSize {size} is less than 24")
        self.rule(6009, (size - 24) % 16 == 0, f"descriptorBlockSize {size} is no whole number of samples")
        self.rule(6011, version_size & 0xFFFF == 2, f"version {version_size & 0xFFFF} of the block, not 2")
        model, primaries, transfer, flags = self.data[self.dfd_at + 12 : self.dfd_at + 16]
        self.rule(6012, transfer in TRANSFERS, f"transfer {transfer}")
        self.rule(6014, transfer != 2 or self.format not in SRGB_TWIN, "sRGB transfer of a format that has an sRGB twin")
        self.rule(6019, primaries in PRIMARIES, f"primaries {primaries}")
        self.rule(9502, transfer == 1 and primaries == 0 and flags == 0, "numbers are linear, without primaries, and not premultiplied")
        if self.known is None:
            return
        bytes_, side, right_model, _, samples = self.known
        self.rule(6015 if side == 1 else 6016, model == right_model, f"colour model {model}, not {right_model}")
        block = list(self.data[self.dfd_at + 16 : self.dfd_at + 20])
        self.rule(6020, block == [side - 1, side - 1, 0, 0], f"block dimensions {block}")
        planes = list(self.data[self.dfd_at + 20 : self.dfd_at + 28])
        self.rule(6021, planes == [bytes_] + [0] * 7, f"bytes of planes {planes}, not {bytes_}")
        found = (min(size, self.dfd_len - 4) - 24) // 16
        self.rule(6025, found == len(samples), f"{found} samples, not {len(samples)}")
        for i, right in enumerate(samples[:found]):
            offset, bits, channel, *position, lower, upper = struct.unpack_from("<HBB4BII", self.data, self.dfd_at + 28 + 16 * i)
            got = (offset, bits + 1, channel, lower, upper)
            self.rule(6028, got == right and position == [0] * 4, f"sample {i}: {got} at {position}, not {right}")

    def level_size(self, level):
        bytes_, side = self.known[:2]
        width, height, depth = (max(n >> level, 1) for n in (self.width, self.height, self.depth))
        return up(width, side) // side * (up(height, side) // side) * bytes_ * depth * self.faces * max(self.layers, 1)

    def level_index(self):
        if self.known is None:
            return
        align = 1 if self.scheme else math.lcm(self.known[0], 4)
        first = self.sgd_at + self.sgd_len if self.sgd_len else self.kvd_at + self.kvd_len if self.kvd_len else self.dfd_at + self.dfd_len
        expected = up(first, align)
        for i in range(1, self.level_count):
            self.rule(4001, self.index[i][2] <= self.index[i - 1][2], "a level is larger than the one before")
            self.rule(4002, self.index[i][0] < self.index[i - 1][0], "levels are not stored from the smallest on")
        for i in reversed(range(self.level_count)):
            at, length, plain_length = self.index[i]
            self.rule(4003, at % align == 0, f"level {i} at {at}, no multiple of {align}")
            self.rule(4004, at % align != 0 or at == expected, f"level {i} at {at}, not {expected}")
            right = self.level_size(i)
            self.rule(4006, plain_length == right, f"level {i}: uncompressedByteLength {plain_length}, not {right}")
            if self.scheme == NONE:
                self.rule(4005, length == right, f"level {i}: byteLength {length}, not {right}")
            expected = up(at + length, align)
        last = self.index[0][0] + self.index[0][1]
        self.rule(1003, last <= len(self.data), "a level ends beyond the file")
        self.rule(9501, last >= len(self.data), "bytes behind the last level")

    def keys(self):
        end = self.kvd_at + self.kvd_len
        if not self.kvd_len or not self.rule(1003, end <= len(self.data), "the keys end beyond the file"):
            return
        at, keys = self.kvd_at, {}
        order = []
        while at < end:
            if not self.rule(7002, end - at >= 6, f"{end - at} bytes are no entry"):
                return
            (length,) = struct.unpack_from("<I", self.data, at)
            if not self.rule(7004, length >= 2, f"an entry of {length} bytes"):
                return
            if not self.rule(7003, at + 4 + length <= end, f"an entry of {length} bytes is longer than what is left"):
                return
            pair = self.data[at + 4 : at + 4 + length]
            key, zero, value = pair.partition(b"\0")
            self.rule(7013, key, "an empty key")
            self.rule(7006, not key.startswith(b"\xef\xbb\xbf"), "a key with a byte order mark")
            self.rule(7005, zero, f"the key {key!r} does not end with NUL")
            self.rule(7013, key not in keys, f"the key {key!r} is there twice")
            keys[key] = value
            order.append(key)
            at += 4 + length
            pad = self.data[at : min(up(at, 4), end)]
            self.rule(7011, not any(pad), "padding of an entry is not zero")
            at = up(at, 4)
        self.rule(7008, at == end, "the entries do not add up to kvdByteLength")
        self.rule(7012, order == sorted(order), f"keys out of order: {order}")
        self.values(keys)

    def values(self, keys):
        ours = {b"KTXorientation", b"KTXwriter", b"KTXwriterScParams", b"KTXswizzle"}
        for key, value in keys.items():
            self.rule(7007, utf8(key), f"{key!r} is no UTF-8")
            self.rule(7123 if key == b"KTXwriter" else 9504, utf8(value), f"the text of {key!r} is no UTF-8")
            self.rule(7009, not key.lower().startswith(b"ktx") or key in ours, f"{key!r} is reserved")
            self.rule(NO_NUL.get(key, 9504), value.endswith(b"\0") and value.count(b"\0") == 1, f"the text of {key!r} does not end with its only NUL")
        orientation = keys.get(b"KTXorientation", b"").rstrip(b"\0").decode("ascii", "replace")
        dimensions = 3 if self.depth else 2 if self.height else 1
        if b"KTXorientation" in keys:
            self.rule(7108, len(orientation) == dimensions, f"KTXorientation {orientation!r} for {dimensions} dimensions")
            fits = all(c in allowed for c, allowed in zip(orientation, ("rl", "du", "oi")))
            self.rule(7109, fits, f"KTXorientation {orientation!r}")
        writer = b"KTXwriter" in keys
        self.rule(7124, writer or b"KTXwriterScParams" not in keys, "KTXwriterScParams without KTXwriter")
        self.rule(7125, writer, "no KTXwriter")
        self.rule(9503, (b"KTXwriterScParams" in keys) == (self.scheme != NONE), "KTXwriterScParams goes with supercompression")

    def paddings(self):
        position = 80 + 24 * self.level_count
        pieces = [(self.dfd_at, self.dfd_len), (self.kvd_at, self.kvd_len), (self.sgd_at, self.sgd_len)]
        for at, length in pieces + [(a, n) for a, n, _ in reversed(self.index)]:
            if not at or not length:
                continue
            if at >= position:
                self.rule(7011, not any(self.data[position:at]), f"padding before byte {at} is not zero")
            position = max(position, at + length)

    def pixels(self):
        if self.scheme != ZSTD:
            return
        for i, (at, length, plain_length) in enumerate(self.index):
            size = zstd_size(self.data[at : at + length])
            self.rule(4008, size == plain_length, f"level {i}: the frame holds {size} bytes, not {plain_length}")


def word(at, value, form="<I"):
    def change(data):
        struct.pack_into(form, data, at, value)

    return change


def overwrite(find, offset, new):
    def change(data):
        at = data.index(find) + offset
        data[at : at + len(new)] = new

    return change


def breaks(f):
    """Ways to break a file: name, number under which it must be found, change."""
    dfd, kvd, level = f.dfd_at, f.kvd_at, 80
    samples = dfd + 28
    text = f.data.index(b"KTXwriter\0")
    ways = [
        ("magic", 2001, lambda d: d.__setitem__(5, 0x31)),
        ("format", 3002, word(12, 5000)),
        ("type size", 3012 if f.known[1] == 1 else 3005, word(16, 3)),
        ("no width", 3006, word(20, 0)),
        ("faces", 3015, word(36, 2)),
        ("too many levels", 3016, word(40, 3) if max(f.width, f.height, f.depth) < 4 else word(40, 12)),
        ("scheme", 3019, word(44, 7)),
        ("no descriptor", 3020, word(52, 0)),
        ("descriptor displaced", 3021, word(48, dfd + 4)),
        ("length of the descriptor", 3028, word(52, f.dfd_len + 4)),
        ("keys displaced", 3022, word(56, kvd + 4)),
        ("keys without length", 3023, word(60, 0)),
        ("offset of global data", 3025, word(64, 8, "<Q")),
        ("global data", 3027, word(72, 8, "<Q")),
        ("level displaced", 4004 if f.scheme else 4003, word(level, f.index[0][0] + 1, "<Q")),
        ("level too long", 1003, word(level + 8, f.index[0][1] + 64, "<Q")),
        ("uncompressed length", 4006, word(level + 16, f.index[0][2] + 4, "<Q")),
        ("total size", 6001, word(dfd, f.dfd_len - 4)),
        ("vendor", 6008, word(dfd + 4, 1)),
        ("block size", 6009, word(dfd + 8, 2 | (f.dfd_len - 8) << 16)),
        ("block too long", 6007, word(dfd + 8, 2 | (f.dfd_len + 12) << 16)),
        ("version", 6011, word(dfd + 8, 1 | (f.dfd_len - 4) << 16)),
        ("model", 6015 if f.known[1] == 1 else 6016, word(dfd + 12, 3, "<B")),
        ("primaries", 6019, word(dfd + 13, 200, "<B")),
        ("transfer", 6012, word(dfd + 14, 99, "<B")),
        ("sRGB", 6014 if f.format in SRGB_TWIN else 9502, word(dfd + 14, 2, "<B")),
        ("block dimension", 6020, word(dfd + 16, 7, "<B")),
        ("bytes of a plane", 6021, word(dfd + 20, 77, "<B")),
        ("sample offset", 6028, word(samples, 5, "<H")),
        ("sample length", 6028, word(samples + 2, 30, "<B")),
        ("sample channel", 6028, word(samples + 3, 9, "<B")),
        ("sample position", 6028, word(samples + 4, 1, "<B")),
        ("sample lower", 6028, word(samples + 8, 77)),
        ("sample upper", 6028, word(samples + 12, 78)),
        ("entry too short", 7004, overwrite(b"KTXorientation\0", -4, b"\1")),
        ("entry too long", 7003, overwrite(b"brdfbake\0", -1, b"\1")),
        ("empty key", 7013, word(text, 0, "<B")),
        ("key without end", 7005, overwrite(b"KTXwriter\0", -4, b"\x09")),
        ("same key twice", 7013, overwrite(b"brdfbake\0", 0, b"KTXwriter\0")),
        ("not UTF-8", 7123, word(text + 12, 0xFF, "<B")),
        ("out of order", 7012, overwrite(b"KTXorientation\0", 0, b"zzz")),
        ("reserved key", 7009, word(text + 3, ord("q"), "<B")),
        ("orientation", 7109, overwrite(b"KTXorientation\0", 15, b"x")),
        ("orientation too short", 7108, overwrite(b"KTXorientation\0", 16 if f.depth == 0 else 17, b"\0")),
        ("no writer", 7125, overwrite(b"KTXwriter\0", 0, b"X")),
        ("text without NUL", 7122, word(text + struct.unpack_from("<I", f.data, text - 4)[0] - 1, 65, "<B")),
        ("cut", 1003, lambda d: d.__delitem__(slice(len(d) - 4, len(d)))),
        ("longer", 9501, lambda d: d.extend(b"\0\0\0\0")),
    ]
    if f.depth:
        ways.append(("array of volumes", 3014, word(32, 2)))
        ways.append(("no height", 3009, word(24, 0)))
    if f.scheme:
        ways.append(("not the size of the frame", 4008, lambda d: d.__setitem__(f.index[0][0] + 5, d[f.index[0][0] + 5] ^ 1)))
        ways.append(("parameters without writer", 7124, overwrite(b"KTXwriter\0", 0, b"X")))
    else:
        ways.append(("byte length", 4005, word(level + 8, f.index[0][1] - 4, "<Q")))
        ways.append(("supercompression that is none", 4008, word(44, ZSTD)))
        gap = f.index[0][0] - (kvd + f.kvd_len)
        if gap:
            ways.append(("padding of the level", 7011, word(f.index[0][0] - 1, 1, "<B")))
    at = kvd
    while at < kvd + f.kvd_len:
        length = struct.unpack_from("<I", f.data, at)[0]
        if (at + 4 + length) % 4:
            ways.append((f"padding of the entry at {at}", 7011, word(at + 4 + length, 1, "<B")))
        at = up(at + 4 + length, 4)
    return ways


def unfound(f):
    """Names of faults that are not found under their number."""
    missed, ways = [], breaks(f)
    for name, number, change in ways:
        data = bytearray(f.data)
        change(data)
        numbers = {n for n, _ in File(bytes(data)).faults}
        if number not in numbers:
            missed.append(f"{name}: {number} not among {sorted(numbers)}")
    return missed, len(ways)


def main():
    broken = "--broken" in sys.argv
    folders = [a for a in sys.argv[1:] if not a.startswith("--")]
    files = sorted(p for folder in folders for p in Path(folder).rglob("*.ktx2"))
    if not files:
        print(__doc__ if not folders else f"no .ktx2 below {', '.join(folders)}", file=sys.stderr)
        return 2
    failed = tried = 0
    for path in files:
        f = File(path.read_bytes())
        faults = [f"{n}: {text}" for n, text in f.faults]
        if broken and not faults:
            missed, count = unfound(f)
            tried += count
            faults += [f"fault not found: {m}" for m in missed]
        failed += bool(faults)
        for fault in faults:
            print(f"FAIL {path}: {fault}")
    print(f"{len(files)} files against the rules of KTX 2.0, {failed} with faults; {tried} broken copies tried")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
