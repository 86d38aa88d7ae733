"""
The paper's assumptions (i)-(vi): what the engine's models do with each, and how far they carry.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import xarray as xr

from comparison.analyses.assumptions.variations import (
    DURATION,
    FEW,
    PHASES,
    UNDER_LOAD,
    AssumptionCell,
    ValidityRange,
    Variation,
    arguments,
    cell_of,
    ranges,
    varied,
    without_value,
)
from comparison.result_types import Phases, result
from comparison.runner.analysis import Analysis
from comparison.runner.task import Task
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from reference.problem import Scene


@result
class Assumption:
    """One of the paper's assumptions (i) to (vi)."""

    number: str
    """of the paper"""
    statement: str
    """what the paper assumes"""
    engine: str
    """what the engine's models do with it"""
    relaxed: Literal["yes", "partly", "no"]
    """whether the engine's models drop it"""


ASSUMPTIONS = (
    Assumption(
        "(i)",
        "all supports touch the platform along one circle",
        "The circle stays, its radius and the number of supports are free. In the translational model neither matters, "
        "because every support sees the same slip and the loads only enter by their sum.",
        "partly",
    ),
    Assumption(
        "(ii)",
        "the centers of mass lie on one axis through the center of the circle",
        "Kept by the equations and the translational model. Dropped in the spatial model where a scene states "
        "the offset of a center of mass or positions of supports: links stand on the axis, so eccentric bodies turn "
        "about it. The heights above the contacts, which the paper's equations do not contain, are free.",
        "yes",
    ),
    Assumption(
        "(iii)",
        "the principal axes of inertia of all bodies are parallel",
        "Kept by the equations and the translational model. Dropped in the spatial model where a scene states "
        "the yaw of a body: its box and the directions of its link's stiffness are turned. Moments of inertia, which "
        "do not enter translation, follow from masses and sizes.",
        "yes",
    ),
    Assumption(
        "(iv)",
        "flexible bars that neither stretch nor move vertically",
        "Bars stretch by 1e-5 rho under the weight of all bodies and bend likewise, so that every body has its own "
        "vertical motion. Real clamped bars shorten by 0.6 u^2/l when they sway by u, ten times the rise of the "
        "pendulum, and become softer by the weight. The spatial model has both where a scene states the "
        "axial stiffness of its bars; else it is the weakest assumption of the study.",
        "partly",
    ),
    Assumption(
        "(v)",
        "friction acts at the contacts of supports and depressions only",
        "Kept, but every support has a contact force and a slip velocity of its own, so that friction can twist the "
        "platform. The balls stand still on the plate, as in the paper.",
        "partly",
    ),
    Assumption(
        "(vi)",
        "the bodies move translationally",
        "Dropped: six degrees of freedom for every body, contacts that open. What this changes grows with the heights "
        "over the radius of the ring. With all heights zero the weight of the bodies above the platform still shifts "
        "with their displacement, and friction twists the platform.",
        "yes",
    ),
)


@result
class Validity:
    """How far the paper's assumptions hold."""

    assumptions: tuple[Assumption, ...]
    """what the paper assumes"""
    phases: tuple[Phases, ...]
    """phase pairs (alpha1, alpha2), rad"""
    duration: float
    """duration of the motion, s"""
    cells: tuple[AssumptionCell, ...]
    """one per scene and variation"""
    ranges: tuple[ValidityRange, ...]
    """what the cells allow to say"""


def lines(scene: Scene, cells: Sequence[AssumptionCell]) -> list[str]:
    """One line per body, share and direction, and those of uneven variations and loaded bars."""
    return [describe(validity) for validity in ranges(scene, cells)] + uneven_lines(scene, cells)


def uneven_lines(scene: Scene, cells: Sequence[AssumptionCell]) -> list[str]:
    """One line per uneven variation, and one on bars under load, from the cells of a scene."""
    uneven = [describe_torsion(scene, cell) for cell in cells if cell.variation.is_uneven]
    return uneven + describe_shortening([cell for cell in cells if cell.variation in UNDER_LOAD])


