"""Points without an answer are NaN with a status that says why and when; wrong arguments are refused."""

import numpy as np
import pytest
from scenes_at_hand import CONSTANT, changed, one_body
from scipy.integrate import solve_ivp

import multibody
from multibody.integration import refine
from multibody.integration.level import levels_of
from multibody.models.assembly import assemble
from reference.problem import GRAVITY, Outcome, load_scene


def test_contact_is_lost_when_the_plate_falls_too_fast() -> None:
    scene = one_body(amplitudes=[[0.1, 0.0], [0.0, 0.0], [0.0, 12.0]])
    pair = [0.0, np.pi / 2.0]  # -12 sin(2 pi t)
    result = multibody.amplification(scene, [pair])
    assert result.status[0] == Outcome.CONTACT_LOST
    assert np.isnan(result.mu).all()
    assert np.isnan(result.error).all()
    # the contact lets go within its own time constant of 0.1 ms, seen at the next step of 6 ms
    assert result.instant[0] == pytest.approx(np.arcsin(GRAVITY / 12.0) / (2.0 * np.pi), abs=7e-3)


def test_the_rim_is_reported_when_a_steady_push_reaches_it() -> None:
    push, radius = 2.0 * GRAVITY, 0.25
    scene = one_body(radius=radius, friction=0.0, amplitudes=[[-push, 0.0], [0.0, 0.0]], periods=(CONSTANT, CONSTANT))
    result = multibody.amplification(scene, [(0.0, 0.0)], regularization=None)

    def swing(t: float, y: np.ndarray) -> list[float]:
        return [y[1], (push * np.cos(y[0]) - GRAVITY * np.sin(y[0])) / radius]

    def rim(t: float, y: np.ndarray) -> float:
        return float(y[0] - 0.5 * np.pi)

    exact = solve_ivp(swing, (0.0, 1.0), [0.0, 0.0], events=rim, rtol=1e-10, atol=1e-12)
    assert result.status[0] == Outcome.RIM_REACHED
    assert np.isnan(result.mu).all()
    # x / rho is flat there: one step of 3 ms is 1 % of it
    assert result.instant[0] == pytest.approx(exact.t_events[0][0], abs=1e-2)


def test_one_lost_point_does_not_take_the_others_with_it() -> None:
    scene = one_body(amplitudes=[[1.0, 0.0], [0.0, 0.0], [0.0, 9.0]], periods=(1.0, 2.0))
    weak = changed(scene, excitation={"decay": [0.0, 3.0]})
    result = multibody.amplification(weak, [(0.0, np.pi), (0.0, 0.0), (1.0, 0.0)])
    assert result.status.tolist() == [Outcome.OK] * 3
    strong = changed(weak, excitation={"amplitudes": [[1.0, 0.0], [0.0, 0.0], [0.0, 10.5]]})
    result = multibody.amplification(strong, [(0.0, np.pi), (0.0, 0.0), (1.0, 0.0)])
    assert result.status.tolist() == [Outcome.CONTACT_LOST, Outcome.OK, Outcome.OK]
    assert np.isfinite(result.mu[1:]).all()


def test_a_plate_at_rest_has_no_amplification() -> None:
    result = multibody.amplification(one_body(), [(0.0, 0.0)])
    assert result.status[0] == Outcome.NO_GROUND_MOTION
    assert np.isnan(result.mu).all()


def test_a_run_that_asks_for_too_many_steps_is_given_up() -> None:
    result = multibody.amplification(one_body(amplitudes=[[1.0, 0.0], [0.0, 1.0]]), [(0.0, 0.0)], max_work=1000.0)
    assert result.status[0] == Outcome.STEP_LIMIT
    assert np.isnan(result.mu).all()


def test_a_tolerance_out_of_reach_gives_the_error_reached() -> None:
    scene = changed(load_scene("fig3-I"), duration=0.5, bodies=[{"mass": 1.0}])
    result = multibody.amplification(scene, [(0.3, 1.1)], tolerance=1e-9)
    assert result.status[0] == Outcome.TOLERANCE_NOT_MET
    assert (result.error > 1e-9 * result.mu).all()
    assert (result.error < 1e-4 * result.mu).all()


def test_a_trajectory_ends_where_the_model_does() -> None:
    scene = one_body(amplitudes=[[0.1, 0.0], [0.0, 0.0], [0.0, 12.0]])
    motion = multibody.trajectory(scene, (0.0, np.pi / 2.0))
    assert motion.status == Outcome.CONTACT_LOST
    assert motion.time[-1] == pytest.approx(motion.instant)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"regularization": None}, "v_reg"),
        ({"phases": [[0.0, 1.0, 2.0]]}, "phases"),
    ],
)
def test_wrong_arguments_are_refused_by_name(options: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        multibody.amplification(load_scene("fig3-I"), **{"phases": [(0.0, 0.0)], **options})  # type: ignore[arg-type]


def test_a_point_whose_budget_ends_after_one_level_is_refused() -> None:
    """One answer alone says nothing about its error."""
    scene = load_scene("fig3-I").with_values({"duration": 0.5})
    model = assemble(scene, "translational", 1e-3)
    one = refine.refine(scene, model, np.array([0.3, 1.1]), 1e-3, levels=levels_of(scene, model, 1e-3)[:1])
    assert one.outcome == Outcome.STEP_LIMIT
    assert np.isnan(one.peaks).all()
