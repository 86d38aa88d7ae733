"""The error that comes with every mu holds, and the work it costs is asserted, not only the answer."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from chains import chain

import reference
from reference.problem import Scene, phase_grid
from reference.solver import error_estimate
from reference.solver.error_estimate import RunPeaks, _compare_runs, _estimate_error, peaks_at
from reference.solver.system import RIM, SOLVED, TRAVEL, UNSOLVED, YIELDING
from reference.surface import prepare_run

FIG3 = reference.load_scene("fig3-I")


@pytest.mark.parametrize("period", [0.09, 0.12])
def test_an_error_counts_what_equal_steps_between_knots_miss(period):
    """Both runs step from knot to knot: they agree, however wrongly a stiff link vibrates within such steps."""
    time = 0.05 * np.arange(81)
    for seed in range(8):
        frequencies, phases = np.random.default_rng(seed).uniform([[0.5], [0.0]], [[2.0], [6.0]], (2, 2))
        waves = np.sin(np.pi * time / 4.0) ** 2 * np.sin(2.0 * np.pi * np.outer(frequencies, time) + phases[:, None])
        links = {"mass": 0.5, "period": [period, 1.3 * period]}
        scene = FIG3.with_values({
            "isolator": {"radius": 0.8, "friction": 0.9}, "bodies": [{"mass": 1.0}, links], "duration": 4.0,
            "excitation": {"record": {"time": time, "acceleration": waves.T}},
        })  # fmt: skip
        found = reference.amplification(scene, [(0.0, 0.0)])
        truth = reference.amplification(scene, [(0.0, 0.0)], tolerance=1e-9)
        assert np.all(np.abs(found.mu - truth.mu) <= found.error + truth.error), seed


@pytest.mark.parametrize(("changes", "runs"), [((0.3, 0.01, 1e-6, 0.0), 4), ((0.3, 8e-4, 5e-4, 1e-5), 4)])
def test_heated_runs_repeat_until_they_settle_and_the_last_change_is_error(
    changes: tuple[float, ...], runs: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At a tolerance of 1e-3 a change settles below 2e-5, or below 1e-3 where it is more than half of that before."""
    peaks, made = np.cumsum([2.0, *changes]), []

    def run(x: Any, v: Any, system: Any, phases: Any, settings: Any, record: Any) -> RunPeaks:
        record.counts[:] = 1
        made.append(peaks[len(made)])
        none = np.zeros(1)
        return RunPeaks(made[-1] * np.array([[1.0, 2.0]]), np.full((1, 2), 1e-4), np.array([SOLVED]), *[none] * 4)

    for name, function in (("peaks_from", run), ("set_factor_by_heat", lambda system, *rest: system)):
        monkeypatch.setattr(error_estimate, name, function)
    monkeypatch.setattr(error_estimate, "mean_factor", lambda system: 0.9)
    system: Any = SimpleNamespace(record=[], heat=[1.0], k_t=[1.0])
    found, *_ = error_estimate.record_run(
        np.zeros((2, 2)), np.zeros((2, 2)), system, np.zeros(2), SimpleNamespace(tolerance=1e-3)
    )
    assert len(made) == runs
    np.testing.assert_allclose(found.error, 1e-4 + changes[runs - 2] * np.array([[1.0, 2.0]]), rtol=1e-9)


def test_reading_and_states_add_to_an_error() -> None:
    """Twice what reading leaves, 0.4 of what the states leave, or all of it at a peak too small for the steps."""
    before, after = (
        SimpleNamespace(value=np.array([[3.0, 1e-6]]) * k, error=np.array([[0.02, 1e-7]])) for k in (1.1, 1)
    )
    found: Any = _estimate_error(before, after, 0.4, 1e-3, 1.0)  # type: ignore[arg-type]
    expected = [0.04 + 0.4 * 0.3 + 5e-4 * 1e-3 * 3.0, 2e-7 + 1e-7 + 5e-4 * 1e-3 * 1e-6]
    np.testing.assert_allclose(found[0], expected, rtol=1e-9)


