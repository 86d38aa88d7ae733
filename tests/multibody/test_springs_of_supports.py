"""Which springs the supports of an answer stand on, with a function of the level in place of runs of the engine."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import multibody
from multibody.integration.adaptive import Budget, EngineRun
from multibody.integration.estimate import ERROR_PER_WARPING_LOAD, SAFETY_OF_BEARINGS
from multibody.integration.level import COMPLIANCE_OF_CLOSED, COMPLIANCE_RATIO, REAL_WARPING_COMPLIANCE, Level
from multibody.integration.level_runs import MAX_FIRST_SHARE
from multibody.integration.one_run import PhasePair
from multibody.integration.peak import Peaks
from multibody.integration.refine import Refinement, refine
from multibody.models.supports import MIN_WARPING_COMPLIANCE
from reference.problem import Outcome, load_scene

TOLERANCE = 1e-3
STIFF, REAL = MIN_WARPING_COMPLIANCE, REAL_WARPING_COMPLIANCE
STEPS = 1000  # of every run
SCENE = load_scene("fig3-I")
# of a contact that gets stiffer from level to level, and whose forces do not round
LEVELS = [
    replace(level, penetration=1e-6 / COMPLIANCE_RATIO**number, rounding_moment=1e-20)
    for number, level in enumerate(multibody.levels(SCENE, tolerance=TOLERANCE))
]
MODEL: Any = SimpleNamespace(
    bodies=np.zeros((2, 3), int),
    units=SimpleNamespace(time=1.0, acceleration=1.0),
    ground=SimpleNamespace(knots=np.empty(0)),
    corner=math.inf,
    relaxation=1.0,
    friction=None,
    depressions=SimpleNamespace(),
    warping_displacement=lambda coordinates: coordinates,
)


def result(
    platform: float, *, opens: bool = True, outcome: Outcome = Outcome.OK, load: float = 0.0, steps: int = STEPS
) -> EngineRun:
    """A run with this peak of the platform; that of the other body is always 2."""
    run = EngineRun(Peaks(2, math.inf), math.inf, work=steps, warping_load=load)
    run.peaks.value[:] = platform, 2.0
    run.peaks.instant[:] = 0.2, 0.3
    run.last_open = 0.5 if opens else -math.inf
    return run if outcome == Outcome.OK else run.terminated(outcome, 0.7)


@dataclass
class Refined:
    """A refinement, and the runs that it asked for."""

    answer: Refinement
    asked: list[tuple[int, float]] = field(default_factory=list)  # number of the level, and how far supports give way
    work: list[float] = field(default_factory=list)  # steps that each run was allowed


@pytest.fixture
def refined(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Refined]:
    """Refine with runs that are a function of the number of the level and of how far supports give way."""

    def refine_on(runs: Callable[[int, float], EngineRun], levels: int = 6, max_work: float = 1e9) -> Refined:
        done = Refined(answer=None)  # type: ignore[arg-type]

        def at_level(pair: PhasePair, level: Level, budget: Budget, *given: Any, **more: Any) -> EngineRun:
            number = [other.step for other in LEVELS].index(level.step)
            done.asked.append((number, level.warping_compliance))
            done.work.append(budget.left)
            run = runs(number, level.warping_compliance)
            budget.left -= run.work
            return run

        monkeypatch.setattr(PhasePair, "at_level", at_level)
        phase = np.array([0.3, 1.1])
        done.answer = refine(SCENE, MODEL, phase, TOLERANCE, whole=True, levels=LEVELS[:levels], max_work=max_work)
        return done

    return refine_on


def level_error(number: int) -> float:
    """The relative error of an answer at a level that agrees with the one before."""
    return LEVELS[number].error_floor + 1e-6


def test_an_answer_hardly_changed_by_bearings_stays(refined: Any) -> None:
    changes = [3e-4, 5e-4]
    done = refined(lambda number, springs: result(1.0 + changes[number] * (springs == REAL)))
    assert done.asked == [(0, STIFF), (0, REAL), (1, STIFF), (1, REAL)]
    assert done.answer.outcome == Outcome.OK
    np.testing.assert_allclose(done.answer.peaks, [1.0, 2.0])
    np.testing.assert_allclose(done.answer.errors, [5e-4 + level_error(1), 2.0 * level_error(1)])
    (_, (real, share)) = done.answer.coarser
    assert (real.peaks.value[0], share) == (1.0005, 1.0), "any number of the motion has its change as an error"


def real_from_level_1(number: int, springs: float) -> EngineRun:
    """Real bearings change nothing at level 0, and the order of impacts at all others."""
    return result(1.826 if number > 0 and springs == REAL else 1.893, steps=STEPS + STEPS // 2 * (springs == REAL))


def failing(outcome: Outcome, where: Callable[[int, float], bool], change: float = 0.0) -> Callable[..., EngineRun]:
    """Runs with a peak of 1, which real bearings change, that end with an outcome somewhere."""
    return lambda number, springs: result(
        1.0 + change * (springs == REAL), outcome=outcome if where(number, springs) else Outcome.OK
    )


# runs; number of the level and springs of those asked for; outcome, peak of the platform and its error
PATHS: dict[str, tuple[Any, list[tuple[int, float]], Outcome, float, float]] = {
    "a change without room asks for another level": (
        lambda number, springs: result(1.0 + 9e-4 * (springs == REAL)),
        [(0, STIFF), (0, REAL), (1, STIFF), (2, STIFF), (2, REAL)], Outcome.OK, 1.0, 9e-4 + level_error(2),
    ),
    "where bearings change the peaks levels have them": (
        lambda number, springs: result(1.893 if springs == STIFF else 1.826),
        [(0, STIFF), (0, REAL), (1, REAL)], Outcome.OK, 1.826, 1.826 * level_error(1),
    ),
    "an answer that real bearings change is dropped": (
        real_from_level_1,
        [(0, STIFF), (0, REAL), (1, STIFF), (1, REAL), (2, REAL)], Outcome.OK, 1.826, 1.826 * level_error(2),
    ),
    "a level whose run on bearings ends is confirmed": (
        failing(Outcome.SOLVER_FAILED, lambda number, springs: number == 1 and springs == REAL, 1e-4),
        [(0, STIFF), (0, REAL), (1, STIFF), (1, REAL), (2, STIFF), (2, REAL)], Outcome.OK, 1.0, 1e-4 + level_error(2),
    ),
    "no run on real bearings": (
        failing(Outcome.SOLVER_FAILED, lambda number, springs: springs == REAL),
        [(0, STIFF), (0, REAL), (1, REAL)], Outcome.SOLVER_FAILED, math.nan, math.nan,
    ),
    "of two levels without an answer the finer one says why": (
        lambda number, _: result(1.0, outcome=Outcome.STEP_LIMIT if number == 0 else Outcome.SOLVER_FAILED),
        [(0, STIFF), (0, REAL), (1, REAL)], Outcome.SOLVER_FAILED, math.nan, math.nan,
    ),
    "supports that rattle stand on real bearings": (
        failing(Outcome.STEP_LIMIT, lambda number, springs: number == 0),
        [(0, STIFF), (0, REAL), (1, REAL), (2, REAL)], Outcome.OK, 1.0, level_error(2),
    ),
}  # fmt: skip


@pytest.mark.parametrize(("runs", "asked", "outcome", "platform", "error"), PATHS.values(), ids=PATHS)
def test_levels_and_springs_follow_from_what_runs_say(
    refined: Any, runs: Any, asked: list[tuple[int, float]], outcome: Outcome, platform: float, error: float
) -> None:
    done = refined(runs)
    assert (done.asked, done.answer.outcome) == (asked, outcome)
    np.testing.assert_allclose([done.answer.peaks[0], done.answer.errors[0]], [platform, error])


@pytest.mark.parametrize(("levels", "max_work"), [(2, 1e9), (6, 7.0 * STEPS)], ids=["last level", "end of the work"])
def test_without_a_further_level_bearings_give_the_answer(refined: Any, levels: int, max_work: float) -> None:
    done = refined(real_from_level_1, levels, max_work)
    assert done.asked[-1] == (1, REAL)
    assert done.answer.outcome == Outcome.TOLERANCE_NOT_MET
    np.testing.assert_allclose(done.answer.peaks, [1.826, 2.0])
    np.testing.assert_allclose(done.answer.errors[0], 1.893 - 1.826 + 1.893 * level_error(1))
    assert done.answer.finest.peaks.value[0] == 1.826
    assert done.answer.instant == 0.2, "where the worst peak is"


def test_the_error_on_real_bearings_counts_impacts(refined: Any) -> None:
    def runs(number: int, springs: float) -> EngineRun:
        run = real_from_level_1(number, springs)
        run.impacts = int(number > 0 and springs == REAL)
        return run

    done = refined(runs, 2)
    assert done.answer.errors[1] == pytest.approx(2.0 * 4e-3), "no level before it has the same springs"


@pytest.mark.parametrize("outcome", [Outcome.STEP_LIMIT, Outcome.SOLVER_FAILED])
@pytest.mark.parametrize("so_far", [0.4, 1.05])
def test_an_unconfirmed_answer_has_the_change_twice(refined: Any, outcome: Outcome, so_far: float) -> None:
    def runs(number: int, springs: float) -> EngineRun:
        if number > 0 and springs == REAL:
            return result(so_far, outcome=outcome)
        return result(1.0 + 1e-4 * (springs == REAL))

    done = refined(runs, 2)
    assert done.asked == [(0, STIFF), (0, REAL), (1, STIFF), (1, REAL)]
    assert done.answer.outcome == Outcome.TOLERANCE_NOT_MET
    np.testing.assert_allclose(done.answer.peaks, [1.0, 2.0])
    # the peaks of a run that did not end can only grow
    change = max(SAFETY_OF_BEARINGS * 1e-4, so_far - 1.0)
    np.testing.assert_allclose(done.answer.errors[0], change + level_error(1))


def test_a_motion_that_ends_on_bearings_alone_has_no_value(refined: Any) -> None:
    def runs(number: int, springs: float) -> EngineRun:
        tips = number > 0 and springs == REAL
        return result(1.0, outcome=Outcome.RIM_REACHED if tips else Outcome.OK)

    for levels, last in ((2, (1, REAL)), (6, (2, REAL))):
        done = refined(runs, levels)
        assert done.asked[-1] == last
        assert done.answer.outcome == Outcome.RIM_REACHED
        assert done.answer.instant == 0.7
        assert np.isnan(done.answer.peaks).all()


def test_the_first_run_of_rattling_supports_has_a_share(refined: Any) -> None:
    def runs(number: int, springs: float) -> EngineRun:
        outcome = Outcome.STEP_LIMIT if springs == STIFF else Outcome.OK
        return result(1.0, outcome=outcome)

    done = refined(runs, max_work=1e5)
    assert done.asked == [(0, STIFF), (0, REAL), (1, REAL)]
    assert done.work[:2] == [MAX_FIRST_SHARE * 1e5, 1e5 - STEPS]
    assert done.answer.outcome == Outcome.OK


def test_supports_opened_by_a_misfit_may_give_way_by_more(refined: Any) -> None:
    done = refined(lambda number, springs: result(1.0, opens=springs == STIFF, load=1e-6 / springs))
    assert done.asked == [(0, STIFF), (0, REAL), (1, COMPLIANCE_OF_CLOSED)]


@pytest.mark.parametrize("softest_closed", [0.0, REAL], ids=["open on any", "open on softer ones only"])
def test_supports_opened_on_softer_springs_get_real_bearings(refined: Any, softest_closed: float) -> None:
    def runs(number: int, springs: float) -> EngineRun:
        return result(1.0 + 0.1 * (number == 1), opens=number > 0 and springs > softest_closed, load=4e-7 / springs)

    done = refined(runs)
    assert done.asked[0] == (0, STIFF)
    assert done.asked[1][1] > REAL
    assert {springs for _, springs in done.asked[2:]} == {REAL}
    assert [number for number, _ in done.asked] == [0, 1, *range(1, 5)], "levels 0 and 1 differ: more follow"


@pytest.mark.parametrize("load", [1e-5, 1e-3])
def test_load_that_warping_takes_is_an_error_of_all_numbers(refined: Any, load: float) -> None:
    """Of supports that stay closed on real bearings, as one opened on softer springs."""
    done = refined(lambda number, springs: result(1.0, opens=springs > REAL, load=load))
    assert done.asked == [(0, STIFF), (1, COMPLIANCE_OF_CLOSED), (1, REAL)]
    np.testing.assert_allclose(done.answer.errors[0], level_error(1) + ERROR_PER_WARPING_LOAD * load)
    assert done.answer.floor == max(load, LEVELS[1].error_floor)


def test_no_level_is_begun_without_work_for_its_bearings(refined: Any) -> None:
    done = refined(lambda number, springs: result(1.0 + 9e-4 * (springs == REAL)), max_work=6.5 * STEPS)
    assert done.asked == [(0, STIFF), (0, REAL), (1, STIFF)]
    assert done.answer.outcome == Outcome.TOLERANCE_NOT_MET
    np.testing.assert_allclose(done.answer.errors[0], 9e-4 + level_error(1))
