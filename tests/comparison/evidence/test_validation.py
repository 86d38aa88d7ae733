"""Measured motions: files by an independent integration of the frame, closed forms, the real files, and wrong ones."""

import math
import os
import re
from contextlib import nullcontext
from dataclasses import replace
from functools import cache
from itertools import product
from pathlib import Path
from shutil import copyfile
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from runs import Here
from scipy.integrate import solve_ivp
from scipy.io import loadmat, savemat
from scipy.special import ellipk

from comparison.evidence.sides import ENGINE, EQUATIONS, SMOOTHED
from comparison.evidence.validation import command, frame, pendulum, table
from comparison.evidence.validation.command import compare_folder, main
from comparison.evidence.validation.cycles import REST_SPEED, VELOCITY_HALF_WIDTH
from comparison.evidence.validation.feature import make_experiment_panels
from comparison.evidence.validation.files import DECAY_FILE, LARGE_SWING_FILE, FrameRun, FreeSwing, read_folder
from comparison.evidence.validation.table import (
    COVERAGE_FACTOR,
    INPUT_CAUSE,
    LAW_CAUSE,
    NO_CAUSE,
    Validation,
    load_record,
)
from comparison.verdicts import MET, NOT_COMPARED, NOT_MET
from reference.problem import SceneError

MASS, STIFFNESS, DAMPING, RATIO = 3.0799, 1191.0, 0.6690, 0.24
FREQUENCY, AMPLITUDE, RATE, GRAVITY = 1.003, 1.8e-3, 250.0, 9.80665
PARTS = "Time_id", "Time_vad", "Y_id", "Y_vad"
MEASURED = os.environ.get("PHASE_RESONANCE_MEASURED", "")  # folder with the published files


