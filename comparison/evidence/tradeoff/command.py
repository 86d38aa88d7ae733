"""
Error against compute time: `phase-resonance tradeoff [SCENE ...] [--quick | --growth] [--out DIR]`.

Exit codes: 0 done; 2 a wrong scene or option; 3 the files could not be written; others as in `run_command`.
"""

import argparse
import time
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from rich.console import Console

from comparison.cli.arguments import CommandParser, command, read_number_of_jobs, write_and_show
from comparison.cli.computing import collect_run_facts, compute_tasks
from comparison.cli.terminal import make_table
from comparison.cli.user_models import add_models, load_user_models
from comparison.evidence.tradeoff import growth
from comparison.evidence.tradeoff.analysis import STAGE, TradeOff
from comparison.evidence.tradeoff.growth import CostGrowth, CostSeries, MeasuredGrowth, measure_by_workers
from comparison.evidence.tradeoff.settings import (
    CONSTANT_STEP_RUN,
    ENGINE,
    ENGINE_LEVEL,
    REFERENCE,
    REFERENCE_RUN,
    SCIPY_FACTORS,
)
from comparison.evidence.tradeoff.trade import FILE, SCHEMA, STORED, MeasuredTrade, SceneTrade, TradeFile, load_trades
from comparison.runner.attempts import publish_attempted
from comparison.runner.output import encode_netcdf, publish_files, refuse_foreign_files, resolve_destination
from comparison.runner.processes import Pool, make_process_pool
from comparison.runner.progress import make_wide_console
from comparison.study.study import refuse_same_names
from comparison.surfaces.figures.file_names import name_figure_file
from reference.problem import Scene, SceneError, load_scene
from reference.support.command import UsageError

DEFAULT_SCENE = "fig3-I"  # name of the scene that is measured if the command line names none
COMMAND = "comparison.tradeoff"  # name of the command, as the manifest (list of written files) states it
WORKER_START_SECONDS = 8.0  # s for the start of workers (imports, compiled code), added to the estimated run time
# Import paths of the functions that worker processes call
WORKER_FUNCTIONS = {REFERENCE, ENGINE, REFERENCE_RUN, ENGINE_LEVEL, CONSTANT_STEP_RUN, SCIPY_FACTORS}


@command
def main(argv: Sequence[str], executor: Pool = make_process_pool) -> int:
    """Measure error against compute time for the scenes of the command line; return the exit code."""
    parser = CommandParser(
        "tradeoff", "Error of mu_i against compute time for every model and every numerical parameter."
    )
    parser.add_scenes(DEFAULT_SCENE)
    parser.add_out("where the files go")
    parser.add_computing()
    parser.add_argument(
        "--growth",
        action="store_true",
        help="instead: cost against bodies, duration, phase pairs and workers, with slopes",
    )
    add_models(parser)
    parser.add_argument("--quick", action="store_true", help="fewer points and values: under a minute")
    options = parser.parse_args(argv)
    read_number_of_jobs(options)  # a wrong number of jobs is refused before the scenes are read
    names = options.scenes or [DEFAULT_SCENE]
    scenes = [_load_harmonic_scene(name) for name in names]
    refuse_same_names((name, scene.name) for name, scene in zip(names, scenes))
    out = resolve_destination(options.out)
    _load_trades(out)  # raises an error for another file of this name before anything is measured
    written = [growth.FILE] if options.growth else [FILE, *(_values_file(each.name) for each in scenes)]
    refuse_foreign_files(out, written)
    console = make_wide_console()
    if options.growth:
        return _measure_cost_growth(scenes[0], options, argv, out, console, executor)
    measured = measure_trades(scenes, options, argv, console, executor)

    def write() -> list[Path]:
        """Write all errors and times, with those of earlier runs, and a file of amplifications for each scene."""
        trades = {trade.scene: trade for trade in [*_load_trades(out), *(each.trade for each in measured)]}
        files = publish_files(out, {FILE: STORED.as_json(TradeFile(SCHEMA, list(trades.values())))}, COMMAND)
        for each in measured:
            publish_attempted(out, _values_file(each.trade.scene), partial(encode_netcdf, each.values), COMMAND)
        return files

    def show() -> None:
        """Print the measured errors and compute times of every scene."""
        for each in measured:
            print_trade(console, each.trade)

    (file,) = write_and_show(out, write, show)
    console.print(f"Trade: {file}, and SCENE-tradeoff.nc next to it.", soft_wrap=True)
    return 0


