#!/usr/bin/python3
"""The figures in the docs, and the file that they come from: benchmarks/reference/figures.csv.

A number of a page that stands before a mark is a figure of `encounter bench`:

    | impact, N | 0.57<!--session.impact_N.p50--> | ... |
    22.4<!--tracking.rmse.x.20 least *1e3-->     its least over seeds, a thousand times: the page's unit is another

The number keeps the decimals that the page writes. Behind each table of figures stands a digest of its other numbers,
such as those of the paper, so that none changes by mistake. A table that no default run measures names the commit that
measured it:

    *Kept by hand; measured at 1a2b3c4.*<!--table 5f3a9c-->

    docs/figures.py                          says which numbers are not those of the file; exit code 1 if there are any
    docs/figures.py write                    puts the file's numbers into the pages
    docs/figures.py keep PAGE:LINE [COMMIT]  renews the digest of the table in that line; COMMIT: it is kept by hand
    docs/figures.py take results.json [COMMIT]   takes the figures of a default run (bench --out) into the file
"""
import csv
import hashlib
import json
import pathlib
import re
import subprocess
import sys

NUMBER = r"[-−+]?\d+(?:\.\d+)?(?:e[-−]?\d+)?"
MARK = re.compile(rf"({NUMBER})<!--([a-z][\w.]*?)(?: (least|most))?(?: \*([\d.e-]+))?-->")
BEHIND = re.compile(r"^(?:\*(?:K|In part k)ept by hand; measured at ([0-9a-f]{7,40})\.\*)?<!--table ([0-9a-f]{6})-->$")
SEPARATOR = re.compile(r"^\|[-| :]+\|$")
COLUMNS = ["id", "unit", "value", "least", "most", "low", "high", "commit"]
NOTE = "# Figures of the last default run of `encounter bench`, four digits each; docs/figures.py writes this file and the docs.\n"


def pages(root):
    """The README, and what the experiments gave. The guides and docs/sources have other numbers."""
    return [root / "README.md"] + sorted(page for part in ("notes", "reference") for page in (root / "docs" / part).glob("*.md"))


def figures(root):
    path = root / "benchmarks/reference/figures.csv"
    if not path.exists():
        return {}
    with path.open(encoding="utf-8") as lines:
        rows = csv.DictReader(line for line in lines if not line.startswith("#"))
        return {row["id"]: row for row in rows}


def as_written(value, like):
    """The value in the form of the page's number: its decimals, its power of ten, its minus."""
    mantissa, _, power = like.replace("−", "-").partition("e")
    value /= 10.0 ** int(power or 0)
    decimals = len(mantissa.partition(".")[2])
    text = f"{value:.{decimals}f}"
    if float(text) == 0.0:
        text = text.lstrip("-")
    if like.startswith("+") and not text.startswith("-"):
        text = "+" + text
    return text.replace("-", "−") + ("e" + power if power else "")


def wanted(match, known):
    """The number that should stand there, or None with what is wrong."""
    number, name, which, factor = match.groups()
    row = known.get(name)
    if row is None:
        return None, f"'{name}' is no figure of benchmarks/reference/figures.csv; expected one of its ids; name one"
    cell = row[which or "value"]
    if cell == "":
        return None, f"'{name}' has no {which or 'value'}; expected one in benchmarks/reference/figures.csv; name another"
    return as_written(float(cell) * float(factor or 1), number), ""


def tables(lines):
    """First and one past the last line of each table."""
    first = 0
    while first < len(lines):
        if not lines[first].startswith("|"):
            first += 1
            continue
        last = first
        while last < len(lines) and lines[last].startswith("|"):
            last += 1
        yield first, last
        first = last


def digest(rows):
    numbers = re.findall(r"\d+(?:\.\d+)?", re.sub(r"<!--.*?-->", "", MARK.sub("", "\n".join(rows))))
    return hashlib.sha256(" ".join(numbers).encode()).hexdigest()[:6]


def has_figures(rows):
    """Whether half of the cells behind the first column begin with a number: a table of figures."""
    cells = [cell.strip() for row in rows[2:] for cell in row.strip("|").split("|")[1:]]
    measured = [cell for cell in cells if re.match(r"^[*<>≤≥~±+−-]*\s*\d", cell)]
    return len(measured) >= 4 and 2 * len(measured) >= len([c for c in cells if c])


