"""
The table that docs/evidence.md opens with: `python docs/evidence_table.py` writes it anew.

Measured rows come from what `python -m comparison.validation FOLDER` recorded. The others are the checks that a report
lists: `python docs/evidence_table.py --measure [WORD]` runs their tests, or those whose names hold a word, and keeps in
evidence.json what each found.
"""

from __future__ import annotations

import json
import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree

from comparison.analyses.validation.table import recorded
from comparison.report.verification import CHECKS, Check

PAGE, STORE = Path(__file__).with_name("evidence.md"), Path(__file__).with_name("evidence.json")
TESTS = PAGE.parent.parent / "tests"
BEGIN, END = "<!-- written by evidence_table.py -->\n", "<!-- end -->\n"
HEAD = "| claim | independent check | result | limit | repeated by | at |\n|---|---|---|---|---|---|\n"
MEASURED = (  # experiment and quantity of rows that lead the table
    ("frame, 450 g", "share of time at rest"),
    ("frame, 450 g", "half range"),
    ("pendulum, decay", "turning point 10"),
    ("pendulum, large angles", "half period at 1.5 rad"),
)


def measured_rows() -> list[str]:
    """One row for each quantity of MEASURED: the comparison error of both codes against u_val."""
    stored = recorded()
    commit = stored.run["provenance"]["commit"][:7]
    known = {(each.experiment, each.name): each for each in stored.quantities}
    rows = []
    for key in MEASURED:
        each = known[key]
        sides = [each.sides[name] for name in ("equations", "engine")]
        found = ", ".join(f"{side.error:+.2g}" for side in sides)
        limit = f"u<sub>val</sub> = {sides[0].validation:.2g} {each.unit}; {sides[0].verdict}"
        claim = f"both codes meet the measured {each.name}, {each.experiment}, {each.measured:.4g} {each.unit}"
        rows.append(
            f"| {claim} | measurement ({each.use}) | E = {found} {each.unit} (equations, engine) | {limit} "
            f"| `comparison.validation FOLDER` | {commit} |"
        )
    return rows


def measure(word: str) -> None:
    """Run the tests of the checks and keep the value of each that is nearest to its limit, with commit and day."""
    chosen = [check for check in CHECKS if word in check.test]
    names = [f"{TESTS / check.file}::{check.test}" for check in chosen]
    with TemporaryDirectory() as folder:
        found = Path(folder, "found.xml")
        run = [sys.executable, "-m", "pytest", "-q", "-n0", "-m", "long or not long", f"--junitxml={found}"]
        subprocess.run([*run, "-o", "junit_family=xunit1", *names], check=True)
        cases = list(ElementTree.parse(found).iter("testcase"))
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], check=True, capture_output=True, text=True)
    at = {"commit": commit.stdout.strip(), "date": f"{datetime.now(UTC):%Y-%m-%d}"}
    store = json.loads(STORE.read_text(encoding="utf-8")) if STORE.exists() else {}
    for check in chosen:
        own = [case for case in cases if case.get("name", "").split("[")[0] == check.test]
        texts = [each.get("value", "") for case in own for each in case.iter("property")]
        value, limit = max(
            (tuple(map(float, text.split(" of "))) for text in texts), key=lambda pair: pair[0] / pair[1]
        )
        store[check.test] = {"value": value, "limit": limit, **at}
    STORE.write_text(json.dumps(store, indent=1) + "\n", encoding="utf-8")


def row(check: Check) -> str:
    """One row; a limit of 1 is that of an error which each value states."""
    claims = {"reference": "the equations are solved", "engine": "the engine's model is solved"}
    found = json.loads(STORE.read_text(encoding="utf-8")).get(check.test)
    if found is None:
        test = f"`{check.file}::{check.test}`"
        return f"| {claims[check.side]} | {check.against} | within | {check.closeness} | {test} | every night |"
    result = f"{found['value']:.2g} of it" if found["limit"] == 1.0 else f"{found['value']:.1e}"
    return (
        f"| {claims[check.side]} | {check.against} | {result} | {check.closeness} "
        f"| `{check.file}::{check.test}` | {found['commit']}, {found['date']} |"
    )


def table() -> str:
    """The table in Markdown."""
    return HEAD + "\n".join([*measured_rows(), *map(row, CHECKS)]) + "\n"


def with_table(page: str) -> str:
    """The text of the page with the table in its place."""
    before, rest = page.split(BEGIN)
    return before + BEGIN + table() + END + rest.split(END)[1]


if __name__ == "__main__":
    if "--measure" in sys.argv[1:2]:
        measure("".join(sys.argv[2:]))
    PAGE.write_text(with_table(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
