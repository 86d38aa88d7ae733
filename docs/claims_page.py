"""
Write docs/claims.md from docs/claims.json: what the paper says about its figures, in the two readings of (5.1).

    python docs/claims_page.py [--measure]

--measure computes the table of `phase-resonance claims` again, keeps it in claims.json with its commit, and draws
the surfaces. The search and the literal (4.6) in claims.json were recorded by an earlier version and stay as they are.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image
from pydantic import TypeAdapter

from comparison.evidence.claims.evidence import CaseInReading, gather_evidence
from comparison.evidence.claims.peaks_and_valleys import MAX_SHARE, MIN_SHARE
from comparison.evidence.claims.readings import READINGS, STATEMENT_CASES, PeakReading, effective_reading
from comparison.evidence.claims.table import CLAIMS_GRID, Claims, ClaimTable, word_claims
from comparison.evidence.forced_ratios import compute_forced_ratios
from comparison.json_file import format_json
from comparison.runner.environment import describe_provenance
from comparison.runner.task import execute_task
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from comparison.surfaces.figures.paper import PRINT_STYLE, draw_surface
from comparison.verdicts import MET
from reference.problem import builtin_scenes, load_scene

FOLDER = Path(__file__).parent
RECORD = FOLDER / "claims.json"
GRIDS = 16, CLAIMS_GRID, 32, 48, 64  # phases per axis on which the statements are counted
DRAWN = 32  # phases per axis of the pictures
RESOLUTION, COLORS = 110, 32  # dots per inch, and shades of a picture of lines on white
PANELS = (("fig3-I", "3", "ab"), ("fig3-II", "3", "cd"), ("fig4-dry", "4", "ab"), ("fig4-viscous", "4", "cd"))
TABLE = TypeAdapter(ClaimTable)


def compute_table(grid: int = CLAIMS_GRID) -> ClaimTable:
    """Return the table that `phase-resonance claims --grid GRID` prints, in this process."""
    study, claims, results = Study(tuple(map(load_scene, builtin_scenes())), 1, 1e-3), Claims(grid), TaskResults()
    for task in claims.tasks(study):
        results.put(task, execute_task(task))
    table = claims.collect(study, None, results)
    assert table is not None, "the study has every scene of the paper"
    return table


def numbers_met(table: ClaimTable) -> dict[str, int]:
    """Return how many statements are met, by name of the reading."""
    return {name: counts[MET] for name, counts in table.counts.items()}


def grids_line(met: Mapping[str, Mapping[str, int]]) -> str:
    """Return whether the numbers of statements met depend on the grid; met: by phases per axis and reading."""
    *grids, last = met
    if all(met[grid] == met[last] for grid in grids):
        return f"As many statements are met on {', '.join(grids)} and {last} phases per axis."
    words = (f"{' and '.join(f'{number} {name}' for name, number in each.items())} on {n}" for n, each in met.items())
    return f"The numbers of statements met depend on the phases per axis: {', '.join(words)}."


def draw_reading(path: Path, reading: PeakReading) -> None:
    """Write the eight surfaces of Figures 3 and 4 in one reading, PNG."""
    with mpl.rc_context(PRINT_STYLE):
        figure = Figure(figsize=(11.0, 6.2))
        FigureCanvasAgg(figure)
        figure.suptitle(f"Figures 3 and 4, parameters as printed, {reading.name}", fontsize=10.0, y=0.985)
        for column, (case, number, letters) in enumerate(PANELS):
            surfaces = gather_evidence(
                CaseInReading(case, effective_reading(reading, STATEMENT_CASES[case]()), DRAWN)
            ).mu
            phase = 2.0 * np.pi * np.arange(DRAWN + 1) / DRAWN
            for row, name in enumerate((r"$\mu_1$", r"$\mu_2$")):
                mu = np.pad(surfaces[..., row], ((0, 1), (0, 1)), mode="wrap")
                place = (0.018 + 0.247 * column, 0.01 + 0.475 * (1 - row), 0.225, 0.45)
                axes = figure.add_axes(place, projection="3d")
                draw_surface(axes, phase, mu, (float(mu.min()), float(mu.max())), name)
                axes.set_title(f"Fig. {number}{letters[row]}: {name}", y=1.0, fontsize=9.0)
        figure.savefig(path, dpi=RESOLUTION)
    with Image.open(path) as picture:
        smaller = picture.convert("RGB").quantize(COLORS, dither=Image.Dither.NONE)
    smaller.save(path, optimize=True)


def render_page(record: dict[str, Any]) -> str:
    """Return the text of docs/claims.md from the content of claims.json."""
    templates = Environment(
        loader=FileSystemLoader(FOLDER), trim_blocks=True, undefined=StrictUndefined, keep_trailing_newline=True
    )
    table = TABLE.validate_python(record["table"])
    ratios = {each.axis: each for each in compute_forced_ratios(load_scene("fig3-I"))}
    return templates.get_template("claims.md.j2").render(
        record=record,
        table=table,
        line=word_claims(table),
        grids_line=grids_line(record["met_by_grid"]),
        readings=READINGS,
        shares=(MIN_SHARE, MAX_SHARE),
        ratios=ratios,
    )


def main() -> None:
    """Compute and draw where asked for, and write the page."""
    record = json.loads(RECORD.read_text(encoding="utf-8"))
    if "--measure" in sys.argv[1:]:
        record |= {
            "commit": describe_provenance()["commit"][:8],
            "table": TABLE.dump_python(compute_table(), mode="json"),
            "met_by_grid": {str(grid): numbers_met(compute_table(grid)) for grid in GRIDS},
        }
        RECORD.write_text(format_json(record), encoding="utf-8")
        for reading in READINGS:
            draw_reading(FOLDER / f"claims-{reading.name.replace(' ', '-')}.png", reading)
    (FOLDER / "claims.md").write_text(render_page(record), encoding="utf-8")


if __name__ == "__main__":
    main()
