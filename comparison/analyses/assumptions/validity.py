"""The paper's assumptions (i)-(vi): what the engine's models do with each, and in which range each holds."""

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal, get_args

import numpy as np
import xarray as xr

from comparison.analyses.assumptions.trials import (
    CHANGE_LIMITS,
    DURATION,
    SUFFICIENT_ERROR,
    Arguments,
    DirectionTrial,
    TaskTrials,
    Trial,
    answer_trials,
    compute_relative_change,
    without_answer,
)
from comparison.analyses.assumptions.variations import (
    DIRECTED,
    FEW,
    UNDER_LOAD,
    Axis,
    Variation,
    blind_by_symmetry,
)
from comparison.result_types import Number, Phases, Text, result
from comparison.runner.mapped_analysis import MappedAnalysis
from comparison.runner.task_results import TaskResults
from comparison.study.models import models_of
from comparison.study.study import Study
from reference.problem import Scene
from reference.problem.readings import AS_INTEGRATED

# rad, phase pairs of a study. Rotation changes the amplification of scene fig3-I most at the first pair, that of
# fig3-II at the second.
PHASES = ((0.0, 0.0), (2.0, 0.7))
MORE_PHASES = (*PHASES, (0.3, 1.1))  # rad, phase pairs of the command `phase-resonance assumptions`
SIZES, MORE_SIZES = 2, 8  # number of sizes of a variation that a study, or the command, tries in its worst direction


@result
class AssumptionCell:
    """
    Change of amplification from the translational model of a scene to the spatial model of the varied scene.

    Both have friction that is linear below a slip speed of 1 mm/s.
    """

    scene: Annotated[Text, "name of the scene"]
    variation: Annotated[Variation, "what is varied"]
    change: Annotated[tuple[tuple[Number, ...], ...], "relative change of mu by phase pair and body"]
    uncertainty: Annotated[tuple[tuple[Number, ...], ...], "of the change, the two error estimates together"]
    status: Annotated[tuple[str, ...], "outcome of each phase pair"]
    error_message: Annotated[Text, "what went wrong, or empty"] = ""
    cost: Annotated[float, "compute time of the spatial model, s"] = 0.0
    no_effect: Text = ""
    """why symmetry leaves the variation without effect: computed at the first phase pair as a control, no evidence"""

    def largest(self, body: int) -> float:
        """Return the largest |change| of a body's amplification over the phase pairs; NaN if a pair has no value."""
        return float(np.abs([row[body - 1] for row in self.change]).max())

    def error_estimate(self, body: int) -> float:
        """Return the largest uncertainty of a body's change of amplification over the phase pairs, or NaN."""
        return float(np.max([row[body - 1] for row in self.uncertainty]))

    def holds(self, body: int, share: float) -> bool:
        """Return whether a body's amplification changes by at most `share`, with uncertainty, at every phase pair."""
        return self.largest(body) + self.error_estimate(body) <= share


