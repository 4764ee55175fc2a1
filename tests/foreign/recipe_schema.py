#!/usr/bin/env python3
"""Recipes against the schema that `brdfbake schema` prints: those that are good keep it, and no damaged one does.

Usage: recipe_schema.py BRDFBAKE BAD_FOLDER FOLDER...   Needs the package jsonschema, and Python 3.11 for TOML.
"""
import copy
import datetime
import json
import pathlib
import subprocess
import sys
import tomllib

import jsonschema

# files of the folder of bad recipes whose fault is one of form; the others are wrong in what they mean
OF_FORM = """empty-file missing-keys no-tables outputs output-options single-brackets texels unknown-ids unknown-keys unknown-kind
warp-forms waivers wide-characters wrong-types negative-length axes-too-many size map-keys""".split()


def damaged(value, free=False):
    """Copies of a value, each with one fault: a key of another name, a value of another type."""
    if isinstance(value, dict):
        for key, inner in value.items():
            rest = {k: v for k, v in value.items() if k != key}
            if not free:
                yield {**rest, key + "x": inner}
            yield {**rest, key: datetime.date(2000, 1, 1)}
            for worse in damaged(inner, free=key == "params"):
                yield {**value, key: worse}
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            yield value[:i] + [None] + value[i + 1:]
            for worse in damaged(inner):
                yield value[:i] + [worse] + value[i + 1:]


def main():
    program, bad, *folders = sys.argv[1:]
    schema = json.loads(subprocess.run([program, "schema"], check=True, capture_output=True).stdout)
    jsonschema.Draft202012Validator.check_schema(schema)
    keeps = jsonschema.Draft202012Validator(schema).is_valid
    good, broken = 0, 0
    for path in sorted(p for folder in folders for p in pathlib.Path(folder).rglob("*.toml")):
        recipe = tomllib.loads(path.read_text())
        if "name" not in recipe:
            continue
        for error in jsonschema.Draft202012Validator(schema).iter_errors(recipe):
            raise SystemExit(f"{path}: {error.json_path}: {error.message[:300]}")
        good += 1
        # one table is like another: the first ones are damaged, in each of their keys
        few = copy.deepcopy(recipe)
        few["table"] = recipe.get("table", [])[:2] or [{"kind": "dfg", "name": "x"}]
        for worse in damaged(few):
            broken += 1
            assert not keeps(worse), f"{path}: a damaged recipe keeps the schema: {worse}"
    assert good > 20 and broken > 1000, f"{good} recipes, {broken} damaged ones"
    for stem in OF_FORM:
        assert not keeps(tomllib.loads((pathlib.Path(bad) / f"{stem}.toml").read_text())), f"{stem} keeps the schema"
    print(f"recipes: {good} keep their schema, {broken + len(OF_FORM)} damaged ones do not")


main()
