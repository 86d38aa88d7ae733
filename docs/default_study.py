"""
What pages say of the default study, from one record.

    python docs/default_study.py REPORT    records the report of `python -m comparison.run`, and rewrites the pages
    python docs/default_study.py           rewrites the pages from the record

A page has a passage between `<!-- default study: NAME -->` and `<!-- end -->`; NAME is a key of PASSAGES.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter

from comparison.registry import FEATURES, StudyResults
from comparison.report.page import word_measurements
from comparison.surfaces.headline import Headline
from comparison.surfaces.statements import CELL_WORDINGS, word_verdict
from comparison.wording import percent, signed

DOCS = Path(__file__).parent
RECORD = DOCS / "default_study.json"
MARKED = re.compile(r"(<!-- default study: ([\w-]+) -->\n).*?(<!-- end -->)", re.DOTALL)
GRID = 16  # phases per axis that every model of the default study has
READINGS = (  # of mu_1: pair, and what it is in words
    ("supremum-total", "small equations, literal supremum → Exudyn (spatial)"),
    ("total", "small equations, as integrated → Exudyn (spatial)"),
    ("translational", "small equations, as integrated → Exudyn (translational)"),
    ("reading", "small equations: literal supremum → as integrated"),
    ("geometry-supremum", "geometry: small → exact equations, literal suprema"),
    ("geometry", "geometry: small → exact equations, as integrated"),
    ("geometry-regularized", "geometry: small → exact equations, both regularized"),
    ("regularized-friction-small", "regularized friction: small equations"),
    ("regularized-friction", "regularized friction: exact equations"),
)


def record(report: Path) -> dict[str, Any]:
    """Return what pages need of the report of a default study."""
    summary = json.loads((report / "summary.json").read_text(encoding="utf-8"))
    results = StudyResults.model_validate(summary)
    leads = {
        each.key: each.section.lead(results)
        for each in FEATURES
        if each.section and each.section.lead and each.section.is_present(results)
    }
    kept = ("body", "pair", "first", "second", "base", "reading", "mean", "numerical_error", "sampling_error")
    rows = [
        {"scene": scene["name"], **{name: row[name] for name in kept}, "grids": row["grids"]}
        for scene in summary["scenes"]
        for row in (*scene["differences"], *scene["effects"])
    ]
    return {
        "command": "python -m comparison.run",
        "commit": summary["run"]["provenance"].get("commit", ""),
        "measured": word_measurements(results),
        "verdict": word_verdict([h for s in results.scenes for h in s.headlines], word_measurements(results)),
        "leads": leads,
        "headlines": [line for scene in summary["scenes"] for line in scene["headlines"]],
        "rows": rows,
    }


def headlines(known: Mapping[str, Any]) -> list[Headline]:
    """Return the recorded headlines."""
    return TypeAdapter(list[Headline]).validate_python(known["headlines"])


def answers(known: Mapping[str, Any]) -> str:
    """Return the table of the first screen."""
    lines = [
        "| scene | body | Exudyn against the paper's equations, as integrated: mean, range | causes | "
        "same equations and friction law | literal supremum above as integrated: mean, largest |",
        "|---|---|---|---|---|---|",
    ]
    for line in headlines(known):
        cells = (CELL_WORDINGS.causes(line), CELL_WORDINGS.agreement(line), CELL_WORDINGS.supremum(line))
        size = f"**{CELL_WORDINGS.difference(line)}** {CELL_WORDINGS.range(line)}"
        lines.append(f"| `{line.scene}` | {line.name} | {size} | {' | '.join(cells)} |")
    return "\n".join(lines)


def readings(known: Mapping[str, Any]) -> str:
    """Return mean and largest difference of mu_1 between models, in both readings, on the grid that all have."""
    scenes = [name for name in dict.fromkeys(row["scene"] for row in known["rows"]) if name != "fig4-viscous"]
    rows = {(row["scene"], row["pair"]): row for row in known["rows"] if row["body"] == 1}
    lines = [
        f"| μ₁, second against first, mean (largest size) over {GRID} × {GRID} phases | {' | '.join(scenes)} |",
        "|---" * (1 + len(scenes)) + "|",
    ]
    for pair, words in READINGS:
        cells = []
        for scene in scenes:
            (grid,) = (each for each in rows[scene, pair]["grids"] if each["phases_per_axis"] == GRID)
            cells.append(f"{signed(grid['mean'])} ({percent(grid['maximum'])})")
        lines.append(f"| {words} | {' | '.join(cells)} |")
    return "\n".join(lines)


PASSAGES: Mapping[str, Callable[[Mapping[str, Any]], str]] = {
    "answer": lambda known: f"{known['verdict']} {known['leads']['claims']}",
    "conditioning": lambda known: known["leads"]["conditioning"],
    "answers": answers,
    "readings": readings,
}


def with_passages(text: str, known: Mapping[str, Any]) -> str:
    """Return the text of a page with its passages from the record."""
    return MARKED.sub(lambda found: f"{found[1]}{PASSAGES[found[2]](known)}\n{found[3]}", text)


def pages() -> list[Path]:
    """Return the pages that have passages."""
    every = [*DOCS.parent.glob("*.md"), *DOCS.rglob("*.md")]
    return [page for page in every if MARKED.search(page.read_text(encoding="utf-8"))]


if __name__ == "__main__":
    if len(sys.argv) > 1:
        RECORD.write_text(json.dumps(record(Path(sys.argv[1])), ensure_ascii=False, indent=1) + "\n", encoding="utf-8")
    recorded = json.loads(RECORD.read_text(encoding="utf-8"))
    for page in pages():
        page.write_text(with_passages(page.read_text(encoding="utf-8"), recorded), encoding="utf-8")
