"""
The claims of section 5 against readings of the paper: `python -m comparison.claims [--grid N] [--jobs J] [--all]`.

The paper leaves units, duration and f_c open, so that a claim can hold under one reading and not under another; the
table says which, names the reading that reproduces most, and lists what none reproduces.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from rich.console import Console
from rich.table import Table

from comparison.claim_checks import Finding, Verdict
from comparison.claim_list import CLAIMS, Claim
from comparison.evidence import Evidence, Question, gathered, lost
from comparison.executors import Pool, process_pool
from comparison.progress import Stage, progress, wide_console
from comparison.readings import CASES, EVERY_READING, READINGS, Reading, without_effect
from comparison.sweep import sweep

GRID = 16  # phases per axis: 24 change a count here and there, and none of the claims that no reading reproduces
SECONDS = 0.25  # of one case under one reading on GRID, recorded beside `Rung.seconds_per_point`
COARSE = 2  # every second phase for surfaces that are only correlated with another


@dataclass(frozen=True)
class ClaimTable:
    """Verdicts, one row for each of `claims`, in each one column for each of `readings`, on `grid` phases per axis."""

    claims: Sequence[Claim]
    readings: Sequence[Reading]
    grid: int
    verdicts: Sequence[Sequence[Verdict]]

    def held(self, column: int) -> int:
        """How many of the paper's own claims a reading reproduces."""
        return sum(row[column].finding.holds for claim, row in zip(self.claims, self.verdicts) if not claim.weaker)

    @property
    def best(self) -> list[Reading]:
        """The readings that reproduce most."""
        held = [self.held(column) for column in range(len(self.readings))]
        return [reading for reading, count in zip(self.readings, held) if count == max(held)]

    @property
    def never(self) -> list[Claim]:
        """The claims that no reading reproduces."""
        return [claim for claim, row in zip(self.claims, self.verdicts) if not any(v.finding.holds for v in row)]

    def found(self, row: int) -> list[tuple[list[int], Verdict]]:
        """What the checks of a claim found, each different answer once, with the numbers of its readings from 1 on."""
        groups: dict[Verdict, list[int]] = {}
        for number, verdict in enumerate(self.verdicts[row], start=1):
            groups.setdefault(verdict, []).append(number)
        return [(numbers, verdict) for verdict, numbers in groups.items()]

    def where(self, row: int) -> str:
        """Under which readings a claim holds, in words."""
        names = [reading.name for reading, verdict in zip(self.readings, self.verdicts[row]) if verdict.finding.holds]
        return "every reading" if len(names) == len(self.readings) else "; ".join(names) or "no reading"


def claims_tested(
    jobs: int,
    executor: Pool = process_pool,
    grid: int = GRID,
    readings: Sequence[Reading] = READINGS,
    claims: Sequence[Claim] = CLAIMS,
    done: Callable[[Question], None] = lambda question: None,
) -> ClaimTable:
    """Every claim under every reading, computed on `executor`, see `sweep`; `done` is told of each case."""
    asked = questions(readings, claims, grid)
    found = sweep(asked, gathered, lost, lambda question, evidence: done(question), jobs, executor)
    known = dict(zip(asked, found))
    columns = [{case: known[_question(case, reading, grid)] for case in _cases(claims)} for reading in readings]
    return tabulated(claims, readings, grid, columns)


def tabulated(
    claims: Sequence[Claim], readings: Sequence[Reading], grid: int, columns: Sequence[Mapping[str, Evidence]]
) -> ClaimTable:
    """The table from the evidence of every reading."""
    return ClaimTable(claims, readings, grid, [[claim.verdict(column) for column in columns] for claim in claims])


def questions(readings: Sequence[Reading], claims: Sequence[Claim], grid: int) -> list[Question]:
    """What has to be computed, each only once, the longest first."""
    every = [_question(case, reading, grid) for case in _cases(claims) for reading in readings]
    return sorted(dict.fromkeys(every), key=lambda question: -question.reading.amplitude)


def _cases(claims: Sequence[Claim]) -> list[str]:
    used = {case for claim in claims for case in claim.cases}
    return [case for case in CASES if case in used]


def _question(case: str, reading: Reading, grid: int) -> Question:
    compared = len(CASES[case](reading).bodies) == 1
    return Question(
        case, without_effect(reading, CASES[case](reading)), grid // COARSE if compared and grid % COARSE == 0 else grid
    )


SIGNS = {Finding.REPRODUCED: "yes", Finding.AS_DRAWN: "drawn", Finding.NOT: "no", Finding.OPEN: "?"}


def main(argv: Sequence[str] | None = None, executor: Pool = process_pool) -> int:
    """Print the table of claims against readings; the exit code: 0, or 2 for a wrong option."""
    parser = argparse.ArgumentParser(
        prog="python -m comparison.claims", description="The claims of section 5 of the paper against readings of it."
    )
    parser.add_argument("--grid", type=_at_least(8), default=GRID, metavar="N", help="phases per axis (%(default)s)")
    parser.add_argument("--jobs", type=_at_least(1), default=os.cpu_count() or 1, metavar="J", help="worker processes")
    parser.add_argument("--all", action="store_true", help="every reading: more amplitudes, durations and f_c")
    parser.add_argument("--words", action="store_true", help="print what every check found, too")
    given = parser.parse_args(argv)
    readings = EVERY_READING if given.all else READINGS
    console = wide_console()
    count = len(questions(readings, CLAIMS, given.grid))
    stage = Stage(count, count * SECONDS * (given.grid / GRID) ** 2)
    with progress(console, {"claims": stage}, given.jobs) as display:
        table = claims_tested(
            given.jobs, executor, given.grid, readings, done=lambda question: display.advance("claims", 1)
        )
    print_claims(console, table, given.words)
    return 0


def print_claims(console: Console, table: ClaimTable, words: bool = False) -> None:
    """The table, a line for every claim; then the reading that reproduces most and the claims that none reproduces."""
    own = sum(not claim.weaker for claim in table.claims)
    for number, reading in enumerate(table.readings, start=1):
        console.print(f"{number:2d}: {reading.name}: {table.held(number - 1)} of {own}")
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


def _at_least(least: int) -> Callable[[str], int]:
    def number(text: str) -> int:
        if not text.isdecimal() or int(text) < least:
            raise argparse.ArgumentTypeError(f"{text!r}: must be a whole number, {least} or more")
        return int(text)

    return number


if __name__ == "__main__":
    sys.exit(main())