def test_runs_agree_where_all_bodies_do_or_both_end_alike_and_errors_have_a_floor() -> None:
    """At a tolerance of 0.1 a body at 2 m/s^2 may be off by 0.2; of a change 0.4 or all is the error, as the law is."""
    errors = np.array([[0.16] * 2, [0.24, 0.16], [0.16, 0.24], [0.16] * 2, [0.24] * 2, [0.16] * 2, [0.16] * 2])
    codes = [(SOLVED, SOLVED)] * 3 + [(UNSOLVED, SOLVED), (RIM, RIM), (RIM, TRAVEL), (SOLVED, UNSOLVED)]
    before_code, after_code = np.array(codes).T
    value, none = np.full((7, 2), 2.0), np.zeros(7)
    after = RunPeaks(value, np.zeros((7, 2)), after_code, none, none, none, none)
    settings: Any = SimpleNamespace(tolerance=0.1, unit=1.0)
    for rate, law in ((0.0, 0), (9.0, 0), (0.0, YIELDING), (9.0, YIELDING)):
        system: Any = SimpleNamespace(rate=rate, law=law)
        share, fraction = (1.0, 0.07) if rate or law else (0.4, 0.007)
        before = after._replace(value=value + errors / share, code=before_code)
        found, disagree = _compare_runs(before, after, 0.0, system, settings)
        assert disagree.tolist() == [False, True, True, True, False, True, True]
        np.testing.assert_allclose(found.error, errors, rtol=1e-12)
        alike, disagree = _compare_runs(after, after, 0.0, system, settings)
        np.testing.assert_allclose(alike.error, fraction * 0.2, rtol=1e-12)
        assert not disagree[:6].any()


def asked(isolator: dict, bodies: list, amplitudes: list, periods: list, decay: list, duration: float) -> Scene:
    excitation = {"amplitudes": amplitudes, "periods": periods, "decay": decay}
    tables = {"isolator": isolator, "bodies": bodies, "excitation": excitation}
    return Scene.model_validate({"title": "asked of the error", "duration": duration, **tables})


# what an error would lack: scene, phases, law, tolerance
LACKING = {
    # the stiff link on top of four bodies vibrates undamped, by less than the tolerance inside a step
    "vibration that both runs damp": (
        asked(
            {"radius": 0.79, "friction": 0.29},
            [{"mass": 2.9}, {"mass": 0.46, "period": [0.18, 0.13]}, {"mass": 0.58, "period": [1.2, 1.7]},
             {"mass": 2.1, "period": [0.055, 0.047]}],
            [[-0.4, -0.18], [0.64, -1.3], [-0.15, 0.39]], [1.0, 0.77], [0.0, 0.058], 3.9,
        ),
        (3.7, 0.4), {"cutoff": 1e-3}, 1e-6,
    ),
    # at a stage the interpolating polynomial is exact, and stiff links return a wrong place as an acceleration
    "places at a stage": (
        asked(
            {"radius": float("inf"), "friction": 0.2439118221521473},
            [{"mass": 0.749599907571332},
             {"mass": 2.222804077965832, "period": [0.1011706677778102, 0.062068992441822006]}],
            [[0.3213943270276767, -0.9174033188431983], [-1.7232873793996446, 1.0913846932317521],
             [-1.2745928250202376, -0.9194598522227189]],
            [1.0255153347693375, 1.078778262315151], [0.0, 0.19269694617653776], 2.9151874635691977,
        ),
        (3.4142843076791825, 0.32840127542146164), {"equations": "small", "regularization": 1e-3}, 1e-6,
    ),
    # the defect of the acceleration is small there, that of the velocity is not
    "vibration whose acceleration is zero where the step begins": (
        asked(
            {"radius": float("inf"), "friction": 0.2410461351714428},
            [{"mass": 2.0334465501971253},
             {"mass": 2.4041598998469538, "period": [1.7158223844817824, 1.1489567897578785]},
             {"mass": 0.4065760535114943, "period": [0.03409016784258648, 0.159199130584121]}],
            [[1.6587128332517427, -1.5793306980738033], [1.582995927447317, -1.2735503379100233],
             [1.0607216669910304, -0.6447819313971683]],
            [0.5191640817131488, 1.5204245061365294], [0.0, 0.0], 4.202171020401759,
        ),
        (2.6065706627301535, 0.9463193827363767), {"cutoff": 0.05}, 1e-5,
    ),
    # the largest acceleration of the middle body is wrong by what the stiff link above it makes of a wrong velocity
    "place of the body above": (
        asked(
            {"radius": float("inf"), "friction": 0.35},
            [{"mass": 1.326}, {"mass": 1.01, "period": [0.1348, 0.1294]},
             {"mass": 2.881, "period": [0.0857, 0.0865]}],
            [[1.5946, -0.2949], [1.7081, -1.4038], [-0.6278, 0.4711]], [1.0378, 1.4321], [0.2299, 0.186], 3.09,
        ),
        (0.294, 3.0696), {"equations": "small"}, 1e-5,
    ),
    # friction that depends on the velocity answers to a wrong one, which is wrong most of all at the stages
    "velocity at a stage of a slow slide": (
        asked(
            {"radius": 0.4055392718770014,
             "friction": {"slow": 0.13309190933512813, "fast": 0.18536089582186507, "rate": 96.26506232767552}},
            [{"mass": 1.5848051508005034}],
            [[-0.6066648967154049, -0.9035527068508564], [-1.1910997411924935, -0.3475833836386375]],
            [0.7288123599658124, 0.792461983489356], [0.36665382523949813, 0.0], 5.278268500333847,
        ),
        (3.96547402629501, 6.1657221400022255), {}, 1e-6,
    ),
    # the error falls by little more than half from one run to the next
    "slow slides whose friction rises with the velocity": (
        asked(
            {"radius": 1.43, "friction": {"slow": 0.118, "fast": 0.235, "rate": 216.0}},
            [{"mass": 1.0}, {"mass": 2.55, "period": [0.745, 0.889]}],
            [[-0.974, -0.168], [-0.834, 0.0413], [0.0037, 0.0473]], [0.99, 0.936], [0.216, 0.312], 4.0,
        ),
        (3.74, 5.32), {}, 1e-6,
    ),
}  # fmt: skip


