"""`python -m comparison.tradeoff --growth`: cost against bodies, duration, phase pairs and workers, with slopes."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Executor

from rich.console import Console

from comparison.analyses.tradeoff.growth import PICTURE, SCHEMA, STORED, Growth, MeasuredGrowth, Series, with_slope
from comparison.analyses.tradeoff.measure import Measurement, measure, sample
from comparison.cli.computing import computed, run_facts
from comparison.cli.terminal import new_table
from comparison.runner.executors import Pool, cores
from comparison.runner.output import made_by
from comparison.runner.processes import process_pool
from comparison.study.models import EXACT
from comparison.study.study import Study
from reference.problem import Scene

FILES = (STORED.name, PICTURE, "growth.pdf")
TOLERANCE = 1e-3  # of a study; every measurement has one of its own
CALLS, PAIRS = 16, 64  # of the equations, shared by the workers


def measured_growth(
    scene: Scene, options: argparse.Namespace, words: Sequence[str], console: Console, executor: Pool
) -> MeasuredGrowth:
    """All series of a scene with what is known of their run; stored ones are not measured again, but for workers."""
    begin = time.monotonic()
    growth, study = Growth(), Study((scene,), 1, TOLERANCE)
    tasks = growth.tasks(study)
    models = {task.argument.function[0] for task in tasks}
    results = computed("tradeoff", options, words, tasks, models, console, executor)
    series = [*growth.collect(study, None, results), by_workers(scene, process_pool)]
    return MeasuredGrowth(SCHEMA, scene.name, scene.title, series, run_facts("tradeoff", options, words, begin))


def by_workers(scene: Scene, pool: Callable[[int], Executor], most: int | None = None) -> Series:
    """Wall time of the same calls of the equations with 1, 2, 4 ... workers of this machine."""
    most = most or cores()
    counts = sorted({*(2**n for n in range(most.bit_length()) if 2**n <= most), most})
    settings = {**EXACT.settings, "tolerance": 1e-6}
    call = Measurement(scene, (EXACT.amplification, settings), 0, sample(PAIRS))
    seconds = []
    for workers in counts:
        with pool(workers) as executor:
            list(executor.map(measure, [call] * 2 * workers))  # every worker is warm
            begin = time.monotonic()
            list(executor.map(measure, [call] * CALLS))
            seconds.append(time.monotonic() - begin)
    return with_slope("workers", "", EXACT.title, list(map(float, counts)), seconds)


def growth_files(growth: MeasuredGrowth) -> dict[str, bytes]:
    """Table and figure."""
    from comparison.analyses.tradeoff.figure import draw_growth  # plotting: not needed to refuse

    return {STORED.name: STORED.as_json(growth), **made_by(lambda folder: draw_growth(folder / PICTURE, growth.series))}


def print_growth(console: Console, series: Sequence[Series]) -> None:
    """A row for every value, with the slope of its series."""
    table = new_table("quantity", "model", "value", "s", "slope")
    for each in series:
        slope = "" if each.slope is None else f"{each.slope:.2f} ± {each.uncertainty:.2f}"
        for place, (value, seconds) in enumerate(zip(each.values, each.seconds)):
            known = "no answer" if seconds is None else f"{seconds:.3g}"
            last = place == len(each.values) - 1
            table.add_row(each.quantity, each.model, f"{value:g}", known, slope if last else "")
    console.print(table)
