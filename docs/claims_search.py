"""
A bounded search for readings that reproduce more claims, and what is left of its best when selection is counted in.

The readings come from a Halton sequence over structure and parameters, so that a longer search contains a shorter one.
Whoever looks at the best of many must expect good luck: the search therefore says how many readings it tried, how the
numbers of reproduced claims are distributed among them, and what its best do on a finer grid than the one that chose
them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import qmc

from comparison.analyses.claims.readings import Peak, Reading, loading_around
from comparison.analyses.claims.table import ClaimTable

SEARCH_GRID = 8  # phases per axis of the search; the best are judged again on a finer grid
TITLE = "searched"
BEST = 3  # readings that are judged again


@dataclass(frozen=True)
class Range:
    """What a search varies: a parameter between two bounds, on a logarithmic scale."""

    name: str
    low: float
    high: float
    unit: str

    def at(self, share: float) -> float:
        """Value at a share from 0 to 1 of the range, to three digits."""
        return float(f"{self.low * (self.high / self.low) ** share:.3g}")


RANGES = (
    Range("amplitude", 0.1, 2.0, "m/s²"),
    Range("period of the loading", 0.4, 2.0, "s"),
    Range("friction", 0.01, 0.2, ""),
    Range("m_2 / m_1", 0.05, 2.0, ""),
    Range("T_3 over the printed", 0.3, 4.0, ""),
    Range("f_c", 0.05, 5.0, "s/m"),
)
PEAKS: tuple[Peak, ...] = ("resolved", "supremum", "literal (4.6)")  # what is counted, and by which equations


def searched_readings(count: int) -> list[Reading]:
    """
    The first readings of the search.

    Parameters
    ----------
    count : int

    Returns
    -------
    list of Reading
    """
    shares = qmc.Halton(len(RANGES) + 1, scramble=False).random(count + 1)[1:]  # the first is a corner
    return [_reading(row) for row in shares]


def _reading(shares: np.ndarray) -> Reading:
    amplitude, period, friction, mass, softness, lubrication = (
        each.at(float(share)) for each, share in zip(RANGES, shares)
    )
    return Reading(
        amplitude,
        peak=PEAKS[int(shares[-1] * len(PEAKS))],
        lubrication=lubrication,
        values=(("isolator.friction", friction), ("bodies.1.mass", mass), *loading_around(period)),
        factors=(("bodies.1.period", softness),),
        title=f"{TITLE}: loading {period:g} s, friction {friction:g}, m_2/m_1 {mass:g}, T_3 x {softness:g}",
        reason="found by the search",
    )


@dataclass(frozen=True)
class Selection:
    """
    What a search found. table: every reading on SEARCH_GRID. again: the BEST of it on a finer grid.
    """

    table: ClaimTable
    again: ClaimTable

    @property
    def held(self) -> list[int]:
        """How many claims each reading reproduces."""
        return list(self.table.reproduced)

    @property
    def lines(self) -> list[str]:
        """What a reader must know, in sentences."""
        held, stated = np.array(self.held), self.table.stated
        possible = stated - sum(bool(claim.proof) for claim in self.table.claims)
        lines = [
            f"{len(held)} readings were searched on {self.table.grid} x {self.table.grid} phases; at most {possible} "
            f"of the {stated} claims can hold.",
            f"Claims reproduced: median {np.median(held):g}, best {held.max()}. Number of readings for each number of "
            + "claims: "
            + ", ".join(f"{count}: {int((held == count).sum())}" for count in sorted(set(held.tolist())))
            + ".",
        ]
        for column, reading in enumerate(self.again.readings):
            before = self.held[self.table.readings.index(reading)]
            lines.append(
                f"{reading}: {before} on the grid that chose it, {self.again.reproduced[column]} on "
                f"{self.again.grid} x {self.again.grid} phases."
            )
        lines.append(
            "The best were selected by the number they reproduce: that is no evidence that the paper used them."
        )
        return lines


def best_readings(table: ClaimTable, readings: Sequence[Reading]) -> Sequence[Reading]:
    """The BEST readings of a search by their table, the first found of equals."""
    order = sorted(range(len(readings)), key=lambda column: -table.reproduced[column])
    return [readings[column] for column in order[:BEST]]
