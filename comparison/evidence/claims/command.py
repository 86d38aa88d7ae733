"""Statements of the paper in both readings of (5.1): `phase-resonance claims [--grid N]`."""

from collections.abc import Sequence

from rich.console import Console
from rich.table import Table

from comparison.cli.arguments import STORED_RESULTS_HELP, CommandParser, command, read_whole_number
from comparison.cli.computing import compute_tasks
from comparison.evidence.claims.table import CLAIMS_GRID, Claims, ClaimTable, word_claims
from comparison.evidence.forced_ratios import compute_forced_ratios
from comparison.runner.processes import Pool, make_process_pool
from comparison.runner.progress import make_wide_console
from comparison.study.models import SMALL
from comparison.study.study import STUDY_TOLERANCE, Study
from reference.problem import builtin_scenes, load_scene


@command
def main(argv: Sequence[str], executor: Pool = make_process_pool) -> int:
    """Check the paper's statements about its figures and print the verdicts; return the exit code."""
    parser = CommandParser("claims", "The statements of section 5 of the paper in both readings of (5.1).")
    parser.add_argument("--grid", metavar="N", help=f"phases per axis (default {CLAIMS_GRID})")
    parser.add_out(STORED_RESULTS_HELP)
    parser.add_computing()
    options = parser.parse_args(argv)
    grid = CLAIMS_GRID if options.grid is None else read_whole_number("--grid", options.grid, 8, 512)
    study = Study(tuple(map(load_scene, builtin_scenes())), grid, STUDY_TOLERANCE)
    console = make_wide_console()
    claims = Claims(grid)
    results = compute_tasks("claims", options, argv, claims.tasks(study), {SMALL.amplification}, console, executor)
    table = claims.collect(study, None, results)
    assert table is not None, "the study has every scene of the paper"
    print_claims(console, table)
    print_ratios(console, study)
    console.print(word_claims(table), soft_wrap=True)
    return 0


def print_claims(console: Console, table: ClaimTable) -> None:
    """Print the verdicts in both readings of (5.1), then each statement's rule and reasons, and why it cannot hold."""
    grid = Table("about", "statement", *table.counts, box=None, pad_edge=False)
    for each in table.statements:
        grid.add_row(each.figure, each.says, *(each.verdicts[name].verdict for name in table.counts))
    console.print(grid)
    for each in table.statements:
        console.print(f"{each.figure}: {each.says}; met if: {each.rule}", soft_wrap=True)
        for text in [*each.reasons, *filter(None, [each.cannot])]:
            console.print(f"   {text}", soft_wrap=True)


def print_ratios(console: Console, study: Study) -> None:
    """Print the ratio of each upper body's amplitude to the platform's, by the equations of the links (4.4) alone."""
    console.print("Amplitude of a body over that of the platform under each harmonic, by (4.4) alone:")
    grid = Table("scene", "axis", "period, s", "body", "ratio", "without decay", box=None, pad_edge=False)
    for scene in study.scenes:
        for each in compute_forced_ratios(scene):
            numbers = f"{each.period:.3g}", str(each.body), f"{each.ratio:.2f}", f"{each.steady:.2f}"
            grid.add_row(scene.name, each.axis, *numbers)
    console.print(grid)
