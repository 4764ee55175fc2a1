#!/usr/bin/env python3
"""The objects that brdfbake writes into scenes against their schema.

Usage: scene_schema.py SCHEMA AXIS_SCHEMA SCENE...   Needs the package jsonschema.
"""
import json
import pathlib
import struct
import sys

import jsonschema
from referencing import Registry, Resource

NAME = "BRDFBAKE_lookup_tables"


def scene(path):
    data = pathlib.Path(path).read_bytes()
    return json.loads(data[20:20 + struct.unpack("<I", data[12:16])[0]] if data[:4] == b"glTF" else data)


def main():
    schema, axis = (json.loads(pathlib.Path(p).read_text()) for p in sys.argv[1:3])
    jsonschema.Draft202012Validator.check_schema(schema)
    registry = Registry().with_resource("../grid/axis.schema.json", Resource.from_contents(axis))
    validator = jsonschema.Draft202012Validator(schema, registry=registry)
    objects = [scene(path).get("extensions", {}).get(NAME) for path in sys.argv[3:]]
    objects = [thing for thing in objects if thing is not None]
    for thing in objects:
        validator.validate(thing)
    broken = json.loads(json.dumps(objects[0]))
    broken["tables"][0]["files"][0]["blake3"] = "no hash"
    assert not validator.is_valid(broken)
    print(f"scenes: {len(objects)} objects keep their schema")


main()
