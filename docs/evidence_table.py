"""
The table that docs/evidence.md opens with: `python docs/evidence_table.py` writes it anew.

Measured rows come from what `python -m comparison.validation FOLDER` recorded, the others from the checks that a report
lists, which the tests of every commit repeat.
"""

from __future__ import annotations

from pathlib import Path

from comparison.analyses.validation.table import recorded
from comparison.report.verification import CHECKS

PAGE = Path(__file__).with_name("evidence.md")
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


def table() -> str:
    """The table in Markdown."""
    claims = {"reference": "the equations are solved", "engine": "the engine's model is solved"}
    tests = [
        f"| {claims[check.side]} | {check.against} | within | {check.closeness} "
        f"| `{check.file}::{check.test}` | every commit or night |"
        for check in CHECKS
    ]
    return HEAD + "\n".join([*measured_rows(), *tests]) + "\n"


def with_table(page: str) -> str:
    """The text of the page with the table in its place."""
    before, rest = page.split(BEGIN)
    return before + BEGIN + table() + END + rest.split(END)[1]


if __name__ == "__main__":
    PAGE.write_text(with_table(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
