"""All pictures of a study's surfaces, each drawn by whoever has time, and handed back as files."""

from __future__ import annotations

import base64
import tempfile
from dataclasses import dataclass, replace
from io import BytesIO
from pathlib import Path
from typing import Literal

import xarray as xr

from comparison.runner.analysis import Analysis
from comparison.runner.task import Task, fingerprint
from comparison.runner.task_results import TaskResults
from comparison.study.analyses import EVERYTHING
from comparison.study.models import Pair
from comparison.study.study import Study
from comparison.surfaces.figures.file_names import figure_file
from reference.problem import Scene

SHOWN = ["mu", "error", "stride", "recorded"]  # of the surfaces: what pictures are made of


@dataclass(frozen=True)
class Picture:
    """One picture of a scene, with the study and the surfaces of that scene alone."""

    kind: Literal["pair", "budget", "paper"]
    study: Study
    surfaces: xr.Dataset
    body: int = 0
    pair: Pair | None = None

    @property
    def scene(self) -> Scene:
        """The scene that is drawn."""
        return self.study.scenes[0]


Files = tuple[tuple[str, bytes], ...]  # names and contents


def pictures(study: Study, surfaces: xr.Dataset) -> list[Picture]:
    """Every picture of the selected sections: a scene without phases has no surfaces."""
    listed = []
    for scene in study.phased:
        alone = replace(study, scenes=(scene,), selection=EVERYTHING)
        shown = surfaces[SHOWN].sel(scene=[scene.name])
        with_surfaces, with_budget = (study.selection.has(section, scene.name) for section in ("surfaces", "budget"))
        if with_surfaces:
            listed.append(Picture("paper", alone, shown))
        for body in range(1, len(scene.bodies) + 1):
            if with_surfaces:
                listed += [Picture("pair", alone, shown, body, pair) for pair in study.pairs(scene)]
            if with_budget:
                listed.append(Picture("budget", alone, shown, body))
    return listed


class Pictures(Analysis[dict[str, bytes]]):
    """Every file of every picture by its name."""

    key, stage, needs_surfaces = "pictures", "pictures", True

    def tasks(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
        """One task for each picture."""
        assert surfaces is not None, "they are what is drawn"
        about = {scene.name: fingerprint(surfaces[SHOWN].sel(scene=[scene.name])) for scene in study.scenes}
        return [
            Task(drawn, picture, self.stage, about=about[picture.scene.name], needs_compiled_reference=False)
            for picture in pictures(study, surfaces)
        ]

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> dict[str, bytes]:
        """The files; a picture that no worker could draw is drawn here, for the page refers to it."""
        tasks = self.tasks(study, surfaces)
        return {
            name: content
            for task in tasks
            for name, content in results.value(task, lambda picture, *failure: drawn(picture))
        }


def drawn(picture: Picture) -> Files:
    """The files of one picture. Runs inside a worker process."""
    from comparison.surfaces.figures import budget, pairs, paper  # plotting: not needed to list what is drawn

    study, surfaces, scene, body = picture.study, picture.surfaces, picture.scene, picture.body
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if picture.kind == "paper":
            paper.draw_paper_figure(folder / figure_file(scene.name, "paper"), study, surfaces, scene)
        elif picture.kind == "budget":
            budget.draw_budget(folder / figure_file(scene.name, f"body{body}", "budget"), study, surfaces, scene, body)
        else:
            assert picture.pair is not None
            path = folder / figure_file(scene.name, f"body{body}", picture.pair.key)
            pairs.draw_pair(path, surfaces, scene, body, picture.pair)
        return tuple((file.name, file.read_bytes()) for file in sorted(folder.iterdir()))


def smaller(png: bytes) -> bytes:
    """The same picture to the last dot in half the bytes."""
    from PIL import Image  # as in `drawn`

    found = BytesIO()
    with Image.open(BytesIO(png)) as picture:
        picture.convert("RGB").save(found, "WEBP", lossless=True, quality=20, method=1)  # hardly smaller with more
    return found.getvalue()


def inlined(webp: bytes) -> str:
    """A picture inside the page."""
    return "data:image/webp;base64," + base64.b64encode(webp).decode()
