"""Analysis that draws the pictures of a study's surfaces: each is a task whose result is its files."""

import tempfile
from dataclasses import replace
from functools import partial
from pathlib import Path

import xarray as xr

from comparison.runner.analysis import Analysis
from comparison.runner.attempts import attempt
from comparison.runner.task import Task, describe_contents
from comparison.runner.task_results import TaskResults
from comparison.study.models import Pair
from comparison.study.selection import Selection
from comparison.study.study import Study
from comparison.surfaces.figures.file_names import name_figure_file

DRAWN_VARIABLES = ["mu", "error", "stride", "recorded"]  # variables of surfaces.nc that pictures are drawn from


NamedFiles = tuple[tuple[str, bytes], ...]  # names and contents of files
# Arguments of a task that draws a picture: kind ("total" or "paper"), study of one scene, surfaces of this scene, body
# and pair of models (0 and None for "paper", which shows all bodies)
PictureArguments = tuple[str, Study, xr.Dataset, int, Pair | None]


class Pictures(Analysis[dict[str, bytes]]):
    """Analysis that draws the pictures of the report; its result is the content of each picture file by name."""

    key, stage, needs_surfaces = "pictures", "pictures", True
    seconds = 3.0

    def tasks(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
        """Return one task for each picture of the selected sections; a scene without phases has no surfaces."""
        assert surfaces is not None, "they are what is drawn"
        tasks = []
        for scene in study.phased:
            alone = replace(study, scenes=(scene,), selection=Selection())
            shown = surfaces[DRAWN_VARIABLES].sel(scene=[scene.name])
            bodies = range(1, len(scene.bodies) + 1)
            pictures: list[PictureArguments] = []
            if study.selection.has("surfaces", scene.name):
                pictures.append(("paper", alone, shown, 0, None))
                totals = [pair for pair in study.pairs(scene) if pair.key == "total"]
                pictures += [("total", alone, shown, body, pair) for body in bodies for pair in totals]
            about = describe_contents(shown)
            tasks += [
                Task(draw_picture, each, self.stage, about=about, needs_compiled_reference=False) for each in pictures
            ]
        return tasks

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> dict[str, bytes]:
        """Return the picture files by name; one that no worker drew is tried here, and left out where that raises."""
        files: dict[str, bytes] = {}
        for task in self.tasks(study, surfaces):
            draw = partial(results.value, task, lambda picture, *failure: draw_picture(picture))
            kind, one, _, body, _ = task.argument
            name = f"picture of {one.scenes[0].name}, {f'body {body}' if body else kind},"
            files |= dict(attempt(name, draw) or ())
        return files


def draw_picture(picture: PictureArguments) -> NamedFiles:
    """Draw one picture and return the names and contents of its files. Runs inside a worker process."""
    from comparison.surfaces.figures import pairs, paper  # Plotting libraries are loaded only where a picture is drawn.

    kind, study, surfaces, body, pair = picture
    (scene,) = study.scenes
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if kind == "paper":
            paper.draw_paper_figure(folder / name_figure_file(scene.name, "paper"), study, surfaces, scene)
        else:
            assert pair is not None
            pairs.draw_pair(folder / name_figure_file(scene.name, f"body{body}", pair.key), surfaces, scene, body, pair)
        return tuple((file.name, file.read_bytes()) for file in sorted(folder.iterdir()))
