"""How far the assumptions of the paper carry: in the report."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from comparison.analyses.assumptions.validity import AssumptionCell, Assumptions, Validity, uneven_lines
from comparison.report.drawings import drawing_task, drawn
from comparison.report.section import Feature, Report, Section
from comparison.runner.output import made_by
from comparison.runner.task import Task
from comparison.surfaces.figures.file_names import figure_file
from comparison.surfaces.figures.pictures import Files, inlined, smaller
from reference.problem import Scene


def draw_assumption_figure(varied: tuple[Scene, Sequence[AssumptionCell]]) -> Files:
    """PNG and PDF of a scene and its cells. Runs inside a worker process."""
    from comparison.analyses.assumptions.figure import draw_assumptions  # matplotlib: only what draws needs it

    scene, cells = varied
    return tuple(made_by(lambda folder: draw_assumptions(folder / figure_name(scene), scene, cells)).items())


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
    return [drawing_task(draw_assumption_figure, pair) for pair in _varied(report)]


def _draw(figures: Path, report: Report) -> None:
    for task in _tasks(report):
        for name, content in drawn(report, task):
            (figures / name).write_bytes(content)


def _context(report: Report, figures: Path) -> Mapping[str, Any]:
    pictures = []
    for scene, cells in _varied(report):
        picture, lines = inlined(smaller((figures / figure_name(scene)).read_bytes())), uneven_lines(scene, cells)
        pictures.append({"title": scene.title, "name": scene.name, "picture": picture, "lines": lines})
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
