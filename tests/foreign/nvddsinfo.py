#!/usr/bin/env python3
"""Compares what `nvddsinfo` (NVIDIA Texture Tools, Debian package libnvtt-bin) says of DDS files with what they must hold.

    BRDFBAKE_FOREIGN=foreign-out cargo test --test files -- --ignored write_
    python3 tests/foreign/nvddsinfo.py foreign-out

Exit code: 0 all agree, 1 a difference, 2 nothing to compare.
"""

import json
import re
import subprocess
import sys
from pathlib import Path


def check(path):
    """The differences."""
    want = json.loads(path.with_name(path.name + ".expected.json").read_text(encoding="utf-8"))
    told = subprocess.run(["nvddsinfo", str(path)], capture_output=True, text=True, check=False)
    text = told.stdout + told.stderr

    def number(name):
        found = re.search(rf"^\s*{name}: (\d+)", text, re.MULTILINE)
        return int(found[1]) if found else None

    pairs = [("Width", want["width"]), ("Height", want["height"])]
    if want.get("depth"):
        pairs.append(("Depth", want["depth"]))
    if "Array size" in text:
        pairs.append(("Array size", max(want.get("layers", 0), 1)))
    faults = [f"{name} {number(name)}, not {value}" for name, value in pairs if number(name) != value]
    if told.returncode:
        faults.append(f"exit code {told.returncode}")
    return faults


def main():
    files = sorted(Path(sys.argv[1]).glob("*.dds")) if len(sys.argv) == 2 else []
    failed = 0
    for path in files:
        faults = check(path)
        failed += bool(faults)
        if faults:
            print(f"FAIL {path}: {'; '.join(faults)}")
    print(f"{len(files)} DDS files, {failed} of which nvddsinfo says otherwise")
    return 2 if not files else 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
