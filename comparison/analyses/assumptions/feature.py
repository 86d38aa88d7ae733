"""How far the assumptions of the paper carry: in the report."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from comparison.analyses.assumptions.validity import Assumptions, Validity, uneven_lines
from comparison.analyses.assumptions.variations import AssumptionCell, ValidityRange, ranges
from comparison.report.drawings import drawing_task, drawn
from comparison.report.section import Feature, Report, Section
from comparison.runner.task import Task
from comparison.surfaces.figures.file_names import figure_file
from comparison.surfaces.figures.pictures import Files, inlined, smaller
from reference.problem import Scene


@dataclass(frozen=True)
class AssumptionFigure:
    """How far the assumptions hold in a scene."""

    scene: Scene
    cells: Sequence[AssumptionCell]


def draw_assumption_figure(figure: AssumptionFigure) -> Files:
    """PNG and PDF. Runs inside a worker process."""
    from comparison.analyses.assumptions.figure import draw_assumptions  # matplotlib: only a worker that draws needs it

    with tempfile.TemporaryDirectory() as name:
        draw_assumptions(Path(name) / figure_name(figure.scene), figure.scene, figure.cells)
        return tuple((file.name, file.read_bytes()) for file in sorted(Path(name).iterdir()))


def figure_name(scene: Scene) -> str:
    """File name of the figure of one scene."""
    return figure_file(scene.name, "assumptions")


def _varied(report: Report) -> list[tuple[Scene, Sequence[AssumptionCell]]]:
    """The scenes whose assumptions were varied, with their cells."""
    found: Validity | None = report.results.of("assumptions")
    cells = found.cells if found else ()
    of_scenes = [(scene, [cell for cell in cells if cell.scene == scene.name]) for scene in report.study.scenes]
    return [(scene, of_scene) for scene, of_scene in of_scenes if of_scene]


def _tasks(report: Report) -> list[Task]:
    """One figure for each scene whose assumptions were varied."""
    return [drawing_task(draw_assumption_figure, AssumptionFigure(*pair)) for pair in _varied(report)]


def _draw(figures: Path, report: Report) -> None:
    for task in _tasks(report):
        for name, content in drawn(report, task):
            (figures / name).write_bytes(content)


def _table(listed: Sequence[ValidityRange]) -> list[dict[str, Any]]:
    """A row for each body and share, with the range of each quantity that was varied."""
    rows: dict[tuple[int, float], dict[str, Any]] = {}
    for each in listed:
        row = rows.setdefault((each.body, each.share), {"body": each.body, "share": each.share, "cells": {}})
        row["cells"][each.key] = _range(each)
    return list(rows.values())


def _range(each: ValidityRange) -> str:
    """The values for which a body stays within the share, in a few words."""
    wide = each.key == "ring"  # the smaller ring changes more; of all else the larger value
    if each.holds is None:
        return "no value tried"
    limit = f"{'≥' if wide else '≤'} {each.holds:.3g}"
    return f"{limit} (all tried)" if each.fails is None else f"{limit}, not {each.fails:.3g}"


def _context(report: Report, figures: Path) -> Mapping[str, Any]:
    pictures = [
        {
            "title": scene.title,
            "name": scene.name,
            "picture": inlined(smaller((figures / figure_name(scene)).read_bytes())),
            "ranges": _table(ranges([scene], cells)),
            "lines": uneven_lines(scene, cells),
        }
        for scene, cells in _varied(report)
    ]
    return {"assumption_pictures": pictures}


FEATURE = Feature(
    "assumptions",
    Validity,
    "how far the paper's assumptions hold; null without a spatial model",
    analysis=Assumptions(),
    section=Section(
        "How far the paper's assumptions hold",
        "no scene with phases says where its supports are and how high and large its bodies, as the spatial model asks",
        _context,
        _tasks,
        _draw,
    ),
)
