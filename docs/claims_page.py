"""
Write docs/claims.md and its pictures: what the paper's figures are and are not consistent with.

    python docs/claims_page.py [--search N] [--jobs N] [--out DIR]

computes the tables of `python -m comparison.claims`, counts on finer grids and a search of N other readings. Results in
DIR.tiles are not computed again.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from dataclasses import replace
from importlib import resources
from pathlib import Path

from claims_literal import PHASES, STEPS, LiteralClaims, Spike, spike_over_the_step
from claims_pictures import draw_reading, draw_spike
from claims_search import RANGES, SEARCH_GRID, Selection, best_readings, searched_readings
from claims_settled import GRIDS, Settled, Settling
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from PIL import Image

from comparison.analyses.claims.evidence import without_value
from comparison.analyses.claims.readings import CASES, LIGHT_BODY, LITERAL, OWN_PERIOD, READINGS, Reading
from comparison.analyses.claims.table import GRID, RECORD, SIGNS, ClaimTable
from comparison.analyses.effective_values.analysis import forced_ratios
from comparison.json_file import json_text
from comparison.runner.cache import Cache, store_beside
from comparison.runner.processes import cores, process_pool
from comparison.runner.runner import Runner, compiling_task
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from reference.problem import builtin_scenes, load_scene

FOLDER = Path(__file__).parent
DRAWN = 32  # phases per axis of the pictures
PRINTED = next(reading for reading in READINGS if replace(reading, reason="") == Reading(1.0))
AMPLITUDES = (0.6, 1.0, 1.5)  # m/s^2, of the literal reading
SEARCHED = 96
COLORS = 32  # of a picture: lines on white
PICTURES = (
    ("print", PRINTED, "The parameters as printed"),
    ("light-body", LIGHT_BODY, "The reading that reproduces most"),
    ("own-period", OWN_PERIOD, "The reading close to resonance"),
    ("literal", LITERAL, "The spike counted"),
)

Compute = Callable[[Sequence[Task]], TaskResults]


def main() -> None:
    """Compute, draw and write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--search", type=int, default=SEARCHED, metavar="N")
    parser.add_argument("--jobs", type=int, default=cores(), metavar="N")
    parser.add_argument("--out", type=Path, default=Path("report"), metavar="DIR")
    options = parser.parse_args()
    study = Study(tuple(map(load_scene, builtin_scenes())), GRID, 1e-3)
    results = TaskResults(Cache(store_beside(options.out)))

    def compute(tasks: Sequence[Task]) -> TaskResults:
        Runner(results, options.jobs, process_pool).run(tasks, compiling_task)
        return results

    def tabled(grid: int, readings: Sequence[Reading]) -> ClaimTable:
        claims = LiteralClaims(grid, readings)
        table = claims.collect(study, None, compute(claims.tasks(study)))
        assert table is not None
        return table

    settling = Settling()
    settled = settling.collect(study, None, compute(settling.tasks(study))) or []
    readings = searched_readings(options.search)
    searched = tabled(SEARCH_GRID, readings)
    selection = Selection(searched, tabled(GRID, best_readings(searched, readings)))
    spike = draw(compute)
    record(tabled(GRID, [replace(LITERAL, amplitude=amplitude) for amplitude in AMPLITUDES]))
    (FOLDER / "claims.md").write_text(page(study, tabled(GRID, READINGS), spike, settled, selection), encoding="utf-8")


def record(table: ClaimTable) -> None:
    """Write the verdicts of the literal readings for `python -m comparison.claims` and the report."""
    verdicts = {
        f"{amplitude:g}": {f"{c.figure}: {c.says}": (c.verdicts[k].finding, c.verdicts[k].found) for c in table.claims}
        for k, amplitude in enumerate(AMPLITUDES)
    }
    place = resources.files("comparison.analyses.claims") / RECORD
    Path(str(place)).write_text(json_text(verdicts), encoding="utf-8")


def draw(compute: Compute) -> Spike:
    """The pictures of the readings and of the spike; the spike at 1 m/s^2."""
    claims = LiteralClaims(DRAWN)
    cases = [case for case in CASES if " " not in case]  # with both bodies
    tasks = {(name, case): claims.task(case, reading) for name, reading, _ in PICTURES for case in cases}
    spikes = {
        amplitude: Task(spike_over_the_step, replace(LITERAL, amplitude=amplitude), "claims", 0.5)
        for amplitude in AMPLITUDES
    }
    results = compute([*tasks.values(), *spikes.values()])
    for name, reading, _ in PICTURES:
        evidence = {case: results.value(tasks[name, case], without_value) for case in cases}
        draw_reading(FOLDER / f"claims-{name}.png", reading.name, evidence)
    drawn = {amplitude: results[task].value for amplitude, task in spikes.items()}
    draw_spike(FOLDER / "claims-spike.png", drawn)
    for path in FOLDER.glob("claims-*.png"):
        with Image.open(path) as picture:
            smaller = picture.convert("RGB").quantize(COLORS, dither=Image.Dither.NONE)
        smaller.save(path, optimize=True)
    return drawn[LITERAL.amplitude]


def page(study: Study, table: ClaimTable, spike: Spike, settled: Sequence[Settled], selection: Selection) -> str:
    """The text of docs/claims.md."""
    templates = Environment(
        loader=FileSystemLoader(FOLDER), trim_blocks=True, undefined=StrictUndefined, keep_trailing_newline=True
    )
    places = {name: table.readings.index(reading.name) for name, reading, _ in PICTURES}
    return templates.get_template("claims.md.j2").render(
        table=table,
        held=table.reproduced,
        spike=spike,
        last_step=STEPS[-1],
        printed=places["print"],
        light=places["light-body"],
        own=places["own-period"],
        literal=places["literal"],
        searched=OWN_PERIOD.searched,
        proven=[claim for claim in table.claims if claim.proof],
        signs=SIGNS,
        ratios=[(scene.name, each) for scene in study.scenes for each in forced_ratios(scene)],
        phases=PHASES,
        grids=GRIDS,
        settled=settled,
        selection=selection,
        ranges=RANGES,
        pictures=PICTURES,
    )


if __name__ == "__main__":
    main()
