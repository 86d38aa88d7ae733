"""Drawings of what the analyses say: made by the workers, kept like every result, and drawn here if that failed."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import xarray as xr

from comparison.analyses.assumptions.variations import Cell
from comparison.report.findings import Findings
from comparison.runner.task import Task
from comparison.study.models import Model
from comparison.surfaces.completion import Completion
from comparison.surfaces.figures.file_names import assumption_figure_name
from comparison.surfaces.figures.pictures import SHOWN, Files, Pictures
from reference.problem import Scene


@dataclass(frozen=True)
class PrintMaps:
    """The maps of a scene for report.pdf; the fields are the arguments of `draw_maps`."""

    surfaces: xr.Dataset
    scene: Scene
    models: tuple[Model, Model]
    bodies: Sequence[int]
    completed: Sequence[Completion]


@dataclass(frozen=True)
class AssumptionFigure:
    """How far the assumptions carry in a scene."""

    scene: Scene
    cells: Sequence[Cell]


def map_task(findings: Findings, scene: Scene, models: tuple[Model, Model], bodies: Sequence[int]) -> Task:
    """The maps of two models of a scene."""
    completed = [surface for surface in findings.completions if surface.scene == scene.name]
    shown = findings.surfaces[SHOWN].sel(scene=[scene.name])
    return _task(draw_print_maps, PrintMaps(shown, scene, models, tuple(bodies), completed))


def assumption_tasks(findings: Findings) -> list[Task]:
    """One figure for each scene whose assumptions were varied."""
    if findings.assumptions is None:
        return []
    cells = findings.assumptions.cells
    return [_task(draw_assumption_figure, AssumptionFigure(scene, cells)) for scene in findings.assumptions.scenes]


def drawn(findings: Findings, task: Task) -> Files:
    """The files of a task: from its worker, or drawn now."""
    files: Files = findings.drawings.get(task.key) or task.function(task.argument)
    return files


def draw_print_maps(maps: PrintMaps) -> Files:
    """One SVG. Runs inside a worker process."""
    from comparison.surfaces.figures import print_maps  # matplotlib: only a worker that draws needs it

    content = print_maps.draw_maps(maps.surfaces, maps.scene, maps.models, maps.bodies, maps.completed)
    return (("maps.svg", content),)


def draw_assumption_figure(figure: AssumptionFigure) -> Files:
    """PNG and PDF. Runs inside a worker process."""
    from comparison.analyses.assumptions import figure as assumptions  # likewise

    with tempfile.TemporaryDirectory() as name:
        place = Path(name) / assumption_figure_name(figure.scene)
        assumptions.draw_assumptions(place, figure.scene, figure.cells)
        return tuple((file.name, file.read_bytes()) for file in sorted(Path(name).iterdir()))


def _task(function: object, argument: object) -> Task:
    return Task(function, argument, Pictures.stage, needs_compiled_reference=False)  # type: ignore[arg-type]
