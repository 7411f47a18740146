"""The book's tables of columns and axes, made of what the program registers (`pontoon schema tables`).

Knows the marks between which a page has such a table: `<!-- columns: jobs -->` and `<!-- end of columns -->`.
"""

import json
import re
import subprocess

MARKED = re.compile(
    r"(?P<begin><!-- columns: (?P<table>\w+) -->\n)(?P<body>.*?)(?P<end><!-- end of columns -->)", re.DOTALL
)
# what is said of a column that only some results have
WHEN = {
    "always": "",
    "loaded": "",
    "static": "; of static cases",
    "crossing": "; of crossings",
    "modes": "; of studies of modes",
    "auto_time_step": '; with `"time_step_s": "auto"`',
    "verify": "; with `verify`",
    "pins": "; where pins are recorded",
    "sections": "; where sections are recorded",
    "freeboards": "; where freeboards are recorded",
    "waves": "; where a bridge has water with memory",
    "modes_in_waves": "; where a bridge has water with memory",
    "place_histories": "; with histories of places",
    "pin_histories": "; with histories of pins or vehicles",
    "springs": "; of vehicles on springs",
    "vehicle_histories": "; with histories of vehicles",
    "limits": "; with limits",
    "rating": "; of ratings",
}


def registered(program):
    """The columns and axes as the program tells them."""
    done = subprocess.run([program, "schema", "tables"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def line(cells):
    return f"| {' | '.join(cells)} |\n"


def column_row(column):
    words = f" ({', '.join(f'`{word}`' for word in column['words'])})" if "words" in column else ""
    return line([f"`{column['name']}`", column["unit"], column["text"] + words + WHEN[column["when"]]])


def axis_row(axis):
    """An axis: its values, and the path that it is another name of."""
    words = f": {', '.join(f'`{word}`' for word in axis['words'])}" if "words" in axis else ""
    job = axis.get("job", {})
    path = axis.get("document") or job.get("stands_for")
    studies = [name for name, key in (("crossings", "crossings"), ("static cases", "statics")) if job.get(key, True)]
    return line(
        [f"`{axis['name']}`", axis["unit"], axis["label"] + words, f"`{path}`" if path else "", " and ".join(studies)]
    )


def table(name, registry):
    """The table of a name; none where the program registers no such table."""
    if name == "axes":
        head = line(["axis", "unit", "is", "stands for", "of"]) + "|---|---|---|---|---|\n"
        return head + "".join(axis_row(axis) for axis in registry["axes"])
    columns = [column for column in registry["columns"] if column["table"] == name]
    if not columns:
        return None
    return line(["column", "unit", "is"]) + "|---|---|---|\n" + "".join(column_row(column) for column in columns)


def filled(text, registry):
    """A page with its tables as the program registers them."""

    def made(match):
        body = table(match["table"], registry)
        return match[0] if body is None else match["begin"] + body + match["end"]

    return MARKED.sub(made, text)


def faults(pages, registry):
    """The tables of pages that are not those of the program."""
    found = []
    for page in pages:
        for match in MARKED.finditer(page.text):
            place = f"{page.name}:{page.text.count(chr(10), 0, match.start()) + 1}"
            body = table(match["table"], registry)
            if body is None:
                found.append(f"{place}: no table '{match['table']}'")
            elif match["body"] != body:
                found.append(f"{place}: other columns than the program's: scripts/check-book --columns writes them")
    return found