@result
class ValidityRange:
    """Range of a varied quantity in which a body's amplification is within `share` of the translational result."""

    scene: Annotated[Text, "name of the scene"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    share: Annotated[float, "largest relative change"]
    key: Axis
    """what varies: ring, m; height, times the stated one; oval, share of the radius; offset, m; yaw, rad"""
    holds: Annotated[float | None, "last value up to which every value tried stays within; null if none does"]
    fails: Annotated[float | None, "first value tried that does not; null if all do"]
    direction: Annotated[float | None, "worst direction of an oval or an offset, rad from x; sign of the worst yaw"] = (
        None
    )
    no_effect: Annotated[Text, "why symmetry leaves every trial without effect: nothing is shown; else empty"] = ""
    no_value: Annotated[bool, "whether mu has no value at `fails`, or an error that hides the limit"] = False


def find_validity_ranges(
    scene: Scene, cells: Sequence[AssumptionCell], directions: Sequence[DirectionTrial] = ()
) -> list[ValidityRange]:
    """
    Return for each quantity, body and limit in CHANGE_LIMITS the range in which the amplification is within the limit.

    Only this quantity varies, in its worst direction. cells, directions: may hold other scenes, which are left out. A
    trial whose effect a symmetry makes zero counts for nothing. A quantity that was not tried has no range.
    """
    found, bodies = [], range(1, len(scene.bodies) + 1)
    for key in get_args(Axis):
        line = list_cells_by_size(scene, cells, key)
        tried = [cell for value, cell in line if value or key not in DIRECTED]
        reasons = [cell.no_effect for cell in tried]
        reasons += [each.no_effect for each in directions if (each.scene, each.key) == (scene.name, key)]
        if not reasons:
            continue
        reason = "" if "" in reasons else reasons[0]
        unit = scene.support_radius or float("nan") if key in ("ring", "offset") else 1.0
        telling = [(value * unit, cell) for value, cell in line if key in DIRECTED or not cell.no_effect]
        direction = direction_of(tried[0].variation, key) if tried and not reason else None
        for body, share in itertools.product(bodies, CHANGE_LIMITS):
            holds, fails, no_value = (None, None, False) if reason else _bracket_share(telling, body, share)
            found.append(
                ValidityRange(
                    scene=scene.name,
                    body=body,
                    share=share,
                    key=key,
                    holds=holds,
                    fails=fails,
                    direction=direction,
                    no_effect=reason,
                    no_value=no_value,
                )
            )
    return found


def list_cells_by_size(scene: Scene, cells: Sequence[AssumptionCell], key: Axis) -> list[tuple[float, AssumptionCell]]:
    """Return the size and the result of each variation of `key` alone, by rising size; rings by falling radius."""
    as_stated = {key: getattr(Variation(), key), "direction": 0.0}
    alone = [c for c in cells if c.scene == scene.name and replace(c.variation, **as_stated) == Variation()]
    line = [(abs(getattr(cell.variation, key)), cell) for cell in alone]
    return sorted(line, key=lambda pair: pair[0], reverse=key == "ring")


def direction_of(variation: Variation, key: Axis) -> float | None:
    """Return the direction of an oval ring or an offset, rad; the sign of a yaw; None for rings and heights."""
    if key not in DIRECTED:
        return None
    return float(np.sign(variation.yaw)) if key == "yaw" else variation.direction


def _bracket_share(line: Sequence[tuple[float, AssumptionCell]], body: int, share: float) -> tuple[Any, Any, bool]:
    """
    Return the bracket of the size at which a body's change of amplification exceeds `share`.

    It is the last size up to which all changes are within `share` (None without any), the next size, whose change is
    beyond or not known (None without any), and whether that is not known. line: sizes with their results, in order.
    """
    held = [value for value, _ in itertools.takewhile(lambda pair: pair[1].holds(body, share), line)]
    fails, cell = line[len(held)] if len(held) < len(line) else (None, None)
    untold = cell is not None and hides_limit(cell.largest(body), cell.error_estimate(body), share)
    return next(reversed(held), None), fails, untold


def hides_limit(size: float, error: float, limit: float) -> bool:
    """Return whether a change is unknown, or has an error so large that one cannot tell if it exceeds the limit."""
    return not math.isfinite(size + error) or (error > limit and size - error <= limit)


@result
class Assumption:
    """One of the paper's assumptions (i) to (vi), and whether the engine's models do without it."""

    number: Annotated[str, "of the paper"]
    statement: Annotated[str, "what the paper assumes"]
    engine: Annotated[str, "what the engine's models do with it"]
    relaxed: Annotated[Literal["yes", "partly", "no"], "whether the engine's models drop it"]
    falsified_by: Annotated[str, "what would have shown that mu does not bear it"]


# The paper's assumptions (i) to (vi), with what the engine's models do with each, and what would refute it
ASSUMPTIONS = (
    Assumption(
        number="(i)",
        statement="all supports touch the platform along one circle",
        engine=(
            "The circle stays, its radius and the number of supports are free. In the translational model neither "
            "matters, because every support sees the same slip and the loads only enter by their sum."
        ),
        relaxed="partly",
        falsified_by=(
            "another radius or number of supports, or a ring narrowed along its worst direction, that changes mu_i by "
            "more than 1 %"
        ),
    ),
    Assumption(
        number="(ii)",
        statement="the centers of mass lie on one axis through the center of the circle",
        engine=(
            "Kept by the equations and the translational model. Dropped in the spatial model where a scene states "
            "the offset of a center of mass or positions of supports: links stand on the axis, so eccentric bodies "
            "turn about it. The heights above the contacts, which the paper's equations do not contain, are free."
        ),
        relaxed="yes",
        falsified_by="centers of mass off the axis, in their worst direction, that change mu_i by more than 1 %",
    ),
    Assumption(
        number="(iii)",
        statement="the principal axes of inertia of all bodies are parallel",
        engine=(
            "Kept by the equations and the translational model. Dropped in the spatial model where a scene states "
            "the yaw of a body: its box and the directions of its link's stiffness are turned. Moments of inertia, "
            "which do not enter translation, follow from masses and sizes."
        ),
        relaxed="yes",
        falsified_by="bodies and links turned about the vertical that change mu_i by more than 1 %",
    ),
    Assumption(
        number="(iv)",
        statement="flexible bars that neither stretch nor move vertically",
        engine=(
            "Bars stretch by 1e-5 rho under the weight of all bodies and bend by as much, so that every body has its "
            "own vertical motion. Real clamped bars shorten by 0.6 u^2/l when they sway by u, ten times the rise of "
            "the pendulum, and become softer by the weight. The spatial model has both where a scene states the axial "
            "stiffness of its bars; else it is the weakest assumption of the study."
        ),
        relaxed="partly",
        falsified_by=(
            "bars that shorten as they sway and change mu_i by more than 1 %: tried only where a scene states their "
            "axial stiffness"
        ),
    ),
    Assumption(
        number="(v)",
        statement="friction acts at the contacts of supports and depressions only",
        engine=(
            "Kept, but every support has a contact force and a slip velocity of its own, so that friction can twist "
            "the platform. The balls stand still on the plate, as in the paper."
        ),
        relaxed="partly",
        falsified_by="friction elsewhere that changes mu_i: not tried, no model has it",
    ),
    Assumption(
        number="(vi)",
        statement="the bodies move translationally",
        engine=(
            "Dropped: six degrees of freedom for every body, contacts that open. What this changes grows with the "
            "heights over the radius of the ring. With all heights zero the weight of the bodies above the platform "
            "still shifts with their displacement, and friction twists the platform."
        ),
        relaxed="yes",
        falsified_by=(
            "mu_i of the spatial model, at the stated ring and heights, more than 1 % from the translational one"
        ),
    ),
)


@result
class Validity:
    """Extent to which the paper's assumptions hold: variations tried, changes of amplification, ranges of validity."""

    assumptions: Annotated[tuple[Assumption, ...], "what the paper assumes"]
    reading: Annotated[str, "reading of (5.1) in which mu is compared"]
    phases: Annotated[tuple[Phases, ...], "phase pairs (alpha1, alpha2), rad"]
    duration: Annotated[float, "duration of the motion, s, of the longest scene"]
    cells: Annotated[tuple[AssumptionCell, ...], "one per scene and variation"]
    directions: Annotated[tuple[DirectionTrial, ...], "one per scene, varied quantity and direction tried"]
    ranges: Annotated[tuple[ValidityRange, ...], "what the cells allow to say"]


@dataclass(frozen=True)
class Assumptions(MappedAnalysis[Validity]):
    """Analysis of the paper's assumptions: it varies each scene and computes how the amplification changes."""

    key, stage, needs_compiled_reference = "assumptions", "assumptions", False
    function, without_value = staticmethod(answer_trials), staticmethod(without_answer)
    # variations: those to compute. phases: pairs at which to compute them, rad. sizes: largest number of sizes in a
    # worst direction. directed: groups of quantities to vary in their worst directions, one task for each group.
    variations: Sequence[Variation] = FEW
    phases: tuple[Phases, ...] = PHASES
    sizes: int = SIZES
    directed: Sequence[tuple[Axis, ...]] = (DIRECTED,)

    def task_arguments(self, study: Study, surfaces: xr.Dataset | None = None) -> Iterator[Arguments]:
        """
        Yield the arguments of the tasks of each scene that has two frequencies and a spatial model.

        The first task is the scene as stated by the translational model (None). One task for each variation by the
        spatial model follows, among them UNDER_LOAD where bodies stand on bars. The last tasks are groups of
        quantities, of which several sizes are tried in the worst direction.
        """
        for scene in study.phased:
            models = models_of(scene, study.hierarchy)
            engines = [model for model in models if model.side == "engine" and "softened" not in model.settings]
            if len(engines) != 2:
                continue
            loaded = UNDER_LOAD if any(link is not None for link in scene.bar_links) else ()
            directed = [tuple(key for key in keys if key == "oval" or len(scene.bodies) > 1) for keys in self.directed]
            translational, spatial = engines
            tolerance = max(spatial.tolerance(study.tolerance), SUFFICIENT_ERROR)
            for what in (None, *self.variations, *loaded, *filter(None, directed)):
                yield scene, (translational, spatial), what, tolerance, self.phases, self.sizes

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> Validity | None:
        """Return the changes of amplification and the ranges of validity; None if no scene has a spatial model."""
        cells: list[AssumptionCell] = []
        directions: list[DirectionTrial] = []
        answers: list[TaskTrials] = self.values(study, surfaces, results)
        for (scene, _, what, *_), answer in zip(self.task_arguments(study), answers):
            if what is None:  # translational model of the scene as stated; comes before the variations of this scene
                (plain,) = answer.trials
                continue
            cells += [_make_cell(scene, trial, plain) for trial in answer.trials]
            directions += answer.directions
        if not cells:
            return None
        within = tuple(
            validity for scene in study.scenes for validity in find_validity_ranges(scene, cells, directions)
        )
        duration = min(DURATION, max(scene.duration for scene in study.scenes))
        return Validity(
            assumptions=ASSUMPTIONS,
            reading=AS_INTEGRATED,
            phases=self.phases,
            duration=duration,
            cells=tuple(cells),
            directions=tuple(directions),
            ranges=within,
        )


def _make_cell(scene: Scene, trial: Trial, plain: Trial) -> AssumptionCell:
    """
    Return the change of amplification from the translational model, `plain`, to a trial of the spatial one.

    If symmetry makes the change zero and it is within its uncertainty, the result says why.
    """
    assert trial.variation is not None, "only the translational model has none"
    change, uncertainty = compute_relative_change(trial, plain)
    blind = blind_by_symmetry(scene, trial.variation) if (np.abs(change) <= uncertainty).all() else ""
    return AssumptionCell(
        scene=scene.name,
        variation=trial.variation,
        change=tuple(map(tuple, change.tolist())),
        uncertainty=tuple(map(tuple, uncertainty.tolist())),
        status=trial.status,
        error_message=trial.error_message or plain.error_message,
        cost=trial.cost,
        no_effect=blind,
    )
