"""
Numerical stability at the extremes: `python -m comparison.extremes [--out DIR]`.

Every model meets every extreme of `rows` in a process that can be killed, and its answer is judged by a finer
run. Writes extremes.json and extremes.png. Exit codes: 0 no cell failed; 1 some did; 2 a wrong option;
3 the files could not be written; others as in `run_command`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from datetime import UTC, datetime
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TimeElapsedColumn

from comparison.analysis.extremes.cells import Cell, Solved, cells, solve_cell
from comparison.analysis.extremes.matrix import FILE, PICTURE, Matrix, as_entry, as_json, matrix
from comparison.analysis.extremes.rows import COLUMNS, EQUATIONS, REFERENCE, Column, Row, rows
from comparison.analysis.extremes.verdicts import Verdict
from comparison.analysis.extremes.worker import answers
from comparison.cli.arguments import CommandParser, command, jobs, number, writing
from comparison.execution.output import destination, made_by, publish, refuse_foreign_files
from comparison.execution.progress import description, wide_console
from comparison.execution.provenance import provenance
from comparison.execution.resume import command_line
from reference.problem import SceneError

BRIEF = {"lubrication, s/m", "start at the friction limit", "outside the rules"}  # for the engine's models, too
LIMIT = 180.0  # s of processor time for one cell with its finer runs: four times what the dearest takes


@command
def main(argv: Sequence[str]) -> int:
    """Run what the command line asks for; the exit code."""
    options = _parser().parse_args(argv)
    limit = LIMIT if options.limit is None else number("--limit", options.limit, 0.1, 1e6, "s of processor time")
    width = jobs(options)
    chosen = reduced(list(rows())) if options.reduced else list(rows())
    if options.only:
        chosen = [row for row in chosen if options.only in f"{row.group} {row.title}"]
    columns = [column for column in COLUMNS if not options.models or column.key in options.models]
    if not cells(chosen, columns):
        raise SceneError("command line", "--only", options.only, "no cell is left: take part of a row's name")
    out = destination(options.out)
    refuse_foreign_files(out, [FILE, PICTURE])
    console = wide_console()
    found = run(chosen, width, limit, console, command_line(argv, "extremes"), columns)
    from comparison.report.figures.extremes import draw_extremes  # matplotlib: not needed to refuse a command

    picture = made_by(lambda folder: draw_extremes(folder / PICTURE, found))
    with writing(out):
        files = publish(out, {FILE: as_json(found), **picture}, "comparison.extremes")
    _tell(console, found)
    console.print(f"Matrix: {', '.join(map(str, files))}", soft_wrap=True)
    console.print("A report written into the same directory by comparison.run shows it.")
    return 1 if found.counts()[Verdict.FAILED] else 0


def reduced(every: Sequence[Row]) -> list[Row]:
    """The extremes for a quick look: those that take a fraction of a second."""
    kept = [
        (row, row.columns if row.group in BRIEF else tuple(key for key in row.columns if key in REFERENCE))
        for row in every
        if row.quick
    ]
    return [Row(**{**vars(row), "columns": columns}) for row, columns in kept if columns]


def run(
    chosen: Sequence[Row],
    jobs: int,
    limit: float,
    console: Console,
    command: str,
    columns: Sequence[Column] = COLUMNS,
    work: Callable[[Cell], Any] = solve_cell,
) -> Matrix:
    """The matrix of the chosen rows, computed by `jobs` processes; limit: s of processor time for one cell."""
    tasks = cells(chosen, columns)
    # the longest first: no process waits at the end for a cell that another has just begun
    tasks.sort(key=lambda cell: cell.row.quick)
    begin, began = time.monotonic(), datetime.now(UTC)
    bar = Progress(description(), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), console=console)
    with bar:
        shown = bar.add_task("extremes", total=len(tasks))

        def done(index: int, result: Any) -> None:
            bar.advance(shown)
            entry, cell = as_entry(result), tasks[index]
            if entry.verdict == Verdict.FAILED or not console.is_terminal:
                spent = "" if entry.seconds is None else f" ({entry.seconds:.1f} s, in all {entry.total:.1f} s)"
                name = f"{cell.row.group} {cell.row.title}, {cell.column.title}"
                bar.console.print(f"{entry.verdict}: {name}: {entry.reason}{spent}", soft_wrap=True)

        # the reference is compiled on its first use: not within the time of a cell
        asks = {name for column in columns for name in (column.amplification, *(finer[0] for finer in column.finer))}
        compiled = next((column for column in COLUMNS if column.amplification in asks & {EQUATIONS}), None)
        first = Cell(chosen[0], compiled) if compiled and tasks else None
        results = answers(tasks, work, limit, jobs, done, first)
    facts = {
        "command": command,
        "began": began.isoformat(timespec="seconds"),
        "seconds": round(time.monotonic() - begin, 1),
        "cpu_seconds": round(sum(result.total for result in results if isinstance(result, Solved)), 1),
        "jobs": jobs,
        "limit": limit,
        "reduced": len(tasks) < len(cells(list(rows()))),
        "provenance": provenance(),
    }
    places = {id(cell.row): number for number, cell in enumerate(cells(chosen, columns))}
    order = sorted(range(len(tasks)), key=lambda index: places[id(tasks[index].row)])
    return matrix([tasks[index] for index in order], [results[index] for index in order], columns, facts)


def _tell(console: Console, found: Matrix) -> None:
    """Counts, and what a model cannot do."""
    for row, title, entry in found.listed(Verdict.LIMIT):
        console.print(f"limit: {row.group} {row.title}, {title}: {entry.reason}", soft_wrap=True)
    for row, title, entry in found.listed(Verdict.FAILED):
        console.print(f"FAILED: {row.group} {row.title}, {title}: {entry.reason}", soft_wrap=True)
    counts = ", ".join(f"{count} {name}" for name, count in found.counts().items())
    spent = f"{found.run['seconds']} s, {found.run['cpu_seconds']} s of processor time"
    console.print(f"{sum(found.counts().values())} cells in {spent}: {counts}.", soft_wrap=True)


def _parser() -> CommandParser:
    parser = CommandParser(
        "extremes", "Every model at the extremes of every quantity, judged by finer runs, as a matrix."
    )
    parser.add_out(f"where {FILE} goes")
    parser.add_jobs()
    parser.add_argument("--limit", metavar="SECONDS", help=f"most processor time of one cell (default {LIMIT:g})")
    parser.add_argument("--only", default="", metavar="TEXT", help="the extremes whose name contains this")
    keys = [column.key for column in COLUMNS]
    parser.add_argument("--models", nargs="+", choices=keys, metavar="KEY", help=f"some of {', '.join(keys)}")
    parser.add_argument("--reduced", action="store_true", help="what takes little: mostly the equations alone")
    return parser
