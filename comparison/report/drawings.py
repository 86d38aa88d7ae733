"""Drawings of a report: made by the workers, kept like every result, and drawn here if that failed."""

from collections.abc import Callable, Sequence
from typing import Any

import xarray as xr

from comparison.report.section import Report
from comparison.runner.task import Task
from comparison.study.models import Model
from comparison.surfaces.completion import Completion
from comparison.surfaces.figures.pictures import SHOWN, Files, Pictures
from reference.problem import Scene

# surfaces, scene, its two models, bodies, completed surfaces: what `draw_maps` takes
PrintMaps = tuple[xr.Dataset, Scene, tuple[Model, Model], Sequence[int], Sequence[Completion]]


def map_task(report: Report, scene: Scene, models: tuple[Model, Model], bodies: Sequence[int]) -> Task:
    """The maps of two models of a scene."""
    completed = [surface for surface in report.completions if surface.scene == scene.name]
    shown = report.surfaces[SHOWN].sel(scene=[scene.name])
    return drawing_task(draw_print_maps, (shown, scene, models, tuple(bodies), completed))


def drawing_task(function: Callable[[Any], Files], argument: object) -> Task:
    """A drawing for a worker."""
    return Task(function, argument, Pictures.stage, needs_compiled_reference=False)


def drawn(report: Report, task: Task) -> Files:
    """The files of a task: from its worker, or drawn now."""
    files: Files = report.drawings.get(task.key) or task.function(task.argument)
    return files


def draw_print_maps(maps: PrintMaps) -> Files:
    """One SVG. Runs inside a worker process."""
    from comparison.surfaces.figures import print_maps  # matplotlib: only a worker that draws needs it

    return (("maps.svg", print_maps.draw_maps(*maps)),)