@dataclass(frozen=True)
class Assumptions(Analysis[Validity]):
    """How far the assumptions hold in the scenes of a study: a few variations, or as many as a command asks for."""

    key, stage = "assumptions", "assumptions"
    variations: Sequence[Variation] = FEW

    def tasks(self, study: Study, surfaces: xr.Dataset | None = None) -> list[Task]:
        """The translational model and every variation of the spatial one, for every scene to which both apply."""
        return [
            Task(varied, argument, self.stage, about=argument[0], needs_compiled_reference=False)
            for argument in arguments(study, self.variations)
        ]

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> Validity | None:
        """The cells; None if no scene has both models of the engine."""
        solved = [(task.argument, results.value(task, without_value)) for task in self.tasks(study)]
        plain = {scene.name: of_scene for (scene, _, variation, _), of_scene in solved if variation is None}
        cells = tuple(
            cell_of(scene, variation, spatial, plain[scene.name])
            for (scene, _, variation, _), spatial in solved
            if variation is not None
        )
        if not cells:
            return None
        phases = tuple((float(first), float(second)) for first, second in PHASES)
        within = tuple(validity for scene in study.scenes for validity in ranges(scene, cells))
        return Validity(ASSUMPTIONS, phases, DURATION, cells, within)


def describe(validity: ValidityRange) -> str:
    """One line for people: where mu_i stays within a share of the translational result."""
    what = f"mu_{validity.body} stays within {100.0 * validity.share:g} %"
    if validity.key == "ring":
        if validity.holds is None:
            return f"{what} at no ring tried, up to {validity.fails:g} m"
        fails = "every smaller one tried too" if validity.fails is None else f"no longer at {validity.fails:g} m"
        return f"{what} with rings from {validity.holds:g} m, {fails}"
    if validity.key in ("offset", "yaw"):
        stated, moved, unit = "angles", "bodies and links turned", "rad"
        if validity.key == "offset":
            stated, moved, unit = "offsets", "centers of mass moved along x and along y", "m"
        if validity.holds is None:
            return f"{what} at none of the {stated} tried, not even the stated ones"
        if validity.holds == 0.0:
            return f"{what} with the stated {stated}, no longer with {moved} by {validity.fails:g} {unit}"
        fails = "the largest tried" if validity.fails is None else f"no longer by {validity.fails:g} {unit}"
        return f"{what} with {moved} by up to {validity.holds:g} {unit}, {fails}"
    if validity.holds is None:
        return f"{what} at no heights tried"
    fails = "the largest tried" if validity.fails is None else f"no longer at {validity.fails:g} times"
    return f"{what} with heights up to {validity.holds:g} times the stated ones, {fails}"


def describe_shortening(loaded: Sequence[AssumptionCell]) -> list[str]:
    """One line on assumption (iv): what it changes that bars shorten as they sway; none without both of UNDER_LOAD."""
    if len(loaded) != len(UNDER_LOAD):
        return []
    softened, shortened = (1.0 + np.array(cell.change) for cell in loaded)
    change = np.abs(shortened / softened - 1.0).max(axis=0)
    error = np.hypot(*(np.array(cell.uncertainty) for cell in loaded)).max(axis=0)
    if not np.isfinite(change).all():
        return ["no value says what it changes that bars shorten as they sway"]
    pairs = enumerate(zip(change, error), start=1)
    changes = ", ".join(
        f"mu_{body} by up to {100.0 * size:.2g} ± {100.0 * about:.1g} %" for body, (size, about) in pairs
    )
    return [f"bars that shorten as they sway, and not only soften under the weight, change {changes}"]


def describe_torsion(scene: Scene, cell: AssumptionCell) -> str:
    """One line for people: what an uneven variation changes, and how far its bodies turn about the vertical."""
    moved = [f"off the axis by {cell.variation.offset * (scene.support_radius or 0.0):g} m along x and y"]
    turned = [f"with their links at {cell.variation.yaw:g} rad to the axes"]
    where = " and ".join((moved if cell.variation.offset else []) + (turned if cell.variation.yaw else []))
    bodies = range(1, len(scene.bodies) + 1)
    changes = ", ".join(f"mu_{body} by up to {100.0 * cell.largest(body):.2g} %" for body in bodies)
    turns = np.array(cell.torsion)
    known = turns.shape == (len(PHASES), len(scene.bodies)) and np.isfinite(turns).all()
    unknown = f"no motion says how far they turn{f' ({cell.error_message})' if cell.error_message else ''}"
    torsion = f"they turn by up to {1e3 * turns.max():.3g} mrad" if known else unknown
    return f"the bodies above the platform {where} change {changes}; {torsion}"
