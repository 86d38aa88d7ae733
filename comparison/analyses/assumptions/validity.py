"""The paper's assumptions (i)-(vi): what the engine's models do with each, and how far they carry."""

import itertools
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal, get_args

import numpy as np
import xarray as xr

from comparison.analyses.mapped import MappedAnalysis
from comparison.result_types import Array, Number, Phases, Text, result
from comparison.runner.task import TaskResult
from comparison.runner.task_results import TaskResults
from comparison.study.batches import imported
from comparison.study.models import Model, models_of
from comparison.study.study import Study
from reference.measures import demands
from reference.measures.demands import ANSWERED
from reference.problem import Scene, Trajectory, ground_peak, untilted

PHASES = np.array([(0.0, 0.0), (0.3, 1.1), (2.0, 0.7)])  # rad; the first is where turning tells most in fig3-I
DURATION = 6.0  # s: the loading is strongest in its first seconds
WITHIN = (0.01, 0.05)  # of mu_i
CLOSE_ENOUGH = 0.2 * WITHIN[0]  # relative error of mu_i that says whether it stays within: no smaller one is asked for


@result
class Variation:
    """The scene with another ring of supports and other heights, uneven, or on loaded bars."""

    ring: Annotated[float, "radius of the ring, as a multiple of the stated one"] = 1.0
    height: Annotated[float, "heights of the bodies, as multiples of the stated ones"] = 1.0
    supports: Annotated[int | None, "number of supports; null for the stated one"] = None
    offset: float = 0.0
    """by which centers of mass above the platform are moved along x and along y, over the radius of the ring"""
    yaw: Annotated[float, "by which bodies above the platform and their links are turned about the vertical, rad"] = 0.0
    bars: Literal["softening", "shortening"] | None = None
    """what the weight above does to bars that give way: softening or shortening; null as stated"""

    @property
    def is_uneven(self) -> bool:
        """Whether centers of mass leave the axis, or bodies and links their common directions."""
        return self.offset != 0.0 or self.yaw != 0.0

    @property
    def is_usual(self) -> bool:
        """Whether it only varies the ring and the heights."""
        return self.supports is None and not self.is_uneven and self.bars is None

    def of(self, scene: Scene) -> Scene:
        """The scene with this variation."""
        radius, stated = float(scene.support_radius or np.nan), scene.isolator.supports
        values: dict[str, Any] = {"isolator.supports": self.supports or stated, "isolator.ring": radius * self.ring}
        if isinstance(stated, list) and self.supports is None:
            values = {"isolator.supports": self.ring * np.array(stated)}
        for number, body in enumerate(scene.bodies):
            values[f"bodies.{number}.height"] = float(body.height or 0.0) * self.height
            if number and self.offset:
                values[f"bodies.{number}.offset"] = scene.offsets[number] + self.offset * radius
            if number and self.yaw:
                values[f"bodies.{number}.yaw"] = float(scene.yaws[number] + self.yaw)
            if self.bars and body.bars is not None:
                gives_way = body.bars.axial_stiffness is not None
                values[f"bodies.{number}.bars.load_effect"] = self.bars if gives_way else "softening"
        return scene.with_values(values)


FEW = (
    *(Variation(ring=ring) for ring in (0.5, 1.0, 2.0)),
    *(Variation(height=height) for height in (0.0, 0.25, 0.5)),
    Variation(offset=0.1),  # a twentieth of the width: what codes take for accidental
    Variation(yaw=0.2),
)
MANY = (
    *(Variation(ring, height) for ring in (0.5, 1.0, 2.0, 4.0, 8.0) for height in (0.0, 0.25, 0.5, 1.0)),
    *(Variation(ring, 2.0) for ring in (1.0, 2.0, 4.0, 8.0)),  # on the narrowest ring the scenes would topple
    Variation(supports=3),
    *(Variation(offset=offset) for offset in (0.025, 0.05, 0.1, 0.2)),
    *(Variation(yaw=yaw) for yaw in (0.05, 0.1, 0.2, 0.4)),
)

UNDER_LOAD = (Variation(bars="softening"), Variation(bars="shortening"))  # of scenes whose bars give way


