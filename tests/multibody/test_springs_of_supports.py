"""Which springs the supports of an answer stand on, with a function of the level in place of runs of the engine."""

import math
import re
from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import multibody
from multibody.integration.engine_run import Budget, EngineRun, _record_warping
from multibody.integration.level import (
    COMPLIANCE_OF_CLOSED_SUPPORTS,
    COMPLIANCE_RATIO,
    PHYSICAL_WARPING_COMPLIANCE,
    Level,
)
from multibody.integration.level_runs import MAX_WORK_SHARE_OF_TRIAL, LevelRuns
from multibody.integration.one_run import PhasePair
from multibody.integration.peak import PeakReader
from multibody.integration.refine import _AnswerSearch, refine
from multibody.models.supports import MIN_WARPING_COMPLIANCE
from reference.problem import Outcome, load_scene

TOLERANCE = 1e-3
STIFF, REAL = MIN_WARPING_COMPLIANCE, PHYSICAL_WARPING_COMPLIANCE
SOFTER = -1.0  # in place of how far supports give way: a contact softer than that of the level
NAMES = {STIFF: "s", REAL: "r", COMPLIANCE_OF_CLOSED_SUPPORTS: "c", SOFTER: "~"}
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
    kinematics=None,
    springs=None,
    warping_displacement=lambda coordinates: coordinates,
)


Runs = Callable[[int, float], EngineRun]  # of the number of the level, and how far supports give way


def result(platform: float, *, opens: bool = True, outcome: Outcome = Outcome.OK, **more: Any) -> EngineRun:
    """A run with this peak of the platform; that of the other body is always 2."""
    run = EngineRun(PeakReader(2, math.inf), math.inf, **{"work": STEPS, **more})
    run.peaks.value[:] = platform, 2.0
    run.peaks.instant[:] = 0.2, 0.3
    run.last_open_at = 0.5 if opens else -math.inf
    return run if outcome == Outcome.OK else run.terminate(outcome, 0.7)


@pytest.fixture
def refined(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Any]:
    """Refine with such runs: answer, levels and springs asked for in letters, the springs, the work left to each."""

    def refine_on(
        runs: Runs, levels: int = 6, max_work: float = 1e9, stiffenings: int = 6, of: list[Level] = LEVELS,
        tolerance: float = TOLERANCE,
    ) -> Any:  # fmt: skip
        done = SimpleNamespace(asked="", springs=[], work=[])
        contacts = [LEVELS[min(number, stiffenings)].penetration for number in range(levels)]
        planned = [replace(level, penetration=contact) for level, contact in zip(of, contacts)]

        def run_level(pair: PhasePair, level: Level, budget: Budget, *given: Any, **more: Any) -> EngineRun:
            number = [other.step for other in LEVELS].index(level.step)
            springs = SOFTER if level.penetration > 1.01 * contacts[number] else level.warping_compliance
            done.asked += f" {number}{NAMES.get(springs, '')}"
            done.springs.append(springs)
            done.work.append(budget.steps_left)
            run = runs(number, springs)
            budget.steps_left -= run.work
            return run

        monkeypatch.setattr(PhasePair, "run_level", run_level)
        pair = PhasePair(SCENE, MODEL, np.zeros(2), in_full=True)
        done.answer = refine(pair, tolerance, levels=planned, max_work=max_work)
        done.asked = done.asked.strip()
        return done

    return refine_on


def level_error(number: int) -> float:
    return LEVELS[number].error_floor + 1e-6


def changed_by_bearings(change: float) -> Runs:
    return lambda _, springs: result(1.0 + change * (springs == REAL))


