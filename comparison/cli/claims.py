"""
The claims of section 5 against readings of the paper: `python -m comparison.claims [--grid N] [--jobs N] [--all]`.

Every case is stored as it is finished: the same command goes on where it stopped.
"""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import Console
from rich.table import Table

from comparison.analysis.claims.readings import EVERY_READING, READINGS
from comparison.analysis.claims.table import GRID, SIGNS, Claims, ClaimTable
from comparison.cli.arguments import STORED_RESULTS, CommandParser, command, whole_number
from comparison.cli.computing import computed
from comparison.execution.executors import Pool
from comparison.execution.processes import process_pool
from comparison.execution.progress import wide_console
from comparison.study.study import Study
from reference.problem import builtin_scenes, load_scene

TOLERANCE = 1e-3  # of a study; the surfaces of the claims have one of their own
SURFACES = "reference:amplification"  # what the workers ask


@command
def main(argv: Sequence[str], executor: Pool = process_pool) -> int:
    """Print the table of claims against readings; the exit code."""
    parser = CommandParser("claims", "The claims of section 5 of the paper against readings of it.")
    parser.add_argument("--grid", metavar="N", help=f"phases per axis (default {GRID})")
    parser.add_argument("--all", action="store_true", help="every reading: more amplitudes, durations and f_c")
    parser.add_out(STORED_RESULTS)
    parser.add_computing()
    parser.add_argument("--words", action="store_true", help="print what every check found, too")
    options = parser.parse_args(argv)
    grid = GRID if options.grid is None else whole_number("--grid", options.grid, 8, 512)
    claims = Claims(grid, EVERY_READING if options.all else READINGS)
    study = Study(tuple(map(load_scene, builtin_scenes())), grid, TOLERANCE)
    console = wide_console()
    results = computed("claims", options, argv, claims.tasks(study), {SURFACES}, console, executor)
    table = claims.collect(study, None, results)
    assert table is not None, "the study has every scene of the paper"
    print_claims(console, table, options.words)
    return 0


def print_claims(console: Console, table: ClaimTable, words: bool = False) -> None:
    """
    Print the table: a line for every claim; the reading that reproduces most; the claims that none reproduces.

    Parameters
    ----------
    console : Console
    table : ClaimTable
    words : bool
        Print what every check found, too.
    """
    stated = sum(not claim.weaker for claim in table.claims)  # by the paper
    for number, reading in enumerate(table.readings, start=1):
        console.print(f"{number:2d}: {reading.name}: {table.held(number - 1)} of {stated}")
    grid = Table("about", "claim", *map(str, range(1, len(table.readings) + 1)), box=None, pad_edge=False)
    for claim, row in zip(table.claims, table.verdicts):
        grid.add_row(claim.figure, claim.says, *(SIGNS[verdict.finding] for verdict in row))
    console.print(grid)
    if words:
        for place, claim in enumerate(table.claims):
            console.print(f"{claim.figure}: {claim.says} ({claim.rule})")
            for numbers, verdict in table.found(place):
                console.print(f"   {SIGNS[verdict.finding]:5s} {', '.join(map(str, numbers))}: {verdict.found}")
    console.print(f"Most claims are reproduced under: {'; '.join(reading.name for reading in table.best)}.")
    never = [f"{claim.figure}: {claim.says}" for claim in table.never]
    console.print(f"Under no reading: {'; '.join(never) or 'none'}.")
