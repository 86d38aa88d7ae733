"""All pictures of a study's surfaces, each drawn by whoever has time, and handed back as files."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from io import BytesIO
from pathlib import Path
from typing import Literal

import xarray as xr
from PIL import Image

from comparison.execution.sweep import sweep
from comparison.execution.task import Task, fingerprint
from comparison.report.figures.budget import budget_figure_name, draw_budget
from comparison.report.figures.file_names import with_ending
from comparison.report.figures.pairs import draw_pair, figure_name
from comparison.report.figures.paper import draw_paper_figure, paper_figure_name
from comparison.study.models import Pair
from comparison.study.selection import EVERYTHING, Selection
from comparison.study.study import Study
from reference.problem import Outcome, Scene

SECONDS = {"pair": 0.45, "budget": 0.6, "paper": 1.0}  # of drawing one, recorded beside `Model.seconds_per_point`
PAGE = ".webp"
SHOWN = ["mu", "error", "stride", "recorded"]  # of the surfaces: what pictures are made of


@dataclass(frozen=True)
class Picture:
    """
    One picture of a scene: a pair of models or the budget, of one body; or all bodies in the manner of the paper.

    study, surfaces: those of the scene alone.
    """

    kind: Literal["pair", "budget", "paper"]
    study: Study
    surfaces: xr.Dataset
    body: int = 0
    pair: Pair | None = None

    @property
    def scene(self) -> Scene:
        return self.study.scenes[0]


Files = tuple[tuple[str, bytes], ...]  # names and contents


def pictures(study: Study, surfaces: xr.Dataset, selection: Selection = EVERYTHING) -> list[Picture]:
    """Every picture of the selected sections: a scene without phases has no surfaces."""
    found = []
    for scene in study.phased:
        silent = {scene.name: (study.silent or {}).get(scene.name, ())}
        alone = replace(study, scenes=(scene,), costs=None, silent=silent)
        shown = surfaces[SHOWN].sel(scene=[scene.name])
        with_surfaces, with_budget = (selection.has(section, scene.name) for section in ("surfaces", "budget"))
        if with_surfaces:
            found.append(Picture("paper", alone, shown))
        for body in range(1, len(scene.bodies) + 1):
            if with_surfaces:
                found += [Picture("pair", alone, shown, body, pair) for pair in study.pairs(scene)]
            if with_budget:
                found.append(Picture("budget", alone, shown, body))
    return found


def picture_tasks(study: Study, surfaces: xr.Dataset, selection: Selection = EVERYTHING) -> list[Task]:
    """The same as tasks for the workers."""
    about = {scene.name: fingerprint(surfaces[SHOWN].sel(scene=[scene.name])) for scene in study.scenes}
    return [
        Task("pictures", drawn, picture, SECONDS[picture.kind], about[picture.scene.name], compiled=False)
        for picture in pictures(study, surfaces, selection)
    ]


def drawn(picture: Picture) -> Files:
    """The files of one picture. Runs inside a worker process."""
    study, surfaces, scene, body = picture.study, picture.surfaces, picture.scene, picture.body
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if picture.kind == "paper":
            draw_paper_figure(folder / paper_figure_name(scene), study, surfaces, scene)
        elif picture.kind == "budget":
            draw_budget(folder / budget_figure_name(scene, body), study, surfaces, scene, body)
        else:
            assert picture.pair is not None
            draw_pair(folder / figure_name(scene, body, picture.pair), surfaces, scene, body, picture.pair)
        files = [(file.name, file.read_bytes()) for file in sorted(folder.iterdir())]
    if picture.kind != "paper":  # what the page shows
        files += [(for_page(name), smaller(content)) for name, content in files]
    return tuple(files)


def for_page(name: str) -> str:
    """Name of a picture as the page holds it."""
    return with_ending(Path(name), PAGE).name


def smaller(png: bytes) -> bytes:
    """The same picture to the last dot in half the bytes."""
    found = BytesIO()
    with Image.open(BytesIO(png)) as picture:
        picture.convert("RGB").save(found, "WEBP", lossless=True, quality=20, method=1)  # hardly smaller with more
    return found.getvalue()


def all_drawn(
    study: Study,
    surfaces: xr.Dataset,
    jobs: int,
    executor: Callable[[int], Executor],
    selection: Selection = EVERYTHING,
) -> dict[str, bytes]:
    """Every file of every picture by its name, drawn on `executor(jobs)`; what fails there is drawn here."""
    asked = pictures(study, surfaces, selection)
    found = sweep(asked, drawn, _lost, lambda picture, files: None, jobs, executor)
    return {name: content for picture, files in zip(asked, found) for name, content in files or drawn(picture)}


def _lost(picture: Picture, outcome: Outcome, error_message: str) -> Files:
    return ()
