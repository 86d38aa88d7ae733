"""
Numbers published elsewhere, each solved by the equations and by the engine: `phase-resonance benchmarks`.

Exit codes: 0 every number is met or its difference explained; 1 not; 2 a wrong option; 3 the files could not be
written; others as in `run_command`.
"""

import time
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from rich.console import Console

from comparison.cli.arguments import CommandParser, command, read_number_of_jobs, write_and_show
from comparison.cli.computing import collect_run_facts, compute_tasks
from comparison.cli.terminal import make_table
from comparison.evidence.benchmarks.analysis import MODEL_OF_SIDE, BenchmarkTable
from comparison.evidence.benchmarks.cases import BenchmarkCase, list_cases, load_mastodon_case
from comparison.evidence.benchmarks.table import (
    STORED,
    TABLE_PAGE,
    Benchmarks,
    word_explanations,
    word_page,
    word_with_error,
)
from comparison.evidence.sides import ENGINE, EQUATIONS
from comparison.runner.attempts import publish_attempted
from comparison.runner.output import publish_files, refuse_foreign_files, resolve_destination
from comparison.runner.processes import Pool, make_process_pool
from comparison.runner.progress import make_wide_console
from comparison.verdicts import NOT_COMPARED
from reference.problem import SceneError

TERMINAL_DIGITS = 6  # largest number of significant digits of a number on the terminal
WORKER_FUNCTIONS = {model.trajectory for model in MODEL_OF_SIDE.values()}  # functions that the workers call


@command
def main(argv: Sequence[str], executor: Pool = make_process_pool) -> int:
    """Solve the benchmarks that the command line names; return the exit code."""
    begin = time.monotonic()
    parser = CommandParser("benchmarks", "Numbers published elsewhere, each by the equations and by the engine.")
    parser.add_out(f"where {STORED.name} and {TABLE_PAGE} go")
    parser.add_computing()
    parser.add_argument("--only", default="", metavar="TEXT", help="the benchmarks whose name contains this")
    parser.add_argument(
        "--mastodon",
        type=Path,
        metavar="FILE",
        help="CSV with the input of MASTODON's friction pendulum test, which is not shipped: adds that benchmark",
    )
    options = parser.parse_args(argv)
    read_number_of_jobs(options)  # only to refuse a wrong --jobs before the benchmarks are read
    analysis = BenchmarkTable(_choose_cases(options.only, options.mastodon))
    out = resolve_destination(options.out)
    refuse_foreign_files(out, [STORED.name, TABLE_PAGE])
    console = make_wide_console()
    results = compute_tasks("benchmarks", options, argv, analysis.tasks(), WORKER_FUNCTIONS, console, executor)
    solved = analysis.collect(results)
    table = replace(solved, run=collect_run_facts("benchmarks", options, argv, begin))

    def write() -> list[Path]:
        """Write the table of benchmarks as JSON and as a Markdown page; return the paths of the files."""
        files = publish_files(out, {STORED.name: STORED.as_json(table)}, "comparison.benchmarks")
        return files + publish_attempted(out, TABLE_PAGE, lambda: word_page(table).encode(), "comparison.benchmarks")

    files = write_and_show(out, write, partial(print_benchmarks, console, table))
    console.print(f"Tables: {', '.join(map(str, files))}", soft_wrap=True)
    console.print("A report written into the same directory by phase-resonance run shows them.")
    return 1 if table.count_explanations()[""] or table.counts()[NOT_COMPARED] else 0


def print_benchmarks(console: Console, table: Benchmarks) -> None:
    """Print a table row for every published number, then how models differ from sources, and counts of verdicts."""
    lines = make_table("scene", "quantity", "published", "equations", "verdict", "engine", "verdict")
    for each in table.benchmarks:
        for row in each.rows:
            cells = [f"{row.published:g}"]
            for side in (EQUATIONS, ENGINE):
                cells += [word_with_error(row.numbers[side], TERMINAL_DIGITS), row.word(side)]
            lines.add_row(each.name, ", ".join(filter(None, (row.quantity, row.unit))), *cells)
    console.print(lines)
    for each in table.benchmarks:
        if each.difference:
            console.print(f"{each.name}: {each.difference}", soft_wrap=True)
    for sentence in word_explanations(table):
        console.print(f"{sentence}.", soft_wrap=True)


def _choose_cases(only: str, mastodon_input: Path | None) -> list[BenchmarkCase]:
    """
    Return the benchmarks whose name contains `only`; that of MASTODON is among them if the file of its input is given.

    Raises SceneError if none is left.
    """
    known = list_cases() + ([] if mastodon_input is None else [load_mastodon_case(mastodon_input)])
    chosen = [case for case in known if only in case.scene.name]
    if not chosen:
        names = ", ".join(case.scene.name for case in known)
        raise SceneError("command line", "--only", only, f"no benchmark is left: take part of a name, {names}")
    return chosen
