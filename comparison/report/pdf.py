"""report.pdf: two to five pages for a client or a supplement, typeset by typst, which is an optional extra."""

import json
import shutil
import tempfile
from collections.abc import Sequence
from importlib import resources
from importlib.util import find_spec
from math import isfinite
from pathlib import Path

from comparison.analyses.ensemble.feature import draw_profiles
from comparison.analyses.worst_phases.analysis import nearest_search
from comparison.report.drawings import drawn, map_task
from comparison.report.pdf_data import largest_headlines, pdf_data, short_title, size_of
from comparison.report.results import Results
from comparison.report.scene_result import SceneResult
from comparison.report.section import Report
from comparison.runner.task import Task
from comparison.study.models import Model
from comparison.surfaces.headline import Headline

MAX_MAPS = 4  # scenes
TEMPLATE = "report.typ"


def why_no_pdf() -> str:
    """Why report.pdf cannot be made and what helps, "" if it can."""
    if find_spec("typst") is None:
        return "report.pdf needs the package typst: pip install typst"
    return ""


def write_pdf(path: Path, report: Report) -> None:
    """Write report.pdf, the same bytes for the same results, with the scenes and bodies of the largest differences."""
    import typst  # an optional extra

    results, shown = report.results, largest_headlines(report.results)
    maps = [(about, drawn(report, task)[0][1]) for about, task in map_tasks(report)]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        source = resources.files("comparison.report") / "templates" / TEMPLATE
        with resources.as_file(source) as template:
            shutil.copy(template, folder / TEMPLATE)
        for number, (_, content) in enumerate(maps):
            (folder / f"map{number}.svg").write_bytes(content)
        data = pdf_data(results, shown, [{**about, "file": f"map{n}.svg"} for n, (about, _) in enumerate(maps)])
        if data["ensemble"] and data["ensemble"]["drawn"]:
            draw_profiles(folder / "ensemble.svg", results.of("ensemble"))
        (folder / "data.json").write_text(json.dumps(data, ensure_ascii=False), encoding="utf-8")
        typst.compile(str(folder / TEMPLATE), output=str(path), root=str(folder))


def map_tasks(report: Report) -> list[tuple[dict[str, str], Task]]:
    """Title, note and task of the maps of the scenes with phases that have the largest differences."""
    results = report.results
    largest: dict[str, list[Headline]] = {}
    for headline in sorted(largest_headlines(results), key=size_of, reverse=True):
        largest.setdefault(headline.scene, []).append(headline)
    study, tasks = report.study, []
    phased = [name for name in largest if any(scene.name == name for scene in study.phased)][:MAX_MAPS]
    for scene, result in zip(study.scenes, results.scenes):
        if scene.name not in phased or "surfaces" not in result.analyses:
            continue
        models = study.compared(scene)
        second = _engine(models, result)
        if second is models[0]:
            continue
        bodies = sorted(headline.body for headline in largest[scene.name][:2])
        counts = [result.models[model.key] for model in (models[0], second)]
        sizes = [f"{c.phases_per_axis} × {c.phases_per_axis}, {c.computed} computed" for c in counts]
        note = f"{models[0].title}: {sizes[0]}; {second.title}: {sizes[1]}. "
        note += f"The {len(bodies)} bodies with the largest differences of {result.bodies}. " * (
            result.bodies > len(bodies)
        )
        note += "; ".join(_highest(results, result, model, body) for body in bodies for model in (models[0], second))
        about = {"title": short_title(result), "note": f"{note}."}
        tasks.append((about, map_task(report, scene, (models[0], second), bodies)))
    return tasks


def _highest(results: Results, scene: SceneResult, model: Model, body: int) -> str:
    """The largest mu of a model on its grid, and over all phases by the search of this model or of one near it."""
    count = scene.models[model.key].phases_per_axis
    grid = next(each.mu for each in scene.grid_maxima if (each.model, each.body) == (model.key, body))
    largest = f"{grid:.4g} of {count} × {count} phases" if isfinite(grid) else "none"
    worst = nearest_search(results.of("worst_phases") or (), [*scene.models], scene.name, model.key, body)
    titles = {each.key: each.title for each in results.models}
    where = "" if worst is None or worst.model == model.key else f" by the {titles[worst.model]}"
    over = "not searched over all phases" if worst is None else f"{worst.value:.4g} over all phases{where}"
    return f"largest μ_{body}, {model.title}: {largest}, {over}"


def _engine(models: Sequence[Model], result: SceneResult) -> Model:
    """The engine model with the most phases, of several the last; one that is no surface only if there is no other."""
    engines = [model for model in models if model.side == "engine"] or [models[-1]]
    refused = {completion.model for completion in result.completions if not completion.accepted}
    drawn = [model for model in engines if model.key not in refused] or engines
    return max(reversed(drawn), key=lambda model: result.models[model.key].phases_per_axis)
