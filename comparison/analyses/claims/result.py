"""The claims of the paper, as summary.json holds them."""

from __future__ import annotations

from comparison.analyses.claims.checks import Verdict
from comparison.result_types import result


@result
class CheckedClaim:
    """One statement of the paper about its figures."""

    figure: str
    """figure of the paper"""
    says: str
    """what the paper says"""
    rule: str
    """how it is decided"""
    weaker: bool
    """whether it is a weaker form of a claim, which is not counted"""
    proof: str
    """why it cannot hold; empty where it can"""
    verdicts: tuple[Verdict, ...]
    """one per reading"""

    @property
    def found(self) -> dict[Verdict, list[int]]:
        """What its checks found, each different answer once, with the numbers of its readings from 1 on."""
        groups: dict[Verdict, list[int]] = {}
        for number, verdict in enumerate(self.verdicts, start=1):
            groups.setdefault(verdict, []).append(number)
        return groups


@result
class ClaimTable:
    """The paper's statements about its figures, compared with readings of the scenes."""

    grid: int
    """phases per axis"""
    readings: tuple[str, ...]
    """names of the readings"""
    origins: tuple[str, ...]
    """why anyone would read the paper so, and by what selection each was found"""
    reproduced: tuple[int, ...]
    """how many claims each reading reproduces"""
    best: tuple[str, ...]
    """readings that reproduce most"""
    never: tuple[str, ...]
    """claims that no reading reproduces"""
    claims: tuple[CheckedClaim, ...]
    """one per statement"""

    @property
    def stated(self) -> int:
        """How many claims the paper makes."""
        return sum(not claim.weaker for claim in self.claims)
