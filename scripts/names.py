"""Counts the type names that more than one file defines, and doc comments that say what a thing is like.

scripts/names tells how it is called. Knows Rust as far as a line that begins a definition. Does not know scopes: types
of tests and of traits (`type Value = ..`) are left out.
"""

import re
import sys
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DEFINES = re.compile(
    r"^(?P<indent> *)(?:pub(?:\([a-z ]+\))? )?(?:struct|enum|trait|type) (?P<name>[A-Z]\w*)", re.MULTILINE
)
LAZY = re.compile(r"^\s*//[/!] (?:The same\b|See \S+$)")
MOST = 0.04


def definitions():
    """The files that define each name."""
    files = defaultdict(set)
    for path in sorted(ROOT.glob("crates/*/src/**/*.rs")):
        # what a test module defines is its own
        text = path.read_text().split("#[cfg(test)]\nmod tests {")[0]
        for match in DEFINES.finditer(text):
            if not match["indent"]:
                files[match["name"]].add(path.relative_to(ROOT))
    return files


def lazy_comments():
    """Doc comments that begin with "The same", or are a reference alone."""
    return [
        f"{path.relative_to(ROOT)}:{number}"
        for path in sorted(ROOT.glob("crates/*/src/**/*.rs"))
        for number, line in enumerate(path.read_text().splitlines(), 1)
        if LAZY.match(line)
    ]


def main(words):
    files = definitions()
    several = {name: where for name, where in files.items() if len(where) > 1}
    share = len(several) / len(files)
    for name, where in sorted(several.items(), key=lambda item: (-len(item[1]), item[0])):
        print(f"{name}: {', '.join(str(path) for path in sorted(where))}")
    print(f"{len(several)} of {len(files)} type names are defined in more than one file: {100 * share:.1f} %")
    lazy = lazy_comments()
    print("".join(f"{place}: says what it is like, not what it is\n" for place in lazy), end="")
    return 1 if "--check" in words and (share >= MOST or lazy) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