def real_from_level_1(number: int, springs: float) -> EngineRun:
    """Real bearings change nothing at level 0, and the order of impacts at all others."""
    return result(1.826 if number > 0 and springs == REAL else 1.893, work=STEPS + STEPS // 2 * (springs == REAL))


def failing(outcome: Outcome, where: Callable[[int, float], bool], change: float = 0.0, so_far: float = 0.0) -> Runs:
    """Runs with a peak of 1, which real bearings change, that end somewhere with an outcome, and a peak so far."""

    def runs(number: int, springs: float) -> EngineRun:
        fails = where(number, springs)
        peak = so_far if fails and so_far else 1.0 + change * (springs == REAL)
        return result(peak, outcome=outcome if fails else Outcome.OK)

    return runs


def finer_on_bearings(number: int, springs: float) -> bool:
    return number > 0 and springs == REAL


def rounding_to(of_level_0: float) -> list[Level]:
    """Levels whose contact forces round to such a share of the weight, and four times as much at each."""
    return [replace(level, rounding_moment=1e-6 * of_level_0) for level in LEVELS]


HALVED = (1.0, 1.01, 1.015, 1.0175, 1.01875, 1.0194)  # from level to level by half of the change before
OK, BEYOND, RIM = Outcome.OK, Outcome.TOLERANCE_NOT_MET, Outcome.RIM_REACHED
FAILED, LIMIT = Outcome.SOLVER_FAILED, Outcome.STEP_LIMIT
NOTHING = (math.nan, math.nan)
# runs and limits; numbers of levels and springs of those asked for; outcome, peak of the platform and its error
PATHS: dict[str, tuple[Any, ...]] = {
    "a change without room asks for another level":
        (changed_by_bearings(9e-4), {}, "0s 0r 1s 2s 2r", OK, 1.0, 9e-4 + level_error(2)),
    "no level is begun without work for its bearings":
        (changed_by_bearings(9e-4), {"max_work": 6.5 * STEPS}, "0s 0r 1s", BEYOND, 1.0, 9e-4 + level_error(1)),
    "where bearings change the peaks levels have them":
        (lambda _, springs: result(1.826 + 0.067 * (springs == STIFF)), {},
         "0s 0r 1r", OK, 1.826, 1.826 * level_error(1)),
    "an answer that real bearings change is dropped":
        (real_from_level_1, {}, "0s 0r 1s 1r 2r", OK, 1.826, 1.826 * level_error(2)),
    "at the last level bearings give the answer":
        (real_from_level_1, {"levels": 2}, "0s 0r 1s 1r", BEYOND, 1.826, 0.067 + 1.893 * level_error(1)),
    "at the end of the work bearings give the answer":
        (real_from_level_1, {"max_work": 7.0 * STEPS}, "0s 0r 1s 1r", BEYOND, 1.826, 0.067 + 1.893 * level_error(1)),
    "a level whose run on bearings ends is confirmed":
        (failing(FAILED, lambda number, springs: (number, springs) == (1, REAL), 1e-4), {},
         "0s 0r 1s 1r 2s 2r", OK, 1.0, 1e-4 + level_error(2)),
    "no run on real bearings": (failing(FAILED, lambda _, springs: springs == REAL), {}, "0s 0r 1r", FAILED, *NOTHING),
    "of two levels without an answer the finer one says why":
        (lambda number, _: result(1.0, outcome=FAILED if number else LIMIT), {}, "0s 0r 1r", FAILED, *NOTHING),
    "supports that rattle stand on real bearings":
        (failing(LIMIT, lambda number, _: number == 0), {}, "0s 0r 1r 2r", OK, 1.0, level_error(2)),
    "a motion that ends on bearings alone has no value":
        (failing(RIM, finer_on_bearings), {}, "0s 0r 1s 1r 2r", RIM, *NOTHING),
    "likewise at the last level": (failing(RIM, finer_on_bearings), {"levels": 2}, "0s 0r 1s 1r", RIM, *NOTHING),
    "unconfirmed by a run out of steps, which has no larger peak so far":
        (failing(LIMIT, finer_on_bearings, 1e-4, 0.4), {"levels": 2},
         "0s 0r 1s 1r", BEYOND, 1.0, 2.0 * 1e-4 + level_error(1)),
    "unconfirmed by a run that fails, whose peak can only grow":
        (failing(FAILED, finer_on_bearings, 1e-4, 1.05), {"levels": 2},
         "0s 0r 1s 1r", BEYOND, 1.0, 0.05 + level_error(1)),
    "behind impacts levels on the same springs have an error of 4e-3, halved by each":
        (lambda _, springs: result(1.826 + 0.067 * (springs == STIFF), impacts=9), {},
         "0s 0r 1r 2r", OK, 1.826, 1.826 * 1e-3),
    "three levels that impacts take elsewhere are enough":
        (lambda number, _: result(2.0**number, opens=False, impacts=7), {}, "0s 1s 2s 3s", BEYOND, 8.0, 8.0),
    "a contact that stays shows by a softer one what it leaves":
        (lambda _, springs: result(1.0 + 2e-4 * (springs == SOFTER), opens=False), {"stiffenings": 0},
         "0s 1s 1~", OK, 1.0, level_error(1) + 1.5 * 2e-4 * (1.0 + 2e-3) + 4e-6),
    "a level that fails behind an answer is the last":
        (lambda number, _: result(1.0 + 0.1 * number, opens=False, outcome=FAILED if number == 2 else OK), {},
         "0s 1s 2s", BEYOND, 1.1, 0.15 * 1.001 + 1.1e-6),
    "behind impacts a level before level 0 confirms nothing":
        (lambda *_: result(1.0, opens=False, impacts=1),
         {"of": [replace(LEVELS[0], error_floor=3.2e-3), *LEVELS[1:]], "tolerance": 1e-2}, "0s 1s 2s", OK, 1.0, 2e-3),
    "supports opened by a misfit may give way by more":
        (lambda _, springs: result(1.0, opens=springs == STIFF, warping_load=1e-6 / springs), {},
         "0s 0r 1c", OK, 1.0, level_error(1) + 0.25e-10),
    "a load of open supports that asks for real bearings has no part of its own":
        (lambda *_: result(1.0, warping_load=0.02), {}, "0s 0r 1r", OK, 1.0, level_error(1)),
    "motions that differ count one after another":
        (lambda number, _: result((1.0, 2.0, 3.0, 3.0, 6.0, 12.0)[number], opens=False, impacts=7), {},
         "0s 1s 2s 3s 4s 5s", BEYOND, 12.0, 12.0),
    "where rounding takes over the level before is the answer":
        (lambda number, _: result(HALVED[number], opens=False), {"of": rounding_to(1e-4)},
         "0s 1s 2s 3s", BEYOND, 1.015, 1.25 * 0.005 * (1.0 + 5e-4) + 1e-6 * 1.015 + 1.6e-3),
    "where a contact that stays rounds no level follows":
        (lambda number, _: result(HALVED[number], opens=False), {"of": rounding_to(1.5e-3), "stiffenings": 1},
         "0s 1s 2s 2~", BEYOND, 1.015, 1.25 * 0.005 * (1.0 + 5e-4) + (2e-6 + 5e-5) * 1.015),
    "an answer without a softer contact is no best one":
        (lambda number, springs: result(HALVED[number] + 0.03 * (springs == SOFTER), opens=False),
         {"of": rounding_to(3.75e-4), "stiffenings": 1, "levels": 3},
         "0s 1s 2s 2~", BEYOND, 1.01, 1.5 * 0.01 * (1.0 + 1e-3) + 1e-6 * 1.01 + 1.5e-3),
}  # fmt: skip


@pytest.mark.parametrize(("runs", "limits", "asked", "outcome", "platform", "error"), PATHS.values(), ids=PATHS)
def test_levels_and_springs_follow_from_what_runs_say(
    refined: Any, runs: Any, limits: Any, asked: str, outcome: Outcome, platform: float, error: float
) -> None:
    done = refined(runs, **limits)
    answer = done.answer
    assert (done.asked, answer.outcome) == (asked, outcome)
    np.testing.assert_allclose([answer.peaks[0], answer.errors[0]], [platform, error])
    if outcome in (OK, BEYOND):
        assert (answer.peaks[1], answer.finest.peaks.value[0]) == (2.0, platform)
    instants = {OK: math.nan, BEYOND: 0.2}  # where the worst peak is; otherwise when the run ended
    np.testing.assert_equal(answer.instant, instants.get(outcome, 0.7))


@pytest.mark.parametrize("changes", [[3e-4, 5e-4], [5e-4, 3e-4]], ids=str)
def test_an_answer_hardly_changed_by_bearings_stays(refined: Any, changes: list[float]) -> None:
    levels = [1.0, 1.0001]
    done = refined(lambda number, springs: result(levels[number] + changes[number] * (springs == REAL)))
    assert done.asked == "0s 0r 1s 1r"
    np.testing.assert_allclose(done.answer.errors, [5e-4 + 1.0001 * level_error(1), 2.0 * level_error(1)])
    (_, (real, share)) = done.answer.coarser
    assert (real.peaks.value[0], share) == (1.0001 + changes[1], 1.0), "the error of any number"


def test_no_level_is_begun_without_work_for_its_softer_contact(refined: Any) -> None:
    asked = [refined(lambda *_: result(1.0, opens=False), 6, work * STEPS, 0).asked for work in (2.9, 3.1)]
    assert asked == ["0s", "0s 1s 1~"]


def test_levels_on_real_bearings_begin_with_a_full_run_where_the_trial_rattles(refined: Any) -> None:
    real = [replace(level, warping_compliance=REAL) for level in LEVELS]
    assert refined(failing(LIMIT, lambda number, _: number == 0), of=real).asked == "0r 0r 1r 2r"


def test_the_error_on_real_bearings_counts_impacts(refined: Any) -> None:
    done = refined(lambda *at: replace(real_from_level_1(*at), impacts=int(finer_on_bearings(*at))), 2)
    assert done.answer.errors[1] == pytest.approx(2.0 * 4e-3), "no level before it has the same springs"
    loaded = refined(lambda *_: result(1.0, warping_load=0.02)).answer
    assert loaded.floor == LEVELS[1].error_floor, "open supports share no load"


def test_the_first_run_of_rattling_supports_has_a_share(refined: Any) -> None:
    done = refined(failing(LIMIT, lambda number, springs: springs == STIFF), max_work=1e5)
    assert (done.asked, done.answer.outcome) == ("0s 0r 1r", OK)
    assert done.work[:2] == [MAX_WORK_SHARE_OF_TRIAL * 1e5, 1e5 - STEPS]


@pytest.mark.parametrize("softest_closed", [0.0, REAL], ids=["open on any", "open on softer ones only"])
def test_supports_opened_on_softer_springs_get_real_bearings(refined: Any, softest_closed: float) -> None:
    def runs(number: int, springs: float) -> EngineRun:
        opens = number > 0 and springs > softest_closed
        return result(1.0 + 0.1 * (number == 1), opens=opens, warping_load=4e-7 / springs)

    done = refined(runs)
    assert (done.springs[0], done.springs[1] > REAL, set(done.springs[2:])) == (STIFF, True, {REAL})
    assert re.findall(r"\d", done.asked) == [*"01", *"1234"], "levels 0 and 1 differ: more follow"


@pytest.mark.parametrize("load", [9e-7, 1e-5, 1e-3])
def test_load_that_warping_takes_is_an_error_of_all_numbers(refined: Any, load: float) -> None:
    """Of supports that stay closed on real bearings, as one opened on softer springs."""
    done = refined(lambda number, springs: result(1.0, opens=springs > REAL, warping_load=load))
    assert done.asked == ("0s 1s" if load < 1e-6 else "0s 1c 1r"), "no smaller error than 1e-6 has been verified"
    np.testing.assert_allclose(done.answer.errors, [each * (level_error(1) + 0.25 * load) for each in (1.0, 2.0)])
    assert done.answer.floor == max(load, LEVELS[1].error_floor)


def test_a_softer_contact_without_an_answer_leaves_the_error_open(refined: Any) -> None:
    """The value then is that of the last level whose error is known, or none."""

    def runs(number: int, springs: float) -> EngineRun:
        return result((1.0, 1.01, 1.0105)[number], opens=False, outcome=FAILED if springs == SOFTER else OK)

    done = refined(lambda number, springs: runs(0, springs), 2, stiffenings=0)
    assert len(done.answer.coarser) == 0
    assert (done.asked, done.answer.outcome, done.answer.instant) == ("0s 1s 1~", FAILED, SCENE.duration)
    assert np.isnan(done.answer.peaks).all()
    done = refined(runs, 3, stiffenings=1)
    assert (done.asked, done.answer.outcome) == ("0s 1s 2s 2~", BEYOND)
    np.testing.assert_allclose([done.answer.peaks[0], done.answer.errors[0]], [1.01, 0.015 * 1.001 + 1.01e-6])
    assert done.answer.floor == LEVELS[2].error_floor
    assert [run.peaks.value[0] for run, _ in done.answer.coarser] == [1.01], "the level before, without the softer run"


def test_warping_counts_while_all_supports_are_closed_and_have_settled() -> None:
    """Twenty times the root of the compliance behind an opening, over two chunks."""
    run, level = result(1.0, opens=False), replace(LEVELS[0], warping_compliance=1e-4)  # settles in 0.2
    model: Any = SimpleNamespace(warping_displacement=lambda coordinates: coordinates[:, 0])
    for time, warped, gaps, load, last_open in (
        ([0.0, 0.1, 0.2], [1e-5, 3e-5, 2e-5], [-1.0, -1.0, -1.0], 0.3, -math.inf),
        ([0.2, 0.3, 0.4], [2e-5, 5e-5, 9e-5], [-1.0, 1e-9, -1.0], 0.3, 0.3),
        ([0.4, 0.49, 0.51], [9e-5, 8e-5, 4e-5], [-1.0, -1.0, -1.0], 0.4, 0.3),
        ([0.51, 0.6, 0.9], [4e-5, 7e-5, 6e-5], [-1.0, -1.0, -1.0], 0.7, 0.3),
    ):
        gap = np.column_stack([np.full(3, -1.0), gaps])
        motion: Any = SimpleNamespace(time=np.array(time), coordinates=np.array(warped)[:, None], gap=gap)
        _record_warping(run, motion, model, level)
        assert (run.warping_load, run.last_open_at) == (pytest.approx(load), last_open)


def test_a_stop_that_later_runs_do_not_confirm_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """Until a run to the end says anew when nothing more comes: 20 steps of level 0 behind its last large value."""
    found = iter([(1.0, 1.0), (1.2, 1.0), (1.2, 3.0), (1.2, 3.0)])  # peak, and instant of the last large value
    stops: list[float] = []

    def run_level(pair: PhasePair, level: Level, budget: Budget, stop: float = math.inf, **more: Any) -> EngineRun:
        stops.append(stop)
        peak, last = next(found)
        return replace(result(peak, opens=False, last_large_at=last, max_displacement=0.1), stop=stop)

    monkeypatch.setattr(PhasePair, "run_level", run_level)
    model: Any = SimpleNamespace(**{**vars(MODEL), "warping_displacement": None, "rim": 1.0, "travel": math.inf})
    runs = LevelRuns(PhasePair(SCENE, model, np.zeros(2)), TOLERANCE, Budget(1e9), [*LEVELS], False, False)
    peaks = [runs.run_next_level().peaks.value[0] for _ in range(3)]
    assert (peaks, stops) == ([1.0, 1.2, 1.2], [math.inf, first := 1.0 + 20.0 * LEVELS[0].step, math.inf, first + 2.0])


@pytest.mark.parametrize(("outcome", "opens"), [(Outcome.STEP_LIMIT, False), (OK, True), (OK, False)])
def test_a_trial_that_rattles_or_opens_is_run_again_on_other_springs(
    outcome: Outcome, opens: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    trial, again = result(1.0, outcome=outcome, opens=opens), result(2.0, opens=False)
    monkeypatch.setattr(LevelRuns, "_run_trial", lambda runs, level: trial)
    monkeypatch.setattr(LevelRuns, "_choose_springs_for_opening", lambda runs, run: again)
    runs = LevelRuns(PhasePair(SCENE, MODEL, np.zeros(2)), TOLERANCE, Budget(1e9), [*LEVELS], False, True)
    assert (runs.run_next_level() is again) == (outcome != OK or opens)


@pytest.mark.parametrize("changes", [{}, {"soften": False}, {"outcome": Outcome.RIM_REACHED}, {"turns": True}], ids=str)
def test_the_smallest_peak_softens_the_contact_unless_a_platform_turns(changes: dict[str, Any]) -> None:
    model: Any = SimpleNamespace(**{**vars(MODEL), "depressions": "some" if changes.get("turns") else None})
    pair, run = PhasePair(SCENE, model, np.zeros(2)), result(1e-6, outcome=changes.get("outcome", OK), opens=False)
    rough = [replace(level, rounding_moment=1e-15) for level in LEVELS]
    runs = LevelRuns(pair, TOLERANCE, Budget(1e9), [*rough], changes.get("soften", True), False, [run])
    runs._adapt_levels(run)
    softer = [level.penetration > before.penetration for level, before in zip(runs.levels, rough)]
    assert softer == [False, *[not changes] * (len(rough) - 1)]


def test_motions_of_the_best_answer_and_of_the_last_two_runs_are_kept() -> None:
    runs: list[Any] = [result(1.0, chunks=[number]) for number in range(6)]
    best = SimpleNamespace(run=runs[1], coarser=((runs[0], 1.5), (runs[3], 1.0)))
    for held, kept in ((best, [0, 1, 3, 4, 5]), (None, [4, 5])):
        search: Any = SimpleNamespace(best=held, runs=SimpleNamespace(runs=runs))
        _AnswerSearch._forget_motions(search)
        assert [run.chunks[0] for run in runs if run.chunks] == kept
