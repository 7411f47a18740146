"""Runs a page's blocks in a folder of their own, one after the other, and holds what comes against what the page shows.

Knows how each language is run. Does not know where pages come from.

| block | how it is tried |
|---|---|
| `console` | lines that begin with `$ ` are run by bash, `\\` goes on; what follows is their standard output, or of a command that must fail (`exit=N`) its standard error. Spaces count as one. What moves from run to run (`MOVES`) matches whatever is of its kind; `within=0.01` lets numbers be off by that share; all else is equal. `head=12`, `tail=2` or `lines=3-9` say which lines of the last command's output are shown. Outside the guide `...` on a line of its own stands for any lines, within one for any text |
| `json study`, `json bridge`, `json reference` | written to `file=PATH` where there is one, and refused or not by the program. `with=PATH`: the keys of the block in place of those of that file. `exit=2`: must be refused. `equals=PATH`: must hold what that file holds |
| `json vehicle` | as those, by a study that names it |
| `json parameters` | written to `file=PATH`, for the commands below |
| `python` | run in the page's one Python; `text output` right after it is what it prints |
| `text` | not run |
"""  # noqa: E501

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
SECONDS = 600
# What moves from run to run, kind by kind; the first kind that matches counts. One of a kind matches any other of it.
AMOUNT = r"\d[\d,]*(?:\.\d+)?"
MOVES = {
    "date": r"\d{4}-\d\d-\d\d(?:[T ]\d\d:\d\d(?::\d\d(?:\.\d+)?)?(?:Z| UTC)?)?",
    "rate": rf"{AMOUNT} (?:jobs|steps)/s",
    "size": rf"{AMOUNT} [kMG]?B\b",
    "duration": rf"(?<![\d.])(?:{AMOUNT} (?:us|ms|s|min|h|d)\b(?!/) ?)+",
    "threads": r"\d+ threads?\b",
    "process": r"process \d+(?: on \S+)?",
    "record": r"\b[0-9a-f]{16}-[0-9a-f]{8}(?=\.pontoon)",
    "hash": r"\b(?=[0-9a-f]*\d)(?=[0-9a-f]*[a-f])[0-9a-f]{12,64}\b",
    "path": r"/tmp/\S+",
}
MOVING = re.compile("|".join(f"(?P<{kind}>{pattern})" for kind, pattern in MOVES.items()))
# How figures of the pages look; matplotlib reads it from the folder in which it is run.
STYLE = """
figure.figsize: 7.2, 3.4
axes.spines.top: False
axes.spines.right: False
axes.grid: True
grid.alpha: 0.3
lines.markersize: 4
legend.frameon: False
svg.hashsalt: pontoon
savefig.bbox: tight
"""
LANGUAGES = {"console", "json", "python", "text", "rust"}

# reads {"code": ...} a line, runs it in one namespace, answers {"out": ..., "error": ...}
PYTHON = r"""
import contextlib, io, json, sys, traceback
space, answers = {}, sys.stdout
for line in sys.stdin:
    out, error = io.StringIO(), None
    with contextlib.redirect_stdout(out):
        try:
            exec(json.loads(line)["code"], space)
        except Exception:
            error = traceback.format_exc()
    print(json.dumps({"out": out.getvalue(), "error": error}), file=answers, flush=True)
"""


class Mismatch(Exception):
    """A block that does not do what the page says."""


def words_of(line):
    return " ".join(line.split())


def pieces_of(line):
    """What stands between the `...` of a line, without the spaces beside them."""
    return re.split(r" ?\.\.\. ?", words_of(line))


def pattern_of(line, within):
    """A line of the book as a pattern: `...` is anything, numbers are groups where they may be off."""
    parts = []
    for piece in pieces_of(line):
        escaped = re.escape(piece)
        if within is not None:
            escaped, last = "", 0
            for number in NUMBER.finditer(piece):
                escaped += re.escape(piece[last : number.start()]) + f"({NUMBER.pattern})"
                last = number.end()
            escaped += re.escape(piece[last:])
        parts.append(escaped)
    return "(?:.*?)".join(parts)


def still(line):
    """A line with the name of its kind in place of whatever moves from run to run."""
    return MOVING.sub(lambda moving: f"<{moving.lastgroup}> ", line)


