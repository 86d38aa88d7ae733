"""
Which models, grids and tolerances a study takes: the one place where `--tolerance` and `--budget` are decided.

A tolerance is met by the cheapest setting of every model that met it at 99 % of the recorded points, by its own error
estimate and in truth; a tighter one that costs hardly more is taken instead. A model that cannot meet it is left out. A
budget is spent along AMBITIONS: the last study that fits.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from comparison.study.accuracy_record import recorded
from comparison.study.costs import Costs, costs, known
from comparison.study.models import LADDER, Rung
from comparison.study.overhead import START_UP, WRITING
from comparison.study.study import Study
from reference.problem import Scene

HARDLY_MORE = 1.05  # times the cheapest cost: a setting that tightens the tolerance for so little is taken
DEFAULT_TOLERANCE = 1e-3


@dataclass(frozen=True)
class Ambition:
    """
    A study that a budget may buy. grid: phases per axis of the equations. translational, spatial: the most of the
    engine's models, 0 without. whole: with all that the report tells beside the surfaces. tolerance: asked.
    """

    grid: int
    translational: int
    spatial: int
    whole: bool
    tolerance: float = DEFAULT_TOLERANCE


AMBITIONS = (  # each costs more than the one before
    Ambition(4, 0, 0, False),
    Ambition(8, 0, 0, False),
    Ambition(16, 0, 0, False),
    Ambition(16, 2, 0, False),
    Ambition(16, 4, 0, False),
    Ambition(16, 4, 2, False),
    Ambition(32, 8, 2, False),
    Ambition(32, 8, 4, False),
    Ambition(48, 16, 4, False),
    Ambition(48, 16, 4, True),
    Ambition(48, 16, 4, True, 1e-4),
    Ambition(96, 32, 8, True, 1e-4),
)
DEFAULT = AMBITIONS.index(Ambition(48, 16, 4, True))


def nothing(study: Study, whole: bool) -> float:
    return 0.0


@dataclass(frozen=True)
class Asked:
    """
    What the user asks of a study. tolerance, budget (s of the whole run), grid: None where that is left to us. beside:
    processor time of what workers do besides its surfaces, s, and whether that is all of it.
    """

    scenes: tuple[Scene, ...]
    ladder: Sequence[Rung] = LADDER
    tolerance: float | None = None
    budget: float | None = None
    grid: int | None = None
    jobs: int = 1
    full: bool = False
    beside: Callable[[Study, bool], float] = nothing

    @property
    def chosen_by_trade(self) -> bool:
        """Whether the measured trade is to choose, and this machine to be measured for it."""
        return self.tolerance is not None or self.budget is not None


@dataclass(frozen=True)
class Choice:
    """
    study: what is computed. whole: whether with all that the report tells beside the surfaces. left_out: models that
    cannot meet the tolerance or do not fit, a line each. compute: processor time of the surfaces expected, s; wall: of
    the whole run with all workers.
    """

    study: Study
    whole: bool
    left_out: tuple[str, ...]
    compute: float
    wall: float


class BudgetError(ValueError):
    """Nothing fits. `str(error)` is one line."""


def choice(asked: Asked) -> Choice:
    """
    The cheapest study that meets the tolerance asked, or the most ambitious that fits the budget. Raises BudgetError.
    """
    begin = time.monotonic()
    measured = costs(asked.scenes, asked.ladder, asked.chosen_by_trade, asked.full)
    if asked.budget is None:
        return _made(AMBITIONS[DEFAULT], asked, measured)
    allowed = [one for one in AMBITIONS if asked.tolerance is None or one.tolerance == DEFAULT_TOLERANCE]
    spent = time.monotonic() - begin
    made = [_made(one, asked, measured) for one in allowed]
    fitting = [one for one in made if one.wall + spent <= asked.budget]
    if not fitting:
        least = made[0].wall + spent
        raise BudgetError(
            f"the smallest study of {_count(asked.scenes)} takes about {least:.0f} s here with {asked.jobs} "
            f"worker{'' if asked.jobs == 1 else 's'}: give that, or fewer scenes"
        )
    return fitting[-1]


def _count(scenes: Sequence[Scene]) -> str:
    return f"{len(scenes)} scenes" if len(scenes) > 1 else scenes[0].name


def _made(ambition: Ambition, asked: Asked, measured: Costs) -> Choice:
    """The study of one ambition, with what it costs."""
    tolerance = ambition.tolerance if asked.tolerance is None else asked.tolerance
    grid = asked.grid or ambition.grid
    rungs, left_out = [], []
    for rung in asked.ladder:
        most = {"translational": ambition.translational, "spatial": ambition.spatial}.get(rung.key)
        if asked.budget is not None and most is not None and known(rung):
            rung = replace(rung, most=most)
        if rung.most == 0:
            left_out.append(f"{rung.title}: does not fit the budget")
        elif known(rung) and tolerance < recorded().reach[rung.key].tightest:
            tightest = recorded().reach[rung.key].tightest
            left_out.append(
                f"{rung.title}: cannot meet {tolerance:.0e}, the tightest it is known to meet is {tightest:.0e}"
            )
        else:
            rungs.append(replace(rung, asks=setting(rung, rung.tolerance(tolerance))) if known(rung) else rung)
    seconds = {
        (scene.name, rung.key): cost
        for scene in asked.scenes
        for rung in rungs
        if (cost := measured.of(scene, rung, rung.tolerance(tolerance))) is not None
    }
    study = Study(asked.scenes, grid, tolerance, rungs, asked.full, seconds)
    compute = sum(study.seconds(rung) for rung in rungs)
    workers = compute + asked.beside(study, ambition.whole) * measured.speed
    wall = (START_UP + WRITING) * measured.speed + workers / asked.jobs
    return Choice(study, ambition.whole, tuple(left_out), compute, wall)


def setting(rung: Rung, tolerance: float) -> float:
    """What to ask of a model so that `tolerance` is met: the cheapest, or a tighter one that is hardly dearer."""
    reach = recorded().reach[rung.key]
    able = [tolerance] + [one for one, met in zip(reach.tolerances, reach.met) if met and one < tolerance]
    cheapest = min(reach.cost(one) for one in able)
    return min(one for one in able if reach.cost(one) <= HARDLY_MORE * cheapest)


def tightest() -> float:
    """The tightest tolerance that any model is known to meet."""
    return min(reach.tightest for reach in recorded().reach.values())
