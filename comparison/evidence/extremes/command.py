"""
Numerical stability at the extremes: `phase-resonance extremes [--out DIR]`.

Exit codes: 0 no cell failed; 1 some did; 2 a wrong option; 3 the files could not be written; others as in
`run_command`.
"""

import argparse
import time
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from rich.console import Console

from comparison.cli.arguments import CommandParser, command, read_number, read_number_of_jobs, write_and_show
from comparison.cli.computing import collect_run_facts, compute_tasks
from comparison.cli.user_models import add_models, load_user_models
from comparison.evidence.extremes.analysis import CELL_TIME_LIMIT, STAGE, Extremes, list_cells, select_quick
from comparison.evidence.extremes.columns import COLUMNS, ENGINE, EQUATIONS, STATED_ENGINE, make_user_column
from comparison.evidence.extremes.matrix import FILE, STORED, CellVerdict, Matrix
from comparison.evidence.extremes.rows import list_extreme_cases
from comparison.runner.output import publish_files, refuse_foreign_files, resolve_destination
from comparison.runner.processes import Pool, make_process_pool
from comparison.runner.progress import make_wide_console
from reference.problem import SceneError

WORKER_FUNCTIONS = {EQUATIONS, ENGINE, STATED_ENGINE}  # import paths of the functions that worker processes call


@command
def main(argv: Sequence[str], executor: Pool = make_process_pool) -> int:
    """Judge the cells of the matrix of extremes that the command line selects; return the exit code."""
    parser = CommandParser(
        "extremes", "Every model at the extremes of every quantity, judged by finer runs, as a matrix."
    )
    parser.add_out(f"where {FILE} goes")
    parser.add_computing()
    parser.add_argument(
        "--limit", metavar="SECONDS", help=f"most processor time of one cell (default {CELL_TIME_LIMIT:g})"
    )
    parser.add_argument("--rows", default="", metavar="TEXT", help="the extremes whose name contains this")
    parser.add_argument("--only", help=argparse.SUPPRESS)  # former option: its error message names the new one
    keys = [column.key for column in COLUMNS]
    parser.add_argument("--models", nargs="+", choices=keys, metavar="KEY", help=f"some of {', '.join(keys)}")
    add_models(parser)
    parser.add_argument("--reduced", action="store_true", help="what takes little: mostly the equations alone")
    options = parser.parse_args(argv)
    extremes = _choose_cells(options)
    out = resolve_destination(options.out)
    refuse_foreign_files(out, [FILE])
    console = make_wide_console()
    matrix = judge_matrix(extremes, options, argv, console, executor)

    def show() -> None:
        """Print the reason for every verdict "limit" or "FAILED" in the matrix."""
        for verdict in (CellVerdict.LIMIT, CellVerdict.FAILED):
            for row, title, entry in matrix.cells_of(verdict):
                console.print(f"{verdict}: {row.group} {row.title}, {title}: {entry.reason}", soft_wrap=True)

    (file,) = write_and_show(
        out, partial(publish_files, out, {FILE: STORED.as_json(matrix)}, "comparison.extremes"), show
    )
    counts = ", ".join(f"{count} {name}" for name, count in matrix.counts().items())
    spent = f"{matrix.run['seconds']} s, {matrix.run['cpu_seconds']} s of processor time"
    console.print(f"{sum(matrix.counts().values())} cells in {spent}: {counts}.", soft_wrap=True)
    console.print(f"Matrix: {file}", soft_wrap=True)
    console.print("A report written into the same directory by phase-resonance run shows it.")
    return 1 if matrix.counts()[CellVerdict.FAILED] else 0


def judge_matrix(
    extremes: Extremes, options: argparse.Namespace, words: Sequence[str], console: Console, executor: Pool
) -> Matrix:
    """Return the matrix of verdicts with times and provenance of the run; cells in the cache are not computed again."""
    begin, tasks = time.monotonic(), extremes.tasks()
    results = compute_tasks("extremes", options, words, tasks, WORKER_FUNCTIONS, console, executor)
    matrix = extremes.collect(results)
    totals = [entry.total or 0.0 for row in matrix.rows for entry in row.entries.values()]
    run = {
        **collect_run_facts("extremes", options, words, begin),
        "cpu_seconds": round(sum(totals), 1),
        "stored_before": results.parts[STAGE].stored,
        "limit": extremes.limit,
        "reduced": len([task for task in tasks if not task.group]) < len(list_cells(list(list_extreme_cases()))),
    }
    return replace(matrix, run=run)


def _choose_cells(options: argparse.Namespace) -> Extremes:
    """Return the rows and columns of the matrix that the options select. Raises SceneError."""
    if options.only is not None:
        rule = "selects analyses of a study; the extremes are chosen with --rows TEXT"
        raise SceneError("command line", "--only", options.only, rule)
    limit = (
        CELL_TIME_LIMIT
        if options.limit is None
        else read_number("--limit", options.limit, 0.1, 1e6, "s of processor time")
    )
    read_number_of_jobs(options)  # a wrong number of jobs is refused before the cells are listed
    supplied = load_user_models(options.model, options.model_limit, options.scheduler)
    every = list(list_extreme_cases())
    kept = [row for row in (select_quick(every) if options.reduced else every) if options.rows in row.name]
    columns = [column for column in COLUMNS if not options.models or column.key in options.models]
    columns += [make_user_column(model) for model in supplied]
    if not list_cells(kept, columns):
        raise SceneError("command line", "--rows", options.rows, "no cell is left: take part of a row's name")
    return Extremes(kept, columns, limit)