def same_line(shown, found, within):
    if "..." not in shown:
        shown, found = still(shown), still(found)
    match = re.fullmatch(pattern_of(shown, within), words_of(found))
    if match is None or within is None:
        return match is not None
    numbers = [float(n) for piece in pieces_of(shown) for n in NUMBER.findall(piece)]
    return all(abs(float(f) - s) <= within * abs(s) + 1e-12 for s, f in zip(numbers, match.groups(), strict=True))


def same(shown, found, within=None):
    """Whether lines found are those shown, where `...` alone stands for any number of lines."""
    if not shown:
        return not found
    if shown[0].strip() == "...":
        return any(same(shown[1:], found[i:], within) for i in range(len(found) + 1))
    return bool(found) and same_line(shown[0], found[0], within) and same(shown[1:], found[1:], within)


def lines_of(text):
    """Lines without what is empty at either end."""
    lines = [line.rstrip() for line in text.splitlines()]
    while lines and not lines[0]:
        lines.pop(0)
    while lines and not lines[-1]:
        lines.pop()
    return lines


def chosen(lines, settings):
    """The lines of an output that its block shows: by `head`, `tail` or `lines`, else all of them."""
    parts = {key: settings[key] for key in ("head", "tail", "lines") if key in settings}
    if not parts:
        return lines
    if len(parts) > 1:
        raise Mismatch("one of head, tail, lines")
    ((how, value),) = parts.items()
    first, last = 1, len(lines)
    if how == "head":
        last = int(value)
    elif how == "tail":
        first = last + 1 - int(value)
    else:
        first, last = (int(number) for number in value.split("-"))
    if not 1 <= first <= last <= len(lines):
        raise Mismatch(f"{how}={value} of an output of {len(lines)} lines")
    return lines[first - 1 : last]


def commands(body):
    """Commands of a console block, each with the lines shown below it."""
    found = []
    lines = iter(body.splitlines())
    for line in lines:
        if line.startswith("$ "):
            command = line[2:]
            while command.endswith("\\"):
                command = command[:-1] + next(lines, "").strip()
            found.append((command, []))
        elif not found:
            raise Mismatch("output before the first command")
        else:
            found[-1][1].append(line)
    return found


def shown_of(block):
    """What a block shows of outputs, without commands."""
    if block.language != "console":
        return block.body
    return "\n".join(line for _, shown in commands(block.body) for line in shown)


def refilled(block, outputs):
    """The lines of a block with other outputs below its commands."""
    if block.language != "console":
        return [line + "\n" for line in outputs[0]]
    lines, goes_on = [], False
    outputs = iter(outputs)
    for line in block.raw.splitlines():
        if line.startswith("$ ") or goes_on:
            lines.append(line)
            goes_on = line.endswith("\\")
            if not goes_on:
                lines += next(outputs)
    return [line + "\n" for line in lines]


def replaced(base, keys):
    """A document with other values under some keys; null takes one away. A name with dots leads inside."""
    for name, value in keys.items():
        *path, last = name.split(".")
        place = base
        for key in path:
            place = place[key]
        if value is None:
            place.pop(last, None)
        else:
            place[last] = value
    return base


