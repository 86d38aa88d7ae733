"""The claims of the paper, as summary.json holds them."""

from __future__ import annotations

from comparison.analyses.claims.spike import Spike
from comparison.result_types import Part, Text


class ClaimVerdict(Part):
    """What the surfaces of one reading say about a claim."""

    finding: str
    """reproduced, as drawn, not reproduced, cannot hold, or no answer"""
    found: Text
    """numbers behind it"""


class Claim(Part):
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
    verdicts: list[ClaimVerdict]
    """one per reading"""


class Claims(Part):
    """The paper's statements about its figures, compared with readings of the scenes."""

    grid: int
    """phases per axis"""
    readings: list[str]
    """names of the readings"""
    origins: list[str]
    """why anyone would read the paper so, and by what selection each was found"""
    spike: Spike
    """what the step does to the literal reading"""
    reproduced: list[int]
    """how many claims each reading reproduces"""
    best: list[str]
    """readings that reproduce most"""
    never: list[str]
    """claims that no reading reproduces"""
    claims: list[Claim]
    """one per statement"""
