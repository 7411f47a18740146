"""Whether check_book.py finds what is wrong: small books with one fault each must fail, those without it must not."""

import subprocess
import sys
import tempfile
from pathlib import Path

import book_pages
import check_book

CHECK = Path(__file__).with_name("check_book.py")
SUMMARY = "# Summary\n\n[One](one.md)\n"
FENCE = "```"


def block(info, body):
    return f"# One\n\n{FENCE}{info}\n{body}\n{FENCE}\n"


CONNECTORS = """| column | unit | is |
|---|---|---|
| `job` |  | number of the job |
| `joint` |  | number of the joint, from 2: joint k lies at position k |
| `y_m` | m | place of the connector across; null in a joint's row, which adds its connectors |
| `peak_compression_n` | N | largest compression |
| `peak_compression_time_s` | s | its time |
| `peak_tension_n` | N | largest tension |
| `peak_tension_time_s` | s | its time |
"""

SMOKE = (Path(__file__).resolve().parent.parent / "studies/bridges/smoke.json").read_text()

# what is tried, a page that is right, the same with its fault
TRIALS = [
    ("output", block("console", "$ echo 1.25 m\n1.25 m"), block("console", "$ echo 1.25 m\n1.26 m")),
    ("output left out", block("console", "$ seq 3\n1\n...\n3"), block("console", "$ seq 3\n1\n3")),
    (
        "numbers within",
        block("console within=0.01", "$ echo a 1.004\na 1.0"),
        block("console within=0.01", "$ echo a 1.02\na 1.0"),
    ),
    (
        "a duration",
        block("console", "$ echo jobs 21, 1.4 s, about 12 min\njobs 21, 980 ms, about 1 h 20 min"),
        block("console", "$ echo jobs 21, 1.4 s\njobs 22, 980 ms"),
    ),
    ("a speed is no duration", block("console", "$ echo 15 m/s\n15 m/s"), block("console", "$ echo 15 m/s\n14 m/s")),
    (
        "rate, threads, process, size",
        block(
            "console",
            "$ echo 9.5 jobs/s, 2 threads, process 12 on a, 1.7 MB\n1,200 jobs/s, 1 thread, process 7 on b, 210 kB",
        ),
        block("console", "$ echo 9.5 jobs/s, 2 threads\n2 threads, 9.5 jobs/s"),
    ),
    (
        "date, hash, path",
        block(
            "console",
            "$ echo 2026-01-02T03:04:05Z 0123456789abcdef-01234567.pontoon 0123456789ab /tmp/x\n"
            "2025-11-12T13:14:15Z fedcba9876543210-12345678.pontoon 98fe76dc0123 /tmp/y",
        ),
        block("console", "$ echo 2026-01-02 0123456789ab\n2026-01-02 0123"),
    ),
    (
        "a number beside what moves",
        block("console within=0.01", "$ echo 1 s, 100.5 mm\n2 s, 100 mm"),
        block("console within=0.01", "$ echo 1 s, 105 mm\n2 s, 100 mm"),
    ),
    ("a line that is missing", block("console", "$ seq 3\n1\n2\n3"), block("console", "$ seq 3\n1\n3")),
    ("head", block("console head=2", "$ seq 9\n1\n2"), block("console head=2", "$ seq 9\n1\n2\n3")),
    ("tail", block("console tail=2", "$ seq 9\n8\n9"), block("console tail=2", "$ seq 9\n7\n9")),
    ("lines", block("console lines=3-5", "$ seq 9\n3\n4\n5"), block("console lines=3-5", "$ seq 9\n3\n5")),
    (
        "more lines than there are",
        block("console head=3", "$ seq 3\n1\n2\n3"),
        block("console head=4", "$ seq 3\n1\n2\n3"),
    ),
    ("exit status", block("console exit=2", "$ echo no >&2; exit 2\nno"), block("console", "$ exit 2")),
    ("python", block("python", "assert 1 + 1 == 2"), block("python", "assert 1 + 1 == 3")),
    (
        "python's output",
        block("python", "print(2)") + block("text output", "2"),
        block("python", "print(2)") + block("text output", "3"),
    ),
    (
        "a study",
        block("json study with=studies/smoke/study.json", '{ "name": "a" }'),
        block("json study with=studies/smoke/study.json", '{ "nam": "a" }'),
    ),
    (
        "a bridge",
        block("json bridge with=studies/bridges/smoke.json", '{ "modules": 2 }'),
        block("json bridge with=studies/bridges/smoke.json", '{ "modules": 0 }'),
    ),
    (
        "a copy of a file",
        block("json bridge equals=studies/bridges/smoke.json", SMOKE),
        block("json bridge equals=studies/bridges/smoke.json", SMOKE.replace('"modules": 3', '"modules": 2')),
    ),
    (
        "a file that the text names",
        "Save this as `a.json`:\n\n" + block("json parameters file=a.json", "{}"),
        block("json parameters file=a.json", "{}"),
    ),
    (
        "a path that a block makes",
        "`studies/x`\n\n" + block("console", "$ mkdir studies/x"),
        "`studies/x`\n\n" + block("console", "$ mkdir studies/y"),
    ),
    (
        "studies of one name",
        block("json study with=studies/smoke/study.json", '{ "name": "a" }') * 2,
        block("json study with=studies/smoke/study.json", '{ "name": "a" }')
        + block("json study with=studies/smoke/study.json", '{ "name": "a", "question": "?" }'),
    ),
    ("a reason", block('console not-run="no cluster"', "$ false"), block('console not-run=" "', "$ false")),
    ("a language", block("text", "x"), block("xyz", "x")),
    ("Rust", block("rust", "{{#include one.md}}"), block("rust", "fn f() {}")),
    ("a path", "`crates/core/src/lib.rs`", "`crates/core/src/libb.rs`"),
    ("an item", "`crates/core/src/scheme.rs::Scheme::alpha_m`", "`crates/core/src/scheme.rs::Scheme::alpha_x`"),
    ("a link", "[a](one.md)", "[a](two.md)"),
    ("a heading", "# One two\n\n[a](one.md#one-two)", "# One two\n\n[a](one.md#one-three)"),
    (
        "columns",
        "# One\n\n<!-- columns: connectors -->\n" + CONNECTORS + "<!-- end of columns -->\n",
        "# One\n\n<!-- columns: connectors -->\n" + CONNECTORS.replace("| N |", "| m |") + "<!-- end of columns -->\n",
    ),
    ("an include", "{{#include one.md}}", "{{#include two.md}}"),
]