@pytest.mark.parametrize(("scene", "phase", "law", "tolerance"), LACKING.values(), ids=LACKING)
def test_an_error_lacks_nothing(scene: Scene, phase: tuple[float, float], law: dict, tolerance: float):
    found, truth = (reference.amplification(scene, [phase], tolerance=each, **law) for each in (tolerance, 1e-9))
    assert np.all(np.abs(found.mu - truth.mu) <= found.error + truth.error)


def test_a_run_of_fig3_takes_few_steps():
    """159 over 20 s at 1e-5 inside a step: none is made in vain before a stop, and few on the way into it."""
    system, demand = prepare_run(FIG3, "exact", None, 1e-6, None, "consistent")
    assert peaks_at(system, phase_grid(8) + 0.1, demand, 1e-5).steps.mean() <= 170.0


def test_what_is_known_remains_where_a_finer_run_fails():
    """A platform of a millionth of the mass: rounding ends the steps of the runs that a tolerance of 1e-8 asks for."""
    loading = {"amplitudes": 2.0 * np.eye(2), "decay": [1.0 / 3.0, 0.3 / 1.1]}
    scene = chain(0.25, 0.1, [2e-6, 2.0], [[35.1, 54.8]], **loading, duration=1.5)
    phases = [(0.3, 1.1), (2.0, 0.7)]
    rough, found = (reference.amplification(scene, phases, "small", tolerance=tolerance) for tolerance in (1e-6, 1e-8))
    assert set(found.status) == {"tolerance not met"}
    assert np.all((found.error > 1e-8 * found.mu).any(axis=1))
    assert np.all(found.error[:, 0] < rough.error[:, 0])
    assert np.all(np.abs(found.mu - rough.mu) <= found.error + rough.error)


def test_a_value_that_misses_the_tolerance_is_not_called_ok():
    """Without friction the bodies hardly feel so brief a loading: their peaks are as small as rounding."""
    scene = FIG3.with_values({"duration": 0.01, "isolator.friction": 0.0})
    found = reference.amplification(scene, [(0.3, 1.1)], tolerance=1e-10)
    assert (found.error > 1e-10 * found.mu).any()
    assert found.status.tolist() == ["tolerance not met"]