@cache
def shaken(weight: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time, plate and base, mm, of the frame as SciPy integrates it, from a stop to the next, behind six cycles."""
    turn, friction, end = 2.0 * math.pi * FREQUENCY, RATIO * weight * GRAVITY, 18.0 / FREQUENCY

    def pull(t: float | np.ndarray) -> float | np.ndarray:
        return AMPLITUDE * (STIFFNESS * np.cos(turn * t) - DAMPING * turn * np.sin(turn * t))

    begin, place = 0.0, AMPLITUDE
    instants, places = [0.0], [place]
    while begin < end:
        held = begin + np.arange(0.0, 1.0, 1e-5)
        rest = np.abs(pull(held) - STIFFNESS * place) <= friction
        slip = float(held[np.argmin(rest)])  # the first instant at which it is not held
        sign = math.copysign(1.0, pull(slip) - STIFFNESS * place)

        def rate(t: float, state: np.ndarray, sign: float = sign) -> list[float]:
            force = pull(t) - DAMPING * state[1] - STIFFNESS * state[0] - sign * friction
            return [state[1], force / MASS]

        def stops(t: float, state: np.ndarray, sign: float = sign) -> float:
            return sign * state[1]

        stops.terminal, stops.direction = True, -1.0
        slide = solve_ivp(
            rate, (slip, end + 1.0), [place, sign * 1e-12], events=stops, rtol=1e-10, atol=1e-14, max_step=0.004
        )
        instants += [slip, *slide.t[1:]]
        places += [place, *slide.y[0, 1:]]
        begin, place = float(slide.t[-1]), float(slide.y[0, -1])
    time = 6.25 / FREQUENCY + np.arange(2501) / RATE
    return time, 1e3 * np.interp(time, instants, places), 1e3 * AMPLITUDE * np.cos(turn * time)


def save(folder: Path, grams: int, offset: float = 0.0) -> None:
    """The files of a run, with an offset of the plate's sensor."""
    time, plate, base = shaken(1e-3 * grams)
    savemat(folder / f"s_b_{grams}g_x.mat", {"t": time[:, None], "x": plate[:, None] + offset})
    savemat(folder / f"s_b_{grams}g_y.mat", {"t": time[:, None], "y": base[:, None]})


def test_the_equations_predict_a_run_of_an_independent_program(tmp_path: Path):
    save(tmp_path, 450, offset=-0.15)
    cycles = frame.fold_run(read_folder(tmp_path).runs[0])
    assert cycles.frequency == pytest.approx(FREQUENCY, abs=1e-5)
    found = np.mean([frame.measure_cycle(each, cycles.frequency) for each in cycles.motions], axis=0)
    computed = frame.read_quantities(
        cycles, frame.compute_frame_motion(EQUATIONS, cycles, frame.Setup(ratio=RATIO))
    ).values
    assert computed[:2] == pytest.approx(found[:2], rel=5e-4)  # without the damper: 5e-3
    assert computed[2:] == pytest.approx(found[2:], abs=0.2)


def test_the_numbers_of_a_known_cycle_are_read():
    turn = np.arange(frame.CYCLE_SAMPLES) * 360.0 / frame.CYCLE_SAMPLES
    motion = np.interp(turn, [0.0, 70.0, 150.0, 250.0, 330.0, 360.0], [1.5, 1.5, -1.5, -1.5, 1.5, 1.5])
    half_range, rms, rest, starts, stops = frame.measure_cycle(motion, 1.0)
    assert half_range == 1.5
    assert rms == pytest.approx(math.sqrt((200.0 * 1.5**2 + 160.0 * 1.5**2 / 3.0) / 360.0), rel=1e-3)
    # Velocity: a mean over twice the width
    width, top = 360.0 * VELOCITY_HALF_WIDTH / frame.CYCLE_SAMPLES, 3.0 / (80.0 / 360.0)
    early = width * (1.0 - 2.0 * REST_SPEED / top)
    assert (starts, stops) == pytest.approx((70.0 - early, 150.0 + early), abs=0.2)
    assert rest == pytest.approx(100.0 * (200.0 - 4.0 * early) / 360.0, abs=0.2)
    at_rest = frame.measure_cycle(0.05 * np.sin(np.linspace(0.0, 6.283, frame.CYCLE_SAMPLES)), 1.0)
    assert [at_rest[0], at_rest[2]] == pytest.approx([0.05, 100.0], rel=1e-3)
    assert np.isnan(at_rest[3:]).all(), "nothing starts or stops"


def test_phases_of_both_directions_have_their_middle_on_the_circle():
    """The plate goes back from 350 to 60 degrees, fastest at the end of a turn, and forth from 190 to 240."""
    turn = np.arange(frame.CYCLE_SAMPLES) * 360.0 / frame.CYCLE_SAMPLES
    ends = [0, 60, 61, 189, 190, 240, 241, 349, 350, 358, 360]
    speed = np.interp(turn, ends, [-1, -0.8, 0, 0, 1, 1, 0, 0, -1.5, -1.5, -1])
    speed[speed > 0.0] *= -speed[speed < 0.0].sum() / speed[speed > 0.0].sum()  # the cycle closes
    *_, starts, stops = frame.measure_cycle(np.cumsum(speed), 1.0)
    assert (starts + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=8.0)
    assert stops == pytest.approx(60.0, abs=8.0)


def test_a_run_is_folded_at_the_turns_of_its_base():
    """Base and second harmonic, 7 and 0.2 mm, the latter behind by 40 degrees; the plate is behind the base by 50."""
    time, turn = np.arange(2501) / RATE, 2.0 * math.pi * FREQUENCY * np.arange(2501) / RATE + 1.0
    base = 7.0 * np.cos(turn) + 0.2 * np.cos(2.0 * turn - np.radians(40.0))
    cycles = frame.fold_run(FrameRun(0.25, time, 3.0 * np.cos(turn - np.radians(50.0)), base))
    assert (cycles.frequency, cycles.amplitude) == pytest.approx((FREQUENCY, 7.0), rel=1e-6)
    assert cycles.second == pytest.approx(0.2 * np.exp(-1j * np.radians(40.0)), abs=1e-6)
    expected = 3.0 * np.cos(2.0 * math.pi * np.arange(frame.CYCLE_SAMPLES) / frame.CYCLE_SAMPLES - np.radians(50.0))
    assert cycles.mean == pytest.approx(expected - expected.mean(), abs=2e-3)
    sizes = np.where(turn < 5.99 * math.pi, 3.0, 1.0)
    for end, shift, rule in (
        (4.2, 0.0, ""),
        (3.9, 0.0, "3 whole cycles of the base, not 2"),
        (4.2, 0.13, "by 1[23] %"),
    ):
        kept, moved = turn < 2.0 * math.pi * end, np.where(turn < 4.0 * math.pi, 0.0, 2.0 * shift)
        run = FrameRun(0.25, *(each[kept] for each in (time, sizes * np.cos(turn) + moved, base)))
        with pytest.raises(SceneError, match=rule) if rule else nullcontext():
            assert len(frame.fold_run(run).motions) == 3, "the drift is over the smallest range"


def test_the_scene_of_a_run_has_the_force_of_disc_and_base():
    cycles = frame.Cycles(FrameRun(0.25, *np.zeros((3, 1))), np.zeros((4, frame.CYCLE_SAMPLES)), 1.0, 2.0, 0.3 + 0.4j)
    scene, phases = frame.make_frame_scene(cycles, frame.Setup(disc=1.1, ratio=0.2, scale=1.5, second=0.5))
    law, weight = scene.dry_friction, scene.total_mass * 9.81
    assert law.slow * weight == pytest.approx(0.2 * 1.1 * 0.25 * 9.81)
    assert weight / scene.radius == pytest.approx(STIFFNESS)
    assert (law.fast - law.slow) * law.rate * weight == pytest.approx(DAMPING)
    for number, base in enumerate((2e-3, 0.5 * (0.3 + 0.4j) * 1e-3), start=1):
        force = -1.5 * base * (STIFFNESS + 2j * math.pi * number * DAMPING) / MASS
        assert scene.amplitudes[0, number - 1] == pytest.approx(abs(force))
        assert phases[number - 1] == pytest.approx(np.angle(force))


def test_the_numbers_of_a_motion_have_its_errors(monkeypatch):
    accuracy = SimpleNamespace(coarser=[[1.5, 2.5], [3.0, 7.0]], error_of=lambda value, others: sum(others) - 2 * value)
    motion = SimpleNamespace(status="ok", accuracy=accuracy)
    found = table.read_motion_values(motion, lambda each: np.array([1.0, 2.0] if each is motion else each), 2)
    assert (found.values.tolist(), found.errors.tolist()) == ([1.0, 2.0], [2.5, 5.5])
    laws = {}
    for side, code in ((EQUATIONS, table.reference), (SMOOTHED, table.reference), (ENGINE, table.multibody)):
        monkeypatch.setattr(
            code, "trajectory", lambda *given, side=side, **settings: laws.update({side: (given, settings)})
        )
        table.compute_released_motion(side, None, (0.0, 1.0), np.array([0.2, 0.3]), 1e-4, 1e-3, "small")
    assert [laws[side][0] for side in (EQUATIONS, SMOOTHED)] == [
        (None, (0.0, 1.0), "small", threshold, 1e-7) for threshold in (None, 1e-4)
    ]
    assert [laws[ENGINE][1][name] for name in ("tolerance", "regularization")] == [1e-3, 1e-4]
    assert laws[ENGINE][1]["initial"].position.tolist() == [[0.2, 0.0], [0.3, 0.0]]
    ended = SimpleNamespace(status="rim reached", accuracy=accuracy)
    assert np.isnan(np.concatenate(table.read_motion_values(ended, np.asarray, 2))).all()


@pytest.mark.parametrize(("weights", "chosen"), [((0.45, 0.15, 0.25), 0.25), ((0.45, 0.15, 0.35), 0.15)])
def test_the_ratio_is_fitted_to_the_disc_of_250_g_or_to_the_lightest(monkeypatch, weights, chosen):
    monkeypatch.setattr(frame, "fold_run", lambda weight: SimpleNamespace(run=SimpleNamespace(weight=weight)))

    def fit(cycles, start):
        raise LookupError(cycles.run.weight)

    monkeypatch.setattr(frame, "fit_run", fit)
    with pytest.raises(LookupError, match=f"^{chosen}$"):
        frame.compare_frame(weights)


def test_one_run_is_fitted_and_the_others_predicted(monkeypatch):
    """
    In place of the equations a cycle 10 scale cos - 8 ratio disc scale^2 sin + 2 cos 2, mm, of which each other input
    changes the cosine by a share of its own.

    Ratios grow as the power 0.15 of the weight; the base of two runs is off by 3 %; the plate of the last one rests.
    """
    turn = 2.0 * np.pi * np.arange(frame.CYCLE_SAMPLES) / frame.CYCLE_SAMPLES
    off_by = {0.25: 1.03, 0.35: 1.0, 0.47: 0.97, 0.44: 1.0}

    def cycle(setup: frame.Setup) -> np.ndarray:
        wide = 10.0 * setup.scale * math.sqrt(setup.mass / MASS) * setup.stiffness / STIFFNESS
        wide *= (1.0 + 0.03 * (setup.damping / DAMPING - 1.0)) * (1.0 + 0.015 * setup.second)
        slow = 8.0 * setup.ratio * setup.disc * setup.scale**2
        return wide * np.cos(turn) - slow * np.sin(turn) + 2.0 * np.cos(2.0 * turn)

    def numbers(**inputs: float) -> np.ndarray:
        return frame.measure_cycle(cycle(frame.Setup(**inputs)), 1.0)

    def folded(run: FrameRun) -> frame.Cycles:
        scale, size = off_by[run.weight], 0.01 if run.weight == 0.44 else 1.0
        change = 3e-3 if run.weight == 0.47 else 5e-4
        ratios = [RATIO * (run.weight / 0.25) ** 0.15 + sign * change for sign in (1, -1, 1, -1)]
        motions = [size * cycle(frame.Setup(scale=scale, ratio=ratio / scale**2)) for ratio in ratios]
        return frame.Cycles(run, np.array(motions), 1.0, 2.0, 0.02)

    def read(cycles: frame.Cycles, setup: frame.Setup) -> table.ComputedValues:
        return table.ComputedValues(frame.measure_cycle(cycle(setup), 1.0), np.full(5, 1e-3))

    for name, known in (
        ("fold_run", folded),
        ("compute_frame_motion", lambda side, cycles, setup: setup),
        ("read_quantities", read),
    ):
        monkeypatch.setattr(frame, name, known)
    monkeypatch.setattr(frame, "read_last_cycle", lambda motion, frequency: cycle(motion))
    wide = frame.Setup(ratio=0.25, scale=1.02)
    run = folded(FrameRun(0.25, *np.zeros((3, 1))))._replace(motions=np.array([cycle(wide)] * 3))
    assert frame.fit_inputs(run, frame.Setup(), "ratio", "scale")[0] == pytest.approx(wide, abs=1e-6)

    def compared(*weights: float) -> tuple[table.ExperimentFindings, dict]:
        found = frame.compare_frame([FrameRun(weight, *np.zeros((3, 1))) for weight in weights])
        return found, {(each.experiment, each.name): each for each in found.quantities}

    for pair in ((0.25, 0.35), (0.25, 0.44)):
        assert len({title for title, _ in compared(*pair)[1]}) == 2, "no run or no motion is left to predict"
    found, rows = compared(*off_by)
    uses = {title: each.use for (title, name), each in rows.items() if name == "half range"}
    plain = [f"frame, {grams} g" for grams in (250, 350, 470, 440)]
    loads = [f"{name}, friction of the load" for name in plain[1:]]
    assert list(uses) == [*plain, *loads]
    assert list(uses.values()) == ["calibrated", *["predicted"] * 4, "calibrated", "predicted"]
    assert {each.experiment: each.use for each in found.residuals} == uses
    first, constant, loaded = (rows[title, "half range"] for title in (*plain[:2], loads[0]))
    spread, (ratio, heavy) = 2.0 * 5e-4 * math.sqrt(4.0 / 3.0), (RATIO * times**0.15 for times in (1.4, 1.88))
    sizes = [numbers(ratio=(RATIO + change) / 1.03**2, scale=1.03)[0] for change in (5e-4, -5e-4)]
    assert first.measured == pytest.approx(np.mean(sizes))
    assert first.data == pytest.approx(2.0 * np.std(sizes * 2, ddof=1)), "u_D is two standard deviations"
    inputs = [{"disc": 1.01}, {"mass": 1.01 * MASS}, {"stiffness": 1.01 * STIFFNESS}, {"damping": 1.2 * DAMPING}]
    inputs += [{"second": 1.0}, {"scale": 1.01, "ratio": 1.01**-2}]

    def spread_over(at: float, ratios: list[float], quantity: int) -> float:
        changed = [{"ratio": each} for each in ratios] + [
            {**each, "ratio": at * each.get("ratio", 1.0)} for each in inputs
        ]
        return math.hypot(*(numbers(**each)[quantity] - numbers(ratio=at)[quantity] for each in changed))

    assert first.inputs == pytest.approx(spread_over(RATIO, [RATIO + spread], 0), rel=2e-3)
    share = math.log(1.4) / math.log(1.88)
    at = [ratio * (1.0 + spread / RATIO) ** (1.0 - share), ratio * (1.0 + 6.0 * spread / heavy) ** share]
    starts = rows[loads[0], "phase of the starts"]
    assert starts.inputs == pytest.approx(spread_over(ratio, at, 3), rel=5e-3), "scatter of both fitted ratios"
    assert loaded.sides[EQUATIONS].verdict == MET
    assert abs(loaded.sides[EQUATIONS].error) < 0.05 * abs(constant.sides[EQUATIONS].error)
    gone, wide = "gone neither with the ratio of this run", "a base motion of +3.0 % and ratio"
    for title, name, cause in (
        (plain[0], "half range", f"{INPUT_CAUSE}: gone with {wide} {RATIO / 1.03**2:.3f}"),
        (plain[1], "phase of the starts", f"{LAW_CAUSE}: gone with the ratio of this run, 0.252, so the ratio depends"),
        (plain[2], "half range", f"{NO_CAUSE}: {gone}, {heavy:.3f}, nor with {wide} {RATIO / 1.03**2:.3f}"),
        (loads[1], "half range", f"{NO_CAUSE}: {gone}, {heavy:.3f}, nor with {wide} {heavy / 1.03**2:.3f}"),
    ):
        assert rows[title, name].cause.startswith(cause)
    assert found.inputs[2] == "frame: viscous damping 0.669 ± 0.13 N s/m (authors; 20 % assumed)"
    for place, grams, fitted, scatter in ((-2, 250, 0.24, spread), (-1, 470, heavy, 6.0 * spread)):
        source = f"fitted to the motion of the run with {grams} g; its scatter over the cycles"
        assert found.inputs[place] == f"frame: friction ratio {fitted:.5g} ± {scatter:.2g} ({source})"
    (plot, *_), titles = (
        make_experiment_panels(Validation([], [], [], [], found.curves, {})),
        ("phase of the base, deg", "top plate, mm"),
    )
    assert (plot["title"], plot["plot"]["x"]["title"], plot["plot"]["y"]["title"]) == ("frame, 250 g", *titles)
    lines = {line["name"]: line["y"] for line in plot["plot"]["series"]}
    true = {"measured": frame.Setup(scale=1.03, ratio=RATIO / 1.03**2), "equations": frame.Setup(ratio=RATIO)}
    for name, setup in true.items():
        assert lines[name] == pytest.approx(cycle(setup).tolist(), abs=1e-3)
    for counts, marks in (((199, 9, 199), True), ((9, 200, 9), False)):
        few = [replace(curve, x=[0.0] * count, y=[0.0] * count) for curve, count in zip(found.curves, counts)]
        (panel,) = make_experiment_panels(Validation([], [], [], [], few, {}))
        assert [line["marks"] for line in panel["plot"]["series"]] == [marks] * 3
    off = [math.hypot(10.0 * apart, 8.0 * (own - RATIO)) for apart, own in ((0.03, RATIO), (0, ratio), (0.03, heavy))]
    for residual, expected, title in zip(found.residuals, off, plain):
        share = expected / math.sqrt(2.0) / rows[title, "half range"].measured
        assert residual.share == pytest.approx(share, abs=1e-4), "rms over the half range"
    power = "fitted to frame, 250 g and to frame, 470 g grow as the load to the power 0.150"
    assert any(power in fact for fact in found.facts)
    place = cycle(frame.Setup(ratio=ratio))
    above = 100.0 * np.mean(place > place.min() + 0.5 * np.ptp(place))
    assert above < 45.0
    for title, used in ((plain[1], RATIO), (loads[0], ratio)):
        by = 8.0 * (ratio - used) / math.sqrt(2.0)
        assert (
            f"{title}: the friction ratio of this run alone is {ratio:.3f}; the motion over a cycle is then off by "
            f"0.000 mm rms, and by {by:.3f} mm with {used:.3f}; the plate is above its middle for {above:.0f} % of a "
            "cycle"
        ) in found.facts


def known_decay(half: float, loss: float, step: float) -> FreeSwing:
    """A swing that loses `loss`, rad, in every `half`, s, read in steps, rad; 1 % slower behind five half swings."""
    time = np.arange(-0.3 * half, 16.0 * half, 1e-3)
    slower = np.where(time < 5.0 * half, time, 5.0 * half + (time - 5.0 * half) / 1.01)  # as no side computes it
    number = np.floor(slower / half)
    middle = 0.5 * loss * (-1.0) ** number  # a half swing is a cosine about a point that friction shifts
    angle = middle + (0.0659 - (number + 0.5) * loss) * np.cos(np.pi * slower / half)
    angle[number >= 13] = angle[number < 13][-1]
    return FreeSwing(time, -step * np.round(angle / step))


def test_losses_and_later_turns_of_a_known_swing_are_met(tmp_path: Path, monkeypatch):
    monkeypatch.setattr("comparison.evidence.validation.files.Workers", Here)
    half, loss, step = 0.39, 0.005, 1.5e-4
    known = known_decay(half, loss, step)
    signals = {"values": math.pi + known.angle}
    savemat(tmp_path / DECAY_FILE, {"Theta1": {"time": known.time, "signals": signals}})
    swing = read_folder(tmp_path).decay
    np.testing.assert_allclose(swing.angle, known.angle, atol=1e-12)
    found = pendulum.compare_decay(swing)
    assert float(found.inputs[1].split("swing ")[1].split(" ")[0]) == pytest.approx(loss, abs=3e-5)
    turns = np.array(found.curves[0].y[:11])  # mrad
    design = np.column_stack([np.ones(11), np.arange(11), (-1.0) ** np.arange(11)])
    factors, [left], *_ = np.linalg.lstsq(design, turns, rcond=None)
    most = 1e-3 * np.abs(turns - design @ factors).max() / step
    deviation = math.sqrt(left / (11 - 3) * np.linalg.inv(design.T @ design)[1, 1])
    assert f"± {2e-3 * deviation:.2g} rad" in found.inputs[1]
    assert found.quantities[0].data == pytest.approx(2e3 * step / math.sqrt(12.0)), "the encoder reads in steps"
    said = r"pendulum, decay: each of the first 10 half swings loses 0\.0050\d rad; the turning points are within "
    assert re.fullmatch(rf"{said}{most:.1f} steps of the encoder \(0\.000150 rad\) of a line", found.facts[0])
    for each in found.quantities[:4]:
        assert {side.verdict for side in each.sides.values()} == {MET}, each
    assert [each.use for each in found.quantities] == ["calibrated"] * 2 + ["predicted"] * 4
    periods = np.diff(pendulum._find_turns(swing, 3.0 * step)[0])
    first, last = (2.0 * part.std(ddof=1) / math.sqrt(5.0) for part in (periods[:5], periods[5:10]))
    assert (found.quantities[5].measured, found.quantities[5].data) == pytest.approx(
        (1010.0 * half, 1e3 * last), rel=2e-3
    )
    for row, text in (
        (0, f"half period {periods[:5].mean():.5g} ± {first:.2g} s"),
        (2, f" ± {step / math.sqrt(3.0):.2g} rad"),
    ):
        assert text in found.inputs[row]
    steps = FreeSwing(np.arange(12.0), np.array([0.0, 1, 2, 2, 2, 1, 0, -1, -1, 0, 1, 1]))
    assert np.transpose(pendulum._find_turns(steps, 0.5)).tolist() == [[3.0, 2.0], [7.5, -1.0], [11.0, 1.0]]


def test_half_periods_are_those_of_elliptic_integrals(tmp_path: Path, monkeypatch):
    """Each window of amplitudes has a half period and a scatter of its own."""
    monkeypatch.setattr("comparison.evidence.validation.files.Workers", Here)
    mean = pendulum._compute_uncertainty_of_mean(np.array([1.0, 3.0, 1.0, 3.0]))
    assert mean == pytest.approx(COVERAGE_FACTOR * np.sqrt(4.0 / 3.0) / 2.0), "scatter over the root of the count"
    windows = {1.5: (0.39, 2e-4), 1.25: (0.395, 3e-4), 1.0: (0.39, 4e-4), 0.6: (0.39, 5e-4), 0.3: (0.392, 1e-4)}
    factors = {angle: 2.0 * float(ellipk(np.sin(0.5 * angle) ** 2)) / np.pi for angle in windows}
    amplitude, time = 1.603, 0.0
    instants, angles, counts = [], [], dict.fromkeys(windows, 0)
    while amplitude > 0.19:
        at = min(windows, key=lambda angle: abs(angle - amplitude))
        counts[at] += abs(at - amplitude) < 0.1
        length, scatter = windows[at]
        length += scatter * (-1.0) ** (len(angles) // 200)
        half = 2.0 * float(ellipk(np.sin(0.5 * amplitude) ** 2)) / np.pi * length
        dense = np.linspace(0.0, np.pi, 200, endpoint=False)
        instants += list(time + half * dense / np.pi)
        angles += list((-1.0) ** (len(angles) // 200) * amplitude * np.sin(dense))
        time, amplitude = time + half, amplitude - 0.01
    even = np.arange(0.0, time, 1e-3)
    cells: dict[str, np.ndarray] = {name: np.empty(2, dtype=object) for name in PARTS}
    for number, part in enumerate(np.array_split(np.arange(len(even)), 4)):
        kind = ("id", "vad")[number // 2]
        angle = math.pi + np.interp(even[part], instants, angles)
        cells[f"Time_{kind}"][number % 2], cells[f"Y_{kind}"][number % 2] = even[part], np.array([angle, 0.0 * angle])
    savemat(tmp_path / LARGE_SWING_FILE, cells)
    swing = read_folder(tmp_path).large
    np.testing.assert_allclose(swing.angle, np.interp(even, instants, angles), atol=1e-12)
    monkeypatch.setattr(pendulum, "MIN_HALF_SWINGS", min(counts.values()) + 1)
    with pytest.raises(SceneError, match=f"Y must have {min(counts.values()) + 1} half swings within 0.1 of"):
        pendulum.compare_large_swings(swing)
    monkeypatch.setattr(pendulum, "MIN_HALF_SWINGS", min(counts.values()))
    found = pendulum.compare_large_swings(swing)
    gone = "gone with the half period fitted at 0.6 rad"
    causes = [f"{INPUT_CAUSE}: {gone}, where friction weighs less", f"{NO_CAUSE}: not {gone}"]
    _, half, _, uncertainty, *_ = found.inputs[0].removeprefix("pendulum, large angles: half ").split(" ")
    assert float(half) == pytest.approx(0.392, rel=1e-4)
    assert float(uncertainty) == pytest.approx(2e-4 / math.sqrt(counts[0.3] - 1), rel=0.1)
    assert " s (fitted" in found.inputs[0]
    for each, angle, cause in zip(found.quantities, (1.5, 1.25, 1.0), (*causes, causes[0])):
        length, scatter = windows[angle]
        assert abs(each.sides[EQUATIONS].value / each.measured - 0.392 / length) < 2e-4, each
        assert abs(each.sides[ENGINE].value / each.measured - 0.392 / length) < 4e-4, each
        assert each.measured == pytest.approx(1e3 * factors[angle] * length, rel=3e-4)
        assert each.data == pytest.approx(2e3 * factors[angle] * scatter / math.sqrt(counts[angle] - 1), rel=0.1)
        assert each.inputs == pytest.approx(each.measured / length * float(uncertainty), rel=0.05)
        assert each.cause == cause
    curve = found.curves[0]
    assert (curve.x[0], curve.y[0]) == pytest.approx((1.593, 1e3 * (instants[400] - instants[200])), rel=1e-4)
    off = [100.0 * (0.392 / windows[angle][0] / factors[angle] - 1.0) for angle in (1.5, 1.25, 1.0)]
    said = "-13.5 % at 1.5 rad, -10.4 % at 1.25 rad, -5.7 % at 1 rad"
    assert [float(part.split(" %")[0]) for part in said.split(", ")] == pytest.approx(off, abs=0.1)
    assert found.facts == [f"pendulum, large angles: the half period of the small-vibration equations is off by {said}"]


@pytest.mark.long
def test_both_sides_meet_runs_of_an_independent_program(tmp_path: Path):
    save(tmp_path, 250)
    save(tmp_path, 450, offset=0.3)
    table = compare_folder(tmp_path)
    assert len(table.quantities) == 10
    assert table.counts()[MET] == 20
    assert "ratio of this run alone is 0.240" in table.facts[1]


@pytest.mark.long
@pytest.mark.skipif(not MEASURED, reason="PHASE_RESONANCE_MEASURED names no folder with the published files")
def test_the_recorded_table_is_that_of_the_published_files():
    table = compare_folder(Path(MEASURED))
    new = {(each.experiment, each.name): each for each in table.quantities}
    for each in load_record().quantities:
        again = new[each.experiment, each.name]
        assert again.measured == pytest.approx(each.measured, rel=1e-6)
        for side, computed in each.sides.items():
            assert again.sides[side].value == pytest.approx(computed.value, abs=3.0 * computed.numerical + 1e-5)
            assert again.sides[side].verdict == computed.verdict


def test_page_and_terminal_have_the_recorded_table(capsys: pytest.CaptureFixture[str]):
    assert main([]) == 0
    printed = capsys.readouterr().out
    inputs = [f"\nInput of the {text}.\n" for text in load_record().inputs]
    for part in ("so the ratio depends on the load", "arXiv 2303.03858", "GPL-3.0", "MultiArm-Pendulum", *inputs):
        assert part in printed, part
    lines = [re.split(r"\s{2,}", line.strip()) for line in printed.splitlines()]
    heads = ["quantity", "D", "u_D", "u_input", "E equations", "u_num", "E engine", "u_num", "u_val", "verdict"]
    assert heads in lines
    assert sum(load_record().counts().values()) == 2 * len(load_record().quantities)
    assert load_record().curves == []  # nothing of the files is in the package
    for each in load_record().quantities:
        equations, smoothed, engine = (each.sides[side] for side in (EQUATIONS, SMOOTHED, ENGINE))
        measured = f"{each.measured:.5g}"
        sides = [number for side in (equations, engine) for number in (side.error, side.numerical)]
        numbers = [f"{n:.2g}" for n in (each.data, each.inputs, *sides, equations.validation)]
        assert [measured, *numbers] in [cells[1:-1] for cells in lines]
        assert abs(engine.value - smoothed.value) <= engine.numerical + smoothed.numerical, each


X, Y = "s_b_250g_x.mat", "s_b_250g_y.mat"


def test_runs_are_in_the_order_of_weights_and_may_hold_whole_numbers(tmp_path, monkeypatch):
    monkeypatch.setattr("comparison.evidence.validation.files.Workers", Here)
    save(tmp_path, 250)
    for grams, file in product((1050, 90), (X, Y)):
        copyfile(tmp_path / file, tmp_path / file.replace("250", str(grams)))
    found = loadmat(tmp_path / X)
    savemat(tmp_path / X, {"t": found["t"], "x": found["x"].round().astype(np.int16)})
    runs = read_folder(tmp_path).runs
    assert [run.weight for run in runs] == [0.09, 0.25, 1.05]
    np.testing.assert_array_equal(runs[1].plate, found["x"].round().ravel())


def make(folder: Path) -> Path:
    folder.mkdir()
    return folder


def shift(folder: Path, seconds: float) -> None:
    """Let the clock of the base be wrong."""
    found = loadmat(folder / Y)
    savemat(folder / Y, {"t": found["t"] + seconds, "y": found["y"]})


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda folder: (folder / Y).unlink(), "s_b_250g_y.mat is missing"),
        (lambda folder: (folder / X).unlink(), "s_b_250g_x.mat is missing"),
        (lambda folder: savemat(folder / X, {"t": np.arange(700.0), "x": np.zeros((700, 3))}), "x must be one column"),
        (lambda folder: (folder / Y).write_bytes(b"MATLAB 5.0" + bytes(range(256)) * 4), "must be a MATLAB file"),
        (lambda folder: shift(folder, 0.01), "t must be the same as in s_b_250g_x.mat"),
        (lambda folder: shift(folder, -0.01), "t must be the same as in s_b_250g_x.mat"),
        (lambda folder: [file.unlink() for file in folder.iterdir()], "holds none of the measured files"),
        (lambda folder: folder.rename(folder.with_name("other")), "must be a folder"),
        (lambda folder: [save(make(folder / part), 350) for part in "ab"], "must hold each file once: also a/s_b_350"),
    ],
)  # fmt: skip
def test_wrong_files_end_in_one_line(tmp_path, capsys, monkeypatch, spoil, said):
    monkeypatch.setattr("comparison.evidence.validation.files.Workers", Here)
    folder = tmp_path / "files"
    folder.mkdir()
    save(folder, 250)
    spoil(folder)
    assert main([str(folder), "--out", str(tmp_path / "report")]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1
    assert said in error


def test_a_side_without_a_value_is_an_exit_code(monkeypatch, tmp_path: Path, capsys):
    first, *rest = load_record().quantities
    nothing = table.SideComparison(None, None, None, None, NOT_COMPARED)
    lacking = replace(first, sides={**first.sides, ENGINE: nothing})
    for quantities, code in ((load_record().quantities, 0), ([lacking, *rest], 1)):
        table_of_folder = replace(load_record(), quantities=quantities)
        monkeypatch.setattr(command, "compare_folder", lambda folder, found=table_of_folder: found)
        assert main([str(tmp_path), "--out", str(tmp_path / "report")]) == code
        lines = [re.split(r"\s{2,}", line.strip()) for line in capsys.readouterr().out.splitlines()]
        (cells,) = (each for each in lines if each[1:2] == [f"{first.measured:.5g}"])
        assert cells.count("-") == 2 * code


@pytest.mark.parametrize("side", [SMOOTHED, ENGINE])
def test_what_one_side_computes_is_its_own(side: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Planted: a motion of that side alone whose times are a tenth longer."""
    asked, compute = [], pendulum._compute_half_swings

    def longer(by: str, *given: Any) -> Any:
        asked.append(by)
        return compute(EQUATIONS, 1.1 * given[0] if by == side else given[0], *given[1:])

    monkeypatch.setattr(pendulum, "_compute_half_swings", longer)
    found = pendulum.compare_decay(known_decay(0.39, 0.005, 1.5e-4))
    assert {*asked} == {EQUATIONS, SMOOTHED, ENGINE}
    values = {by: found.quantities[5].sides[by].value for by in (EQUATIONS, SMOOTHED, ENGINE)}
    assert {by for by, value in values.items() if value == pytest.approx(1.1 * values[EQUATIONS], rel=1e-3)} == {side}


def test_a_comparison_error_is_within_all_uncertainties():
    """0.03, 0.04 and 0.12 make 0.13: 0.1285 is within, 0.135 is not; the engine's error is 0.02."""
    one, nan = np.ones(4), np.nan
    measured = np.array([1.0, 1.0, 1.0, nan])
    data = table.MeasuredData("abcd", ("mm",) * 4, ("predicted",) * 4, measured, 0.12 * one)
    values = np.array([1.1285, 1.135, 1.0, 1.0])
    answers = {side: table.ComputedValues(values, 0.03 * one) for side in (EQUATIONS, SMOOTHED, ENGINE)}
    answers[SMOOTHED], answers[ENGINE] = (
        answers[SMOOTHED]._replace(values=2.0 * one),
        answers[ENGINE]._replace(errors=0.02 * one),
    )
    varied = [values + np.array([0.024, 0.024, nan, 0.0]), values - 0.032]
    rows = table.compare_quantities("run", data, answers, varied, lambda k, allowed: f"{k}: {allowed:.4f}")
    assert [each.sides[EQUATIONS].verdict for each in rows] == [MET, NOT_MET, NOT_COMPARED], "the last was not measured"
    assert [each.sides[EQUATIONS].error for each in rows] == pytest.approx([0.1285, 0.135, 0.0])
    assert rows[0].sides[EQUATIONS].validation == pytest.approx(0.13)
    assert [each.cause for each in rows] == ["0: 0.1281", f"1: {math.hypot(0.02, 0.04, 0.12):.4f}", ""]
    alike = {side: answers[SMOOTHED if side == SMOOTHED else EQUATIONS] for side in answers}
    (met, *_) = table.compare_quantities("run", data, alike, varied, lambda k, allowed: "a cause")
    assert (met.sides[SMOOTHED].verdict, met.sides[ENGINE].verdict, met.cause) == (NOT_MET, MET, "")
    with pytest.raises(ValueError, match="sides must have engine"):
        replace(rows[0], sides={EQUATIONS: rows[0].sides[EQUATIONS]})