def _measure_cost_growth(
    scene: Scene, options: argparse.Namespace, words: Sequence[str], out: Path, console: Console, executor: Pool
) -> int:
    """Measure, write and print how time grows with bodies, duration, phase pairs, workers; return the exit code."""
    begin, tasks = time.monotonic(), CostGrowth(scene).tasks()
    models = {task.argument.function[0] for task in tasks}
    results = compute_tasks("tradeoff", options, words, tasks, models, console, executor)
    series = [*CostGrowth(scene).collect(results), measure_by_workers(scene, make_process_pool)]
    facts = collect_run_facts("tradeoff", options, words, begin)
    measured = MeasuredGrowth(schema=growth.SCHEMA, scene=scene.name, title=scene.title, series=series, run=facts)
    write = partial(publish_files, out, {growth.FILE: growth.STORED.as_json(measured)}, COMMAND)
    write_and_show(out, write, partial(print_growth, console, series))
    console.print(f"Growth: {out / growth.FILE}", soft_wrap=True)
    return 0


def print_growth(console: Console, series: Sequence[CostSeries]) -> None:
    """Print a table of compute time for every value of each growing quantity, with the slope fitted to each series."""
    table = make_table("quantity", "model", "value", "s", "slope")
    for each in series:
        slope = "" if each.slope is None else f"{each.slope:.2f} ± {each.uncertainty:.2f}"
        for value, seconds in zip(each.values, each.seconds):
            known = "no answer" if seconds is None else f"{seconds:.3g}"
            last = value == each.values[-1]
            table.add_row(each.quantity, each.model, f"{value:g}", known, slope if last else "")
    console.print(table)


def _load_harmonic_scene(name: str) -> Scene:
    """Return the named scene; raise SceneError if the solvers outside the package (SciPy) cannot integrate it."""
    scene = load_scene(name)
    if scene.recorded:
        rule = "reference solutions need phases, which a recorded motion has not: give a scene of two frequencies"
        raise SceneError(name, "excitation.record", scene.name, rule)
    scene.require_rigid_friction("every solver outside the package")
    stated = scene.model_dump()["isolator"]["friction"]
    for key in ("load_exponent", "heating") if isinstance(stated, dict) else ():
        if value := stated[key]:
            rule = "the solvers outside the package know no friction that depends on load or heat: remove this key"
            raise SceneError(name, f"isolator.friction.{key}", value, rule)
    return scene


def _load_trades(out: Path) -> list[SceneTrade]:
    """Return errors and compute times that an earlier run left in the folder. Raises UsageError if not readable."""
    try:
        return load_trades(out) or []
    except (OSError, ValueError) as error:
        raise UsageError(str(error)) from None


def measure_trades(
    scenes: Sequence[Scene], options: argparse.Namespace, words: Sequence[str], console: Console, executor: Pool
) -> list[MeasuredTrade]:
    """Measure the scenes, as far as no result is stored; return their errors and times with facts of the run."""
    supplied = load_user_models(options.model, options.model_limit, options.scheduler)
    tradeoff = TradeOff(scenes, options.quick, supplied)
    tasks, width = tradeoff.tasks(), read_number_of_jobs(options)
    about = WORKER_START_SECONDS + sum(task.seconds for task in tasks) / width
    for scene in scenes:
        console.print(f"{scene.title} ({scene.name})")
    console.print(f"Unless they are stored: about {about:.0f} s with {width} workers.")
    begin = time.monotonic()
    results = compute_tasks("tradeoff", options, words, tasks, WORKER_FUNCTIONS, console, executor)
    more = {"quick": options.quick, "stored_before": results.parts[STAGE].stored}
    run = collect_run_facts("tradeoff", options, words, begin) | more
    attributes = {"command": run["command"], **run["provenance"]}
    return [
        MeasuredTrade(replace(measured.trade, run=run), measured.values.assign_attrs(attributes))
        for measured in tradeoff.collect(results)
    ]


def _values_file(scene: str) -> str:
    """Return the name of the netCDF file that holds all values measured for a scene."""
    return name_figure_file(scene, "tradeoff", ending=".nc")


def print_trade(console: Console, trade: SceneTrade) -> None:
    """Print methods and values on the Pareto front of error and time, and how each reference solution was checked."""
    for question in trade.questions:
        console.print(f"{trade.scene}, {question.title}: {question.points} phase pairs", style="bold")
        console.print(
            f"  reference solution: {question.reference_solution}; {'; '.join(question.checks)}", soft_wrap=True
        )
        table = make_table("on the Pareto front of a mu", "value", "s per point", "median error", "95 %")
        for entry in sorted(trade.entries_of(question.key), key=lambda setting: setting.seconds):
            if any(entry.pareto_front):
                sizes = ("  ".join(f"{part:.0e}" for part in parts) for parts in (entry.median, entry.most))
                value = f"{entry.value:.0e} {entry.unit}".strip()
                table.add_row(entry.method, value, f"{entry.seconds:.2g}", *sizes)
        console.print(table if table.row_count else "  no setting answers at each of these phase pairs")
