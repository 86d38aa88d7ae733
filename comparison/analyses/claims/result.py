"""The paper's errata, assumptions and claims."""

from __future__ import annotations

from typing import Literal

from comparison.result_types import Number, Part, Phases, Text


class Effect(Part):
    """What the printed form of an erratum does to mu in one scene."""

    scene: Text
    """name of the scene"""
    erratum: int
    """number of the erratum, from 0"""
    change: list[list[Number]]
    """relative change of mu by phase pair and body; null where the printed form has no answer; empty if untouched"""
    error_message: Text
    """what went wrong, or empty"""


class Erratum(Part):
    """One erratum of the print."""

    where: str
    """place in the paper"""
    printed: str
    """what is printed"""
    corrected: str
    """what it should be"""
    why: str
    """reason"""
    none: str
    """why it has no measurable effect, or empty"""
    effects: list[Effect]
    """one per scene with phases"""


class Assumption(Part):
    """One of the paper's assumptions (i) to (vi)."""

    number: str
    """of the paper"""
    statement: str
    """what the paper assumes"""
    engine: str
    """what the engine's models do with it"""
    relaxed: Literal["yes", "partly", "no"]
    """whether the engine's models drop it"""


class Variation(Part):
    """The scene with another ring of supports and other heights, uneven, or on loaded bars."""

    ring: float
    """radius of the ring, as a multiple of the stated one"""
    height: float
    """heights of the bodies, as multiples of the stated ones"""
    supports: int | None
    """number of supports; null for the stated one"""
    offset: float
    """by which centers of mass above the platform are moved along x and along y, over the radius of the ring"""
    yaw: float
    """by which bodies above the platform and their links are turned about the vertical, rad"""
    bars: str | None
    """what the weight above does to bars that give way: softening or shortening; null as stated"""


class AssumptionCell(Part):
    """The spatial model of one variation against the translational model."""

    scene: Text
    """name of the scene"""
    variation: Variation
    """what is varied"""
    change: list[list[Number]]
    """relative change of mu by phase pair and body"""
    uncertainty: list[list[Number]]
    """of the change, the two error estimates together"""
    status: list[str]
    """outcome of each phase pair"""
    error_message: Text
    """what went wrong, or empty"""
    cost: float
    """compute time of the spatial model, s"""
    torsion: list[list[Number]]
    """largest rotation about the vertical by phase pair and body, rad, of an uneven variation; else empty"""


class ValidityRange(Part):
    """Where mu of one body stays within a fraction of the translational result, on one line of variations."""

    scene: Text
    """name of the scene"""
    body: int
    """number of the body; 1 is the platform"""
    share: float
    """largest relative change"""
    key: Literal["ring", "height", "offset", "yaw"]
    """what varies: ring, m; height, as a multiple of the stated one; offset, m along x and y; or yaw, rad"""
    holds: float | None
    """last value up to which every value tried stays within; null if none does"""
    fails: float | None
    """first value tried that does not; null if all do"""


class Assumptions(Part):
    """How far the paper's assumptions carry."""

    assumptions: list[Assumption]
    """what the paper assumes"""
    phases: list[Phases]
    """phase pairs (alpha1, alpha2), rad"""
    duration: float
    """duration of the motion, s"""
    cells: list[AssumptionCell]
    """one per scene and variation"""
    ranges: list[ValidityRange]
    """what the cells allow to say"""


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


class Spike(Part):
    """mu_1 of the literal integration of (4.6) over its step."""

    steps: list[float]
    """steps, s; none where it could not be computed"""
    counted: list[list[Number]]
    """for each step mu_1 at each phase pair, with the instants at which slip begins"""
    left_out: list[list[Number]]
    """the same without these instants"""
    starts: list[list[int]]
    """how many these are"""
    limit: list[Number]
    """mu_1 of the reference at each phase pair, with (4.6) as its condition of rest alone"""


class Claims(Part):
    """The paper's statements about its figures, held against readings of the scenes."""

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