PATCH = """--- a/Cargo.toml
+++ b/Cargo.toml
@@ -1,3 +1,3 @@
-[workspace]
+[workspace] # of all
 resolver = "3"
 members = ["crates/*", "tests"]
"""


def check(pages):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in pages.items():
            path = Path(folder) / name
            path.parent.mkdir(exist_ok=True)
            path.write_text(text)
        done = subprocess.run([sys.executable, CHECK, "--book", folder], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr


def wrong_of_equations():
    """What the check of equations gets wrong."""
    page = book_pages.Page(Path("theory/one.md"), "theory/one.md", "$$ a \\tag{A1} $$\n\n$$ b \\tag{A2} $$\n")
    bare = book_pages.Page(Path("theory/two.md"), "theory/two.md", "$$ a $$\n")
    again = book_pages.Page(Path("theory/two.md"), "theory/two.md", "$$ a \\tag{A1} $$\n")
    both = {"A1": "a.rs:1", "A2": "a.rs:2"}
    trials = [
        ("right", [page], both, 0),
        ("an equation without a number", [page, bare], both, 1),
        ("a number twice", [page, again], both, 1),
        ("an equation that is not cited", [page], {"A1": "a.rs:1"}, 1),
        ("a citation of none", [page], both | {"A3": "a.rs:3"}, 1),
    ]
    found = [
        (what, check_book.faults_of_equations({str(i): page for i, page in enumerate(pages)}, cited), count)
        for what, pages, cited, count in trials
    ]
    return [f"equations, {what}: {faults}" for what, faults, count in found if len(faults) != count]


def main():
    wrong = wrong_of_equations()
    trials = [
        (what, {"SUMMARY.md": SUMMARY, "one.md": right}, {"SUMMARY.md": SUMMARY, "one.md": fault})
        for what, right, fault in TRIALS
    ]
    trials.append(
        (
            "a page of the summary",
            {"SUMMARY.md": SUMMARY, "one.md": "# One"},
            {"SUMMARY.md": SUMMARY, "one.md": "# One", "two.md": "# Two"},
        )
    )
    trials.append(
        (
            "a patch",
            {"SUMMARY.md": SUMMARY, "one.md": "# One", "a.patch": PATCH},
            {"SUMMARY.md": SUMMARY, "one.md": "# One", "a.patch": PATCH.replace("-[workspace]", "-[workspac]")},
        )
    )
    guide = {"SUMMARY.md": SUMMARY.replace("one.md", "guide/one.md")}
    trials.append(
        (
            "the guide leaves nothing open",
            guide | {"guide/one.md": block("console head=1", "$ seq 3\n1")},
            guide | {"guide/one.md": block("console", "$ seq 3\n1\n...")},
        )
    )
    for what, right, fault in trials:
        status, said = check(right)
        if status != 0:
            wrong.append(f"{what}: a page that is right is refused: {said}")
        status, said = check(fault)
        if status != 1:
            wrong.append(f"{what}: its fault passes (exit status {status}): {said}")
    print("\n".join(wrong) if wrong else f"the checker finds {len(trials)} of {len(trials)} faults made for it")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