@result
class AssumptionCell:
    """The spatial model of one variation against the translational model."""

    scene: Annotated[Text, "name of the scene"]
    variation: Annotated[Variation, "what is varied"]
    change: Annotated[tuple[tuple[Number, ...], ...], "relative change of mu by phase pair and body"]
    uncertainty: Annotated[tuple[tuple[Number, ...], ...], "of the change, the two error estimates together"]
    status: Annotated[tuple[str, ...], "outcome of each phase pair"]
    error_message: Annotated[Text, "what went wrong, or empty"] = ""
    cost: Annotated[float, "compute time of the spatial model, s"] = 0.0
    torsion: tuple[tuple[Number, ...], ...] = ()
    """largest rotation about the vertical by phase pair and body, rad, of an uneven variation; else empty"""

    def largest(self, body: int) -> float:
        """Largest |change| of mu_i over the phase pairs; NaN if one has no value: nothing is claimed then."""
        return float(np.abs([row[body - 1] for row in self.change]).max())

    def error_estimate(self, body: int) -> float:
        """Largest uncertainty of mu_i over the phase pairs; NaN likewise."""
        return float(np.max([row[body - 1] for row in self.uncertainty]))

    def holds(self, body: int, share: float) -> bool:
        """Whether mu_i stays within `share` at every phase pair, uncertainty included."""
        return self.largest(body) + self.error_estimate(body) <= share


Axis = Literal["ring", "height", "offset", "yaw"]


