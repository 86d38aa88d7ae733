"""
Speed for accuracy: `python -m comparison.tradeoff [SCENE ...] [--quick] [--out DIR]`.

Measures the error of mu_i against compute time per point, for every model and every numerical parameter, and writes
tradeoff.json, in which other scenes stay, SCENE-tradeoff.nc and SCENE-tradeoff.png. Exit codes: 0 done; 2 a wrong scene
or option; 3 the files could not be written; others as in `run_command`.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import xarray as xr
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table

from comparison.analysis.tradeoff.measure import Task, measured, tasks
from comparison.analysis.tradeoff.trade import FILE, Trade, as_json, load
from comparison.cli.arguments import CommandParser, command, jobs, writing
from comparison.execution.executors import Pool
from comparison.execution.output import destination, made_by, publish, refuse_foreign_files
from comparison.execution.processes import process_pool
from comparison.execution.progress import Stage, progress, wide_console
from comparison.execution.provenance import provenance
from comparison.execution.resume import command_line
from comparison.report.figures.file_names import figure_file, with_ending
from comparison.study.study import refuse_same_names
from reference.problem import Scene, SceneError, load_scene
from reference.problem.command import UsageError

DEFAULT = "fig3-I"
COMMAND = "comparison.tradeoff"
ENDINGS = "png", "pdf", "nc"  # of the files of a scene
STARTING = 8.0  # s of a worker before its first task: imports, compiled code loaded


@command
def main(argv: Sequence[str], executor: Pool = process_pool) -> int:
    """Measure the scenes of the command line; the exit code."""
    options = _parser().parse_args(argv)
    width = jobs(options)
    scenes = [_phased(name) for name in options.scenes or [DEFAULT]]
    refuse_same_names((scene.name, scene.name) for scene in scenes)
    out = destination(options.out)
    _stored(out)  # a file that is no trade is refused before anything is measured
    pictures = [figure_file(scene.name, "tradeoff", ending=f".{end}") for scene in scenes for end in ENDINGS]
    refuse_foreign_files(out, [FILE, *pictures])
    console = wide_console()
    trades = []
    for scene in scenes:
        trade, data = watched(scene, options.quick, width, console, argv, executor)
        trades.append(trade)
        with writing(out):
            publish(out, _files(trade, data), COMMAND)
    before = {trade.scene: trade for trade in _stored(out)}
    kept = list((before | {trade.scene: trade for trade in trades}).values())
    with writing(out):
        (file,) = publish(out, {FILE: as_json(kept)}, COMMAND)
    for trade in trades:
        print_trade(console, trade)
    console.print(f"Trade: {file}, and SCENE-tradeoff.png and .nc beside it.", soft_wrap=True)
    return 0


def _phased(name: str) -> Scene:
    scene = load_scene(name)
    if scene.recorded:
        rule = "reference solutions need phases, which a recorded motion has not: give a scene of two frequencies"
        raise SceneError(name, "excitation.record", scene.name, rule)
    return scene


def _stored(out: Path) -> list[Trade]:
    """The trades that are in the folder. Raises UsageError for a file that is none."""
    try:
        return load(out) or []
    except (OSError, ValueError) as error:
        raise UsageError(str(error)) from None


def watched(
    scene: Scene, quick: bool, jobs: int, console: Console, words: Sequence[str], executor: Pool
) -> tuple[Trade, xr.Dataset]:
    """The trade of a scene, measured under a display of what is done and left."""
    planned = {id(task): (task, seconds) for task, seconds in tasks(scene, quick)}
    stages: dict[str, Stage] = {}
    for task, seconds in planned.values():
        stage = stages.get(_stage(task), Stage(0, 0.0))
        stages[_stage(task)] = Stage(stage.points + len(task.phases), stage.seconds + seconds)
    began, begin = datetime.now(UTC), time.monotonic()
    about = STARTING + sum(stage.seconds for stage in stages.values()) / jobs
    console.print(f"{scene.title} ({scene.name}): about {about:.0f} s with {jobs} workers.")
    run: dict[str, Any] = {
        "command": command_line(words, "tradeoff"),
        "began": began.isoformat(timespec="seconds"),
        "jobs": jobs,
        "quick": quick,
        "provenance": provenance(),
    }
    with progress(console, stages, jobs) as display:
        trade, data = measured(
            scene, quick, jobs, run, lambda task: display.advance(_stage(task), len(task.phases)), executor
        )
    run["seconds"] = round(time.monotonic() - begin, 1)
    return trade, data


def _stage(task: Task) -> str:
    path, given = task.function
    if "scipy" in path:
        return f"SciPy {given['method']}"
    if "constant" in path:
        return "engine at constant step"
    return "reference" if "reference" in path else f"{given['model']} engine"


def _files(trade: Trade, data: xr.Dataset) -> dict[str, bytes]:
    """Values and pictures of one scene."""
    from comparison.report.figures.tradeoff import draw_tradeoff, tradeoff_figure_name  # plotting: not needed to refuse

    picture = tradeoff_figure_name(trade.scene)
    return made_by(
        lambda folder: data.to_netcdf(with_ending(folder / picture, ".nc"), engine="h5netcdf"),
        lambda folder: draw_tradeoff(folder / picture, trade),
    )


def print_trade(console: Console, trade: Trade) -> None:
    """The fronts: what to take for which accuracy; and how each reference solution was checked."""
    for question in trade.questions:
        console.print(f"{trade.scene}, {question.title}: {question.points} phase pairs", style="bold")
        console.print(
            f"  reference solution: {question.reference_solution}; {'; '.join(question.checks)}", soft_wrap=True
        )
        table = Table(box=SIMPLE_HEAD, pad_edge=False)
        table.add_column("on the Pareto front of a mu", no_wrap=True)
        for heading in ("value", "s per point", "median error", "95 %"):
            table.add_column(heading, justify="right", no_wrap=True)
        for entry in sorted(trade.of(question.key), key=lambda one: one.seconds):
            if any(entry.pareto_front):
                sizes = ("  ".join(f"{part:.0e}" for part in parts) for parts in (entry.median, entry.most))
                value = f"{entry.value:.0e} {entry.unit}".strip()
                table.add_row(entry.method, value, f"{entry.seconds:.4f}", *sizes)
        console.print(table)


def _parser() -> CommandParser:
    parser = CommandParser(
        "tradeoff", "Error of mu_i against compute time for every model and every numerical parameter."
    )
    parser.add_scenes(DEFAULT)
    parser.add_out("where the files go")
    parser.add_jobs()
    parser.add_argument("--quick", action="store_true", help="fewer points and values: under a minute")
    return parser