def faults_of(page, text, known):
    lines = text.split("\n")
    for number, line in enumerate(lines, 1):
        for match in MARK.finditer(line):
            right, wrong = wanted(match, known)
            if right is None:
                yield f"{page}:{number}:{match.start(2) + 1}: {wrong}."
            elif right != match.group(1):
                yield f"{page}:{number}:{match.start() + 1}: '{match.group(1)}' is not the figure {match.group(2)}; expected {right}; run docs/figures.py write."
    for first, last in tables(lines):
        rows = lines[first:last]
        behind = BEHIND.match(next((line for line in lines[last:last + 2] if line), ""))
        if behind and behind.group(2) != digest(rows):
            measured = f"what commit {behind.group(1)} measured" if behind.group(1) else "what it was"
            yield f"{page}:{first + 1}:1: a number of this table is not {measured}; expected the digest {behind.group(2)}; undo it, or run docs/figures.py keep {page}:{first + 1} with the commit that measured it."
        if not behind and has_figures(rows):
            yield f"{page}:{first + 1}:1: the numbers of this table have no digest; expected one behind it; mark its figures (docs/figures.py), and run docs/figures.py keep {page}:{first + 1}."


def check(root):
    known = figures(root)
    faults = [fault for page in pages(root) for fault in faults_of(page.relative_to(root), page.read_text(encoding="utf-8"), known)]
    print("\n".join(faults), end="\n" if faults else "")
    return 1 if faults else 0


def write(root):
    known = figures(root)

    def replaced(match):
        right, _ = wanted(match, known)
        return match.group(0) if right is None else right + match.group(0)[len(match.group(1)):]

    for page in pages(root):
        before = page.read_text(encoding="utf-8")
        after = MARK.sub(replaced, before)
        if after != before:
            page.write_text(after, encoding="utf-8")
    return check(root)


def keep(root, place, commit=""):
    name, line = place.rsplit(":", 1)
    page = root / name
    lines = page.read_text(encoding="utf-8").split("\n")
    found = [(first, last) for first, last in tables(lines) if first < int(line) <= last]
    if not found:
        sys.exit(f"{place}:1: there is no table; expected a line of one; name another.")
    first, last = found[0]
    kept = "In part kept" if any(MARK.search(row) for row in lines[first:last]) else "Kept"
    said = f"*{kept} by hand; measured at {commit}.*" if commit else ""
    said += f"<!--table {digest(lines[first:last])}-->"
    behind = last + 1 if last + 1 < len(lines) and lines[last] == "" else last
    if behind < len(lines) and BEHIND.match(lines[behind]):
        lines[behind] = said
    else:
        lines[last:last] = ["", said]
    page.write_text("\n".join(lines), encoding="utf-8")
    return 0


def digits(value):
    return "" if value is None else f"{value:.4g}"


def take(root, results, commit=""):
    run = json.loads(pathlib.Path(results).read_text(encoding="utf-8"))
    if re.search(r" --(quick|full|seed|repeats|rig|set)", run["command"]) or run["set"]:
        sys.exit(f"{results}:1:1: '{run['command']}' is no default run; expected one without options; run it again.")
    git = ["git", "-C", str(root), "rev-parse", "--short=7", "HEAD"]
    commit = commit or run.get("commit") or subprocess.run(git, check=True, capture_output=True, text=True).stdout.strip()
    known = figures(root)
    measured = {benchmark["name"] for benchmark in run["benchmarks"]}
    known = {name: row for name, row in known.items() if name.split(".")[0] not in measured}
    for benchmark in run["benchmarks"]:
        for f in benchmark["figures"]:
            known[f["id"]] = {"id": f["id"], "unit": f["unit"], "value": digits(f["twin"]), "least": digits(f["least"]), "most": digits(f["most"]), "low": digits(f["low"]), "high": digits(f["high"]), "commit": commit[:7]}
    with (root / "benchmarks/reference/figures.csv").open("w", encoding="utf-8", newline="") as out:
        out.write(NOTE)
        table = csv.DictWriter(out, COLUMNS, lineterminator="\n")
        table.writeheader()
        table.writerows(known[name] for name in sorted(known))
    return 0


def main(words):
    root = pathlib.Path(__file__).resolve().parent.parent
    if words[:1] == ["--root"]:
        root, words = pathlib.Path(words[1]), words[2:]
    commands = {(): check, ("write",): write, ("keep",): keep, ("take",): take}
    command = commands.get(tuple(words[:1]))
    if command is None or len(words) not in {check: [0], write: [1], keep: [2, 3], take: [2, 3]}[command]:
        sys.exit(__doc__)
    return command(root, *words[1:])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
