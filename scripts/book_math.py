"""mdBook's preprocessor for equations: `$...$` and `$$...$$` become MathML. Knows nothing of what they mean.

Code spans and fenced blocks are left alone. An equation that is none stops the build with its page.
"""

import json
import re
import sys

import math_core

CODE_OR_MATH = re.compile(
    r"(?P<fence>^(?P<mark>```+|~~~+)[^\n]*\n.*?^(?P=mark)[^\n]*$)"
    r"|(?P<span>(?P<ticks>`+)(?!`).*?(?<!`)(?P=ticks)(?!`))"
    r"|\$\$(?P<display>.+?)\$\$"
    r"|\$(?P<inline>[^\s$](?:[^$\n]*[^\s$])?)\$",
    re.DOTALL | re.MULTILINE,
)
# The number of an equation, which is set beside it.
TAG = re.compile(r"\\tag\{([A-Z]\d+)\}")
# Text between tags, and what Markdown would take for its own there.
TEXT = re.compile(r"(?<=>)[^<]+")
HARMLESS = {c: f"&#{ord(c)};" for c in "*_`[]|\\~"}


def set_equations(text, page):
    """The page with its equations set."""
    convert = math_core.LatexToMathML(fancy_error=False)

    def one(match):
        tex = match["display"] or match["inline"]
        if tex is None:
            return match[0]
        number = TAG.search(tex)
        tex = TAG.sub("", tex)
        beside = f'<span class="number" id="{number[1]}">({number[1]})</span>' if number else ""
        try:
            mathml = convert.convert_with_local_state(tex.strip(), displaystyle=match["display"] is not None)
            return TEXT.sub(lambda text: "".join(HARMLESS.get(c, c) for c in text[0]), mathml) + beside
        except math_core.LatexError as error:
            sys.exit(f"{page}: no equation: {tex.strip()}: {error}")

    return CODE_OR_MATH.sub(one, text)


def walk(items):
    """Every chapter below a list of mdBook's items."""
    for item in items:
        if isinstance(item, dict) and "Chapter" in item:
            chapter = item["Chapter"]
            chapter["content"] = set_equations(chapter["content"], chapter["path"])
            walk(chapter["sub_items"])


def main():
    if sys.argv[1:2] == ["supports"]:
        sys.exit(0)
    _, book = json.load(sys.stdin)
    walk(book.get("items", book.get("sections", [])))
    json.dump(book, sys.stdout)


if __name__ == "__main__":
    main()