@result
class ValidityRange:
    """Where mu of one body stays within a fraction of the translational result, on one line of variations."""

    scene: Annotated[Text, "name of the scene"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    share: Annotated[float, "largest relative change"]
    key: Annotated[Axis, "what varies: ring, m; height, times the stated one; offset, m along x and y; or yaw, rad"]
    holds: Annotated[float | None, "last value up to which every value tried stays within; null if none does"]
    fails: Annotated[float | None, "first value tried that does not; null if all do"]


Arguments = tuple[Scene, Model, Variation | None, float]
Rows = tuple[tuple[float, ...], ...]  # by phase pair and body


@dataclass(frozen=True)
class Solved:
    """mu (M, N) at PHASES, its errors, statuses, what went wrong, or "", the cost, s, and torsion as `Cell` has it."""

    mu: Array
    error: Array
    status: tuple[str, ...]
    error_message: str
    cost: float
    torsion: Rows = ()

    def __post_init__(self) -> None:
        if self.mu.ndim != 2 or self.error.shape != self.mu.shape or len(self.status) != len(self.mu):
            raise ValueError(f"mu {self.mu.shape}, error {self.error.shape}, {len(self.status)} statuses")


def varied(task: Arguments) -> Solved:
    """One variation at PHASES. Runs inside a worker process."""
    scene, model, variation, tolerance = task
    short = scene.with_values({"duration": min(scene.duration, DURATION)})
    changed = short if variation is None else variation.of(short)
    without_torsion = ""
    if variation is not None and variation.is_uneven and model.trajectory is not None:
        try:
            return _moved(changed, model, tolerance)
        except Exception as error:  # the factors are known without motions
            without_torsion = f"no motion: {type(error).__name__}: {error}"
    whole = {"full": True} if untilted(changed) else {}  # a check of assumption (vi) must not make use of it
    result = imported(model.amplification)(changed, PHASES, **model.settings, tolerance=tolerance, **whole)
    return Solved(result.mu, result.error, tuple(map(str, result.status)), without_torsion, float(result.cost))


def _moved(scene: Scene, model: Model, tolerance: float) -> Solved:
    """The same from whole motions, which show how far the bodies turn; NaN where one ends early."""
    clock = time.process_time()
    trajectory: Callable[..., Trajectory] = imported(str(model.trajectory))
    motions = [trajectory(scene, phase, **model.settings, tolerance=tolerance) for phase in PHASES]
    nothing = (np.full(len(scene.bodies), np.nan),) * 2
    rows = [(m.peak, m.accuracy.peak_error) if m.status in ANSWERED and m.accuracy else nothing for m in motions]
    peaks, errors = np.moveaxis(np.array(rows), 1, 0) / ground_peak(scene, PHASES)[:, None]
    turns = tuple(tuple(turn.value for turn in demands(motion).torsion or ()) for motion in motions)
    status, cost = tuple(str(motion.status) for motion in motions), time.process_time() - clock
    return Solved(peaks, errors, status, "", cost, turns)


def _without_value(task: Arguments, failed: TaskResult) -> Solved:
    nothing = np.full((len(PHASES), len(task[0].bodies)), np.nan)
    return Solved(nothing, nothing, (failed.outcome.value,) * len(PHASES), failed.error_message, 0.0)


def ranges(scene: Scene, cells: Sequence[AssumptionCell]) -> list[ValidityRange]:
    """
    Where every mu_i stays within each share of WITHIN, over rings, heights, offsets and angles, all else as stated.

    cells: those of other scenes are left out. Offsets and angles are there only where one was tried.
    """
    lines: dict[Axis, list[tuple[float, AssumptionCell]]] = {}
    of_scene = [cell for cell in cells if cell.scene == scene.name]
    for key in get_args(Axis):
        unit = scene.support_radius or float("nan") if key in ("ring", "offset") else 1.0
        stated = getattr(Variation(), key)
        varied_alone = [cell for cell in of_scene if replace(cell.variation, **{key: stated}) == Variation()]
        line = [(getattr(cell.variation, key) * unit, cell) for cell in varied_alone]
        if any(value for value, _ in line):  # as stated, offset and yaw are 0
            lines[key] = sorted(line, key=lambda pair: pair[0], reverse=key == "ring")
    return [
        ValidityRange(scene.name, body, share, key, *_bracket(line, body, share))
        for body in range(1, len(scene.bodies) + 1)
        for share in WITHIN
        for key, line in lines.items()
    ]


def _bracket(line: Sequence[tuple[float, AssumptionCell]], body: int, share: float) -> tuple[Any, Any]:
    """The last value up to which all hold, and the first that does not; None without."""
    held = [value for value, _ in itertools.takewhile(lambda pair: pair[1].holds(body, share), line)]
    return next(reversed(held), None), next((value for value, _ in line[len(held) :]), None)


@result
class Assumption:
    """One of the paper's assumptions (i) to (vi)."""

    number: Annotated[str, "of the paper"]
    statement: Annotated[str, "what the paper assumes"]
    engine: Annotated[str, "what the engine's models do with it"]
    relaxed: Annotated[Literal["yes", "partly", "no"], "whether the engine's models drop it"]


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

    assumptions: Annotated[tuple[Assumption, ...], "what the paper assumes"]
    phases: Annotated[tuple[Phases, ...], "phase pairs (alpha1, alpha2), rad"]
    duration: Annotated[float, "duration of the motion, s"]
    cells: Annotated[tuple[AssumptionCell, ...], "one per scene and variation"]
    ranges: Annotated[tuple[ValidityRange, ...], "what the cells allow to say"]


def uneven_lines(scene: Scene, cells: Sequence[AssumptionCell]) -> list[str]:
    """One line per uneven variation, and one on bars under load, from the cells of a scene."""
    uneven = [describe_torsion(scene, cell) for cell in cells if cell.variation.is_uneven]
    return uneven + describe_shortening([cell for cell in cells if cell.variation in UNDER_LOAD])


@dataclass(frozen=True)
class Assumptions(MappedAnalysis[Validity]):
    """How far the assumptions hold in the scenes of a study: a few variations, or as many as a command asks for."""

    key, stage, needs_compiled_reference = "assumptions", "assumptions", False
    function, without_value = staticmethod(varied), staticmethod(_without_value)
    variations: Sequence[Variation] = FEW

    def arguments(self, study: Study, surfaces: xr.Dataset | None = None) -> Iterator[Arguments]:
        """
        The translational model and every variation of the spatial one, of every scene with phases that has both.

        UNDER_LOAD is added where bars give way. Yields scene, model, variation (None: the scene itself), tolerance.
        """
        for scene in study.phased:
            models = models_of(scene, study.hierarchy)
            engines = [model for model in models if model.side == "engine" and "softened" not in model.settings]
            loaded = UNDER_LOAD if any(link is not None for link in scene.bar_links) else ()
            for model, variations in zip(engines, ((None,), (*self.variations, *loaded))) if len(engines) == 2 else ():
                for variation in variations:
                    yield scene, model, variation, max(model.tolerance(study.tolerance), CLOSE_ENOUGH)

    def collect(self, study: Study, surfaces: xr.Dataset | None, results: TaskResults) -> Validity | None:
        """The cells; None if no scene has both models of the engine."""
        cells: list[AssumptionCell] = []
        for (scene, _, variation, _), solved in zip(self.arguments(study), self.values(study, surfaces, results)):
            if variation is None:  # before the variations of its scene
                plain = solved
                continue
            shares = solved.mu / plain.mu - 1.0, np.hypot(solved.error, plain.error) / plain.mu
            change, uncertainty = (tuple(map(tuple, share.tolist())) for share in shares)
            rest = solved.status, solved.error_message or plain.error_message, solved.cost, solved.torsion
            cells.append(AssumptionCell(scene.name, variation, change, uncertainty, *rest))
        if not cells:
            return None
        phases = tuple((float(first), float(second)) for first, second in PHASES)
        within = tuple(validity for scene in study.scenes for validity in ranges(scene, cells))
        return Validity(ASSUMPTIONS, phases, DURATION, tuple(cells), within)


# of a line of variations: where nothing holds; what holds; what does not; where all that was tried holds
WORDS: dict[Axis, tuple[str, str, str, str]] = {
    "ring": ("at no ring tried, up to {fails:g} m", "with rings from {holds:g} m", "no longer at {fails:g} m",
             "every smaller one tried too"),
    "height": ("at no heights tried", "with heights up to {holds:g} times the stated ones",
               "no longer at {fails:g} times", "the largest tried"),
    "offset": ("at none of the offsets tried, not even the stated ones",
               "with centers of mass moved along x and along y by up to {holds:g} m", "no longer by {fails:g} m",
               "the largest tried"),
    "yaw": ("at none of the angles tried, not even the stated ones",
            "with bodies and links turned by up to {holds:g} rad", "no longer by {fails:g} rad", "the largest tried"),
}  # fmt: skip


def describe(validity: ValidityRange) -> str:
    """One line for people: where mu_i stays within a share of the translational result."""
    none, holds, fails, every = WORDS[validity.key]
    where = none if validity.holds is None else f"{holds}, {every if validity.fails is None else fails}"
    return f"mu_{validity.body} stays within {100.0 * validity.share:g} % {where.format(**vars(validity))}"


def describe_shortening(loaded: Sequence[AssumptionCell]) -> list[str]:
    """One line on assumption (iv): what it changes that bars shorten as they sway; none without both of UNDER_LOAD."""
    if len(loaded) != len(UNDER_LOAD):
        return []
    softened, shortened = (1.0 + np.array(cell.change) for cell in loaded)
    change = np.abs(shortened / softened - 1.0).max(axis=0)
    error = np.hypot(*(np.array(cell.uncertainty) for cell in loaded)).max(axis=0)
    if not np.isfinite(change).all():
        return ["no value says what it changes that bars shorten as they sway"]
    numbers = [f"{100.0 * size:.2g} ± {100.0 * about:.1g} %" for size, about in zip(change, error)]
    changes = ", ".join(f"mu_{body} by up to {text}" for body, text in enumerate(numbers, start=1))
    return [f"bars that shorten as they sway, and not only soften under the weight, change {changes}"]


def describe_torsion(scene: Scene, cell: AssumptionCell) -> str:
    """One line for people: what an uneven variation changes, and how far its bodies turn about the vertical."""
    moved = [f"off the axis by {cell.variation.offset * (scene.support_radius or 0.0):g} m along x and y"]
    turned = [f"with their links at {cell.variation.yaw:g} rad to the axes"]
    where = " and ".join((moved if cell.variation.offset else []) + (turned if cell.variation.yaw else []))
    bodies = range(1, len(scene.bodies) + 1)
    changes = ", ".join(f"mu_{body} by up to {100.0 * cell.largest(body):.2g} %" for body in bodies)
    turns = np.array(cell.torsion)
    torsion = "no motion says how far they turn" + (f" ({cell.error_message})" if cell.error_message else "")
    if turns.shape == (len(PHASES), len(scene.bodies)) and np.isfinite(turns).all():
        torsion = f"they turn by up to {1e3 * turns.max():.3g} mrad"
    return f"the bodies above the platform {where} change {changes}; {torsion}"