class Sandbox:
    """A folder with the repository's studies, the program on the path, and one Python."""

    def __init__(self, folder, root, program, python, cache):
        self.folder, self.python = folder, python
        for name in ("studies", "examples"):
            if (root / name).is_dir():
                shutil.copytree(root / name, folder / name)
        self.environment = {
            "PATH": f"{program.parent}:{os.environ['PATH']}",
            "HOME": str(folder),
            "LC_ALL": "C.UTF-8",
            "PONTOON_CACHE_DIR": str(cache),
            # the package, with the extension that scripts/check-book puts there
            "PYTHONPATH": str(root / "crates" / "python"),
            "NO_COLOR": "1",
            "MPLBACKEND": "Agg",
            "COLUMNS": "120",
            # figures: the same bytes from the same numbers
            "SOURCE_DATE_EPOCH": "0",
        }
        (folder / "matplotlibrc").write_text(STYLE)
        self.process, self.number, self.printed = None, 0, None
        # for each block that has been held, by its line: what it should show, command by command
        self.found, self.fills = {}, False

    def close(self):
        if self.process:
            self.process.stdin.close()
            self.process.wait(timeout=20)

    def bash(self, command):
        return subprocess.run(
            ["bash", "-c", command],
            cwd=self.folder,
            env=self.environment,
            capture_output=True,
            text=True,
            timeout=SECONDS,
            check=False,
            stdin=subprocess.DEVNULL,
        )

    def run(self, block):
        """Runs one block; raises Mismatch."""
        printed, self.printed = self.printed, None
        if block.language == "console":
            self.console(block)
        elif block.language == "json":
            self.document(block)
        elif block.language == "python":
            self.printed = self.code(block)
        elif block.language == "text" and "output" in block.words:
            if printed is None:
                raise Mismatch("output of nothing: no python block right before it")
            self.hold(block, block.body.splitlines(), lines_of(printed), "")

    def hold(self, block, shown, found, of):
        """Holds the lines of an output against those that are shown."""
        within = float(block.settings["within"]) if "within" in block.settings else None
        shown, found = lines_of("\n".join(shown)), lines_of("\n".join(found))
        holds = same(shown, found, within)
        self.found.setdefault(block.line, []).append(shown if holds else found)
        if not holds and not self.fills:
            found = "\n".join(found[:60])
            raise Mismatch(f"{of}\n--- shown\n" + "\n".join(shown) + "\n--- found\n" + found)

    def console(self, block):
        all_commands = commands(block.body)
        for i, (command, shown) in enumerate(all_commands):
            last = i + 1 == len(all_commands)
            exit_status = int(block.settings.get("exit", 0)) if last else 0
            done = self.bash(command)
            if done.returncode != exit_status:
                raise Mismatch(
                    f"`{command}`: exit status {done.returncode}, not {exit_status}\n"
                    f"{done.stdout[-2000:]}{done.stderr[-2000:]}"
                )
            text = done.stdout if exit_status in (0, 1) else done.stderr
            found = lines_of(text)
            self.hold(block, shown, chosen(found, block.settings) if last else found, f"`{command}`")

    def code(self, block):
        if self.process is None:
            self.process = subprocess.Popen(
                [str(self.python), "-c", PYTHON],
                cwd=self.folder,
                env=self.environment,
                text=True,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
            )
        self.process.stdin.write(json.dumps({"code": block.body}) + "\n")
        self.process.stdin.flush()
        answer = json.loads(self.process.stdout.readline() or '{"error": "Python is gone"}')
        if answer["error"]:
            raise Mismatch(answer["error"])
        return answer["out"]

    def document(self, block):
        document = json.loads(block.body)
        self.number += 1
        kinds = {"study", "bridge", "reference", "vehicle", "parameters"} & set(block.words)
        if len(kinds) != 1:
            raise Mismatch("json is one of study, bridge, reference, vehicle, parameters")
        kind = kinds.pop()
        if "with" in block.settings:
            base = self.folder / block.settings["with"]
            document = replaced(json.loads(base.read_text()), document)
        else:
            homes = {"bridge": "studies/bridges/x", "vehicle": "studies/vehicles/x"}
            base = self.folder / homes.get(kind, "studies/x/x")
        if "equals" in block.settings:
            kept = json.loads((self.folder / block.settings["equals"]).read_text())
            if document != kept:
                raise Mismatch(f"not what {block.settings['equals']} holds")
        name = f"block-{self.number}.json"
        path = self.folder / block.settings["file"] if "file" in block.settings else base.with_name(name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(block.body if "with" not in block.settings else json.dumps(document, indent=2))
        crossed = path.with_suffix(".crossed.json")
        if kind == "vehicle":
            crossed.write_text(json.dumps(self.crossed_by(path)))
        command = {
            "study": f"pontoon plan '{path}'",
            "vehicle": f"pontoon plan '{crossed}'",
            "bridge": f"pontoon modes '{path}' --model super-element --count 1",
            "reference": f"pontoon compare results/{block.settings.get('results')} --with '{path}'",
            "parameters": "true",
        }[kind]
        done = self.bash(command)
        exits = {int(block.settings["exit"])} if "exit" in block.settings else ({0, 1} if kind == "reference" else {0})
        if done.returncode not in exits:
            raise Mismatch(f"`{command}`: exit status {done.returncode}\n{done.stdout}{done.stderr}")

    def crossed_by(self, vehicle):
        """A study of one crossing by the vehicle of a file."""
        return {
            "name": "crossed",
            "bridge": os.path.relpath(self.folder / "studies/bridges/smoke.json", vehicle.parent),
            "vehicle": vehicle.name,
            "analysis": {"kind": "crossing"},
            "design": [{"grid": {"speed_m_s": 5, "load_n": 1e5}}],
        }


def keep_figures(sandbox, to):
    """Copies the figures that a page's Python has drawn."""
    for figure in sorted(Path(sandbox.folder).glob("*.svg")):
        shutil.copy(figure, to)
