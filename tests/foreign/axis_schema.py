#!/usr/bin/env python3
"""Axes in manifests against their schema, and their formulas computed by Python against the steps that the schema states.

Usage: axis_schema.py SCHEMA FOLDER...   Needs the package jsonschema.
"""
import json
import math
import pathlib
import random
import sys

import jsonschema

NAMES = {"sqrt": math.sqrt, "pow": math.pow, "cos": math.cos, "min": min, "max": max, "__builtins__": {}}


def forward(axis, value, coupled):
    """The steps of the schema's description, up to the texture coordinate."""
    lo, hi = axis["domain"]
    v = min(max((value - lo) / (hi - lo), 0.0), 1.0)
    warp = axis["warp"]
    if warp == "linear":
        w = v
    elif "power" in warp:
        w = v ** warp["power"]
    elif "one-minus-power" in warp:
        w = 1 - (1 - v) ** warp["one-minus-power"]
    else:
        c = warp["coupled"]["scale"] * coupled ** warp["coupled"]["exponent"]
        w = 0.0 if v + c == 0 else (v * (1 + c) / (v + c)) ** (1 / warp["coupled"]["power"])
    x = w if axis["direction"] == "ascending" else 1 - w
    n = axis["len"]
    index = x * n - 0.5 - axis["offset"] if axis["texel"] == "center" else x * (n - 1) - axis["offset"]
    return (index + 0.5) / n


def main():
    schema = json.loads(pathlib.Path(sys.argv[1]).read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    dice = random.Random(1)
    seen = {}
    for folder in sys.argv[2:]:
        for path in pathlib.Path(folder).rglob("manifest.json"):
            for table in json.loads(path.read_text())["tables"]:
                for axis in table.get("axes", []):
                    seen[json.dumps(axis, sort_keys=True)] = axis
    assert seen, "no axis in any manifest"
    for axis in seen.values():
        validator.validate(axis)
        code = compile(axis["coordinate"], "coordinate", "eval")
        lo, hi = axis["domain"]
        to = axis["warp"]["coupled"]["to"] if "coupled" in axis["warp"] else "unused"
        for i in range(1000):
            value = [lo, hi][i] if i < 2 else lo + (hi - lo) * dice.random()
            coupled = float(i) if i < 2 else dice.random()
            got = eval(code, dict(NAMES), {axis["id"]: value, to: coupled})
            want = forward(axis, value, coupled)
            assert abs(got - want) < 1e-12, f"{axis['coordinate']} at {axis['id']} = {value}, {to} = {coupled}: {got}, not {want}"
    print(f"axes: {len(seen)} keep their schema, and evaluate as they are written")


main()
