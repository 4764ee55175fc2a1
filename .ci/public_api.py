#!/usr/bin/env python3
"""Lists the public API that `cargo doc --no-deps` has written: a line an item, its methods, fields and variants below it.

    RUSTDOCFLAGS="--cap-lints allow" cargo doc --no-deps --lib && .ci/public_api.py target/doc/brdfbake > public-api.txt

A release compares the list with that of the release before. The last line counts the items.
"""

import html
import re
import sys
from pathlib import Path

# ids that rustdoc gives to the members of a type, but for those of the traits that it implements
MEMBER = re.compile(r'<(?:section|span) id="((?:method|tymethod|variant|structfield|associatedconstant)\.[A-Za-z0-9_]+)"')
ITEM = re.compile(r'<a href="([^"]+)">([^<]+)</a>')


def members(page):
    text = page.read_text(encoding="utf-8")
    end = text.find('id="trait-implementations"')
    return sorted(set(MEMBER.findall(text if end < 0 else text[:end])))


def main(folder):
    folder = Path(folder)
    items = ITEM.findall((folder / "all.html").read_text(encoding="utf-8").split("<main>")[-1])
    lines, inner = [], 0
    for link, name in items:
        kind = Path(link).name.split(".")[0]
        if not (folder / link).exists() or link.startswith(("..", "#")):
            continue
        lines.append(f"{kind} {html.unescape(name)}")
        for member in members(folder / link):
            what, own = member.split(".", 1)
            lines.append(f"    {what} {own}")
            inner += 1
    print("\n".join(lines))
    print(f"{len(lines) - inner} items, {inner} methods, fields and variants")


main(*sys.argv[1:])
