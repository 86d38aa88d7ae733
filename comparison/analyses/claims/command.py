"""The claims of section 5 against readings of the paper: `python -m comparison.claims [--grid N] [--all]`."""

from collections.abc import Sequence

from rich.console import Console
from rich.table import Table

from comparison.analyses.claims.checks import Finding
from comparison.analyses.claims.readings import EVERY_READING, READINGS
from comparison.analyses.claims.table import GRID, SIGNS, Claims, ClaimTable
from comparison.analyses.effective_values.analysis import forced_ratios
from comparison.cli.arguments import STORED_RESULTS, CommandParser, command, whole_number
from comparison.cli.computing import computed
from comparison.runner.processes import Pool, process_pool
from comparison.runner.progress import wide_console
from comparison.study.study import Study
from reference.problem import builtin_scenes, load_scene

TOLERANCE = 1e-3  # of a study; the surfaces of the claims have one of their own
SURFACES = "reference:amplification"  # what the workers ask
SETTLED = (
    "docs/claims.md records the counts on finer grids and a search of 96 readings; docs/claims_page.py repeats them."
)
MARKS = dict(zip(Finding, "+d-x?"))


@command
def main(argv: Sequence[str], executor: Pool = process_pool) -> int:
    """Print the table of claims against readings; the exit code."""
    parser = CommandParser("claims", "The claims of section 5 of the paper against readings of it.")
    parser.add_argument("--grid", metavar="N", help=f"phases per axis (default {GRID})")
    parser.add_argument("--all", action="store_true", help="every reading: more amplitudes, durations and f_c")
    parser.add_argument(
        "--settle", action="store_true", help="say where the counts of peaks on finer grids are recorded"
    )
    parser.add_argument(
        "--search", metavar="N", nargs="?", const="96", help="say where the search of other readings is recorded"
    )
    parser.add_out(STORED_RESULTS)
    parser.add_computing()
    parser.add_argument("--words", action="store_true", help="print what every check found, too")
    options = parser.parse_args(argv)
    grid = GRID if options.grid is None else whole_number("--grid", options.grid, 8, 512)
    if options.search is not None:
        whole_number("--search", options.search, 1, 100_000)
    readings = EVERY_READING if options.all else READINGS
    study = Study(tuple(map(load_scene, builtin_scenes())), grid, TOLERANCE)
    console = wide_console()
    claims = Claims(grid, readings)
    results = computed("claims", options, argv, claims.tasks(study), {SURFACES}, console, executor)
    table = claims.collect(study, None, results)
    assert table is not None, "the study has every scene of the paper"
    print_claims(console, table, options.words)
    if grid != GRID:
        console.print(f"Verdicts of the literal (4.6) are those recorded on {GRID} x {GRID} phases.", soft_wrap=True)
    print_ratios(console, study)
    if options.settle or options.search is not None:
        console.print(SETTLED, soft_wrap=True)
    return 0


def print_claims(console: Console, table: ClaimTable, words: bool = False) -> None:
    """Print the verdicts and, with `words`, what every check found; the best readings; claims that none reproduces."""
    for number, reading in enumerate(table.readings, start=1):
        console.print(f"{number:2d}: {reading}: {table.reproduced[number - 1]} of {table.stated}")
        console.print(f"    {table.origins[number - 1]}")
    grid = Table("about", "claim", *map(str, range(1, len(table.readings) + 1)), box=None, pad_edge=False)
    for claim in table.claims:
        grid.add_row(claim.figure, claim.says, *(MARKS[verdict.finding] for verdict in claim.verdicts))
    console.print(grid)
    console.print("; ".join(f"{mark} {finding}" for finding, mark in MARKS.items()))
    for claim in table.claims:
        if claim.proof:
            console.print(f"{claim.figure}: {claim.says}: cannot hold. {claim.proof}")
    if words:
        for claim in table.claims:
            console.print(f"{claim.figure}: {claim.says} ({claim.rule})")
            for verdict, numbers in claim.found.items():
                console.print(f"   {SIGNS[verdict.finding]:6s} {', '.join(map(str, numbers))}: {verdict.found}")
    console.print(f"Most claims are reproduced under: {'; '.join(table.best)}.")
    console.print(f"Under no reading: {'; '.join(table.never) or 'none'}.")


def print_ratios(console: Console, study: Study) -> None:
    """Print how intensively the bodies above the platform are forced, by (4.4) alone."""
    console.print("Amplitude of a body over that of the platform under each harmonic, by (4.4) alone:")
    grid = Table("scene", "axis", "period, s", "body", "ratio", "without decay", box=None, pad_edge=False)
    for scene in study.scenes:
        for each in forced_ratios(scene):
            numbers = f"{each.period:.3g}", str(each.body), f"{each.ratio:.2f}", f"{each.steady:.2f}"
            grid.add_row(scene.name, each.axis, *numbers)
    console.print(grid)
