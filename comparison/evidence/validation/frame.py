"""
Shaken frame: runs predicted with friction that is fitted to other runs.

By the constant law one friction ratio is fitted to the motion of one run, and all others are predicted. By friction of
the load the ratio is a power of the load, as `load_exponent` has it: it is fitted to the motions of two runs, and the
others are predicted.

With y the motion of the base, z that of the top plate, both absolute, and r w g the friction of the disc of mass w,

    M z'' + C z' + K z + r w g sign(z') = K y + C y'

is the platform on the isolator, shaken by -(K y + C y') / M. Viscous damping is friction that grows with the speed,
mu(v) = mu_0 + C v / (m_sum g), of the velocity-dependent law far below its upper limit. A second body ten times as
heavy on a link so soft that it does nothing lends its weight: the sphere is then eleven times as large and as good
as a parabola, as a spring is.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from comparison.evidence.sides import ENGINE, EQUATIONS, interpolate_platform
from comparison.evidence.validation import table
from comparison.evidence.validation.cycles import CYCLE_SAMPLES, Cycles, fold_run, measure_cycle
from comparison.evidence.validation.files import FrameRun
from comparison.result_types import Array
from comparison.study.study import STUDY_TOLERANCE
from reference.problem import GRAVITY, Scene, Trajectory

# Mass of a second body, which only lends its weight, over that of the platform; period of its soft link, s
SHAKER_MASS_RATIO, SHAKER_LINK_PERIOD = 10.0, 1e4
FRICTION_GROWTH = 1.0  # rise of friction at infinite speed; its slope at zero speed is the frame's viscous damping
COMPUTED_CYCLES = 12  # cycles that are computed, of which the last one is read
ENGINE_V_REG = 1e-4  # m/s, v_reg of the engine
FIRST_FITTED_WEIGHT = 0.250  # kg, disc of the run to which the friction ratio is fitted, if the folder has it
# kg, disc of the second run to which load-dependent friction is fitted, if the folder has it
SECOND_FITTED_WEIGHT = 0.450
DIFFERENCE_STEP = 0.005  # relative step of friction ratio and base scale in difference quotients
# Quantities of a cycle of the plate that are compared, and their units
NAMES = ("half range", "rms about the mean", "share of time at rest", "phase of the starts", "phase of the stops")
UNITS = ("mm", "mm", table.CYCLE, table.DEGREES, table.DEGREES)


class Setup(NamedTuple):
    """Inputs of the computation of a frame run: plate and frame, base motion, weight and friction of the disc."""

    mass: float = 3.0799  # kg, mass of the plate
    stiffness: float = 1191.0  # N/m, stiffness of the frame
    damping: float = 0.6690  # N s/m, damping of the frame
    scale: float = 1.0  # factor on the base motion
    second: float = 0.0  # share of the measured second harmonic of the base
    disc: float = 1.0  # weight of the disc over the stated one
    ratio: float = 0.3  # friction ratio


INPUT_UNCERTAINTIES = {  # uncertainty of each input with its name, unit and source
    "mass": (0.01 * Setup().mass, "mass", "kg", "authors; 1 % assumed"),
    "stiffness": (0.01 * Setup().stiffness, "stiffness", "N/m", "authors; 1 % assumed"),
    "damping": (0.2 * Setup().damping, "viscous damping", "N s/m", "authors; 20 % assumed"),
    "scale": (0.01, "base motion over plate motion, scales of the sensors", "", "1 % assumed"),
    "second": (1.0, "share of the second harmonic of the base", "", "0 or the measured one, 1 % of the first: assumed"),
    "disc": (0.01, "weight of the disc over the stated one", "", "authors; 1 % assumed"),
}
# inputs whose change by their uncertainty requires a new fit of the friction ratio
REFITTED_INPUTS = ("mass", "stiffness", "damping", "scale", "second")


def make_frame_scene(cycles: Cycles, setup: Setup) -> tuple[Scene, tuple[float, float]]:
    """Return the frame as a scene with its phases."""
    weight = (1.0 + SHAKER_MASS_RATIO) * setup.mass * GRAVITY
    base = setup.scale * np.array([cycles.amplitude, setup.second * cycles.second]) * 1e-3
    turns = 2j * np.pi * cycles.frequency * np.array([1.0, 2.0])
    ground = -(setup.stiffness + setup.damping * turns) * base / setup.mass
    mu = setup.ratio * setup.disc * cycles.run.weight * GRAVITY / weight
    scene = {
        "title": f"Shaken frame, {1e3 * cycles.run.weight:g} g",
        "name": "shaken-frame",
        "duration": COMPUTED_CYCLES / cycles.frequency,
        "isolator": {
            "radius": weight / setup.stiffness,
            "friction": {"slow": mu, "fast": mu + FRICTION_GROWTH, "rate": setup.damping / (weight * FRICTION_GROWTH)},
        },
        "bodies": [
            {"mass": setup.mass},
            {"mass": SHAKER_MASS_RATIO * setup.mass, "period": [SHAKER_LINK_PERIOD, SHAKER_LINK_PERIOD]},
        ],
        "excitation": {
            "amplitudes": [np.abs(ground).tolist(), [0.0, 0.0]],
            "periods": [1.0 / cycles.frequency, 0.5 / cycles.frequency],
            "decay": [0.0, 0.0],
        },
    }
    phases = np.angle(ground)
    return Scene.model_validate(scene), (float(phases[0]), float(phases[1]))


def read_last_cycle(motion: Trajectory, frequency: float) -> Array:
    """Return the last computed cycle, mm about its mean."""
    grid = (COMPUTED_CYCLES - 1 + np.arange(CYCLE_SAMPLES) / CYCLE_SAMPLES) / frequency
    place = 1e3 * interpolate_platform(motion)(grid)
    about: Array = place - place.mean()
    return about


def compute_frame_motion(side: str, cycles: Cycles, setup: Setup) -> Trajectory:
    """Return the motion of a run by one code, from the largest position of the base on."""
    scene, phases = make_frame_scene(cycles, setup)
    place = np.array([1e-3 * cycles.amplitude, 0.0])
    return table.compute_released_motion(side, scene, phases, place, ENGINE_V_REG, STUDY_TOLERANCE, "small")


def read_quantities(cycles: Cycles, motion: Trajectory) -> table.ComputedValues:
    """Return the compared quantities, `NAMES`, of a computed motion of a run."""
    rate = cycles.frequency
    return table.read_motion_values(motion, lambda each: measure_cycle(read_last_cycle(each, rate), rate), len(NAMES))


def solve_quantities(cycles: Cycles, setup: Setup) -> Array:
    """Return the compared quantities, `NAMES`, of a run by the equations."""
    return read_quantities(cycles, compute_frame_motion(EQUATIONS, cycles, setup)).values


def fit_inputs(cycles: Cycles, setup: Setup, *names: str) -> tuple[Setup, Array]:
    """Return the inputs with which the equations come closest to the mean cycle, and their scatter (J, names)."""

    def curve(at: Setup) -> Array:
        """Return the last computed cycle of the plate with these inputs."""
        return read_last_cycle(compute_frame_motion(EQUATIONS, cycles, at), cycles.frequency)

    for _ in range(12):
        nearby = [setup._replace(**{name: getattr(setup, name) + DIFFERENCE_STEP}) for name in names]
        begin = curve(setup)
        slopes = np.column_stack([(curve(each) - begin) / DIFFERENCE_STEP for each in nearby])
        change = np.linalg.lstsq(slopes, cycles.mean - begin, rcond=None)[0]
        setup = setup._replace(**{n: max(1e-3, getattr(setup, n) + part) for n, part in zip(names, change)})
        if np.abs(change).max() < 1e-5:
            break
    each = cycles.motions - cycles.motions.mean(axis=1, keepdims=True) - cycles.mean
    scatter: Array = np.linalg.lstsq(slopes, each.T, rcond=None)[0].T
    return setup, scatter


class FittedRun(NamedTuple):
    """
    A run with the friction ratio fitted to its motion.

    spread: of the ratio, by the scatter over the cycles. changed: fitted again with each input of REFITTED_INPUTS
    changed by its uncertainty. shifted: fitted with the base motion that the run of the constant ratio fits best.
    """

    cycles: Cycles
    setup: Setup
    spread: float
    changed: list[Setup]
    shifted: Setup

    def variations(self) -> list[Setup]:
        """Return setups in which each input is changed by its uncertainty."""
        heavier = self.setup._replace(disc=self.setup.disc + INPUT_UNCERTAINTIES["disc"][0])
        return [self.setup._replace(ratio=self.setup.ratio + self.spread), heavier, *self.changed]


def fit_run(cycles: Cycles, start: Setup, shift: Setup | None = None) -> FittedRun:
    """Return a run with its fitted friction ratio. shift: setup whose base scale `shifted` takes; None to fit it."""
    setup, scatter = fit_inputs(cycles, start, "ratio")
    spread = table.COVERAGE_FACTOR * float(scatter[:, 0].std(ddof=1))
    changes = ({name: getattr(setup, name) + INPUT_UNCERTAINTIES[name][0]} for name in REFITTED_INPUTS)
    changed = [fit_inputs(cycles, setup._replace(**change), "ratio")[0] for change in changes]
    if shift is None:
        shifted, _ = fit_inputs(cycles, setup, "ratio", "scale")
    else:
        shifted, _ = fit_inputs(cycles, setup._replace(scale=shift.scale), "ratio")
    return FittedRun(cycles, setup, spread, changed, shifted)


def compare_frame(runs: Sequence[FrameRun]) -> table.ExperimentFindings:
    """Return the comparison of all runs: by one ratio, and by load-dependent friction if runs remain to predict."""
    folded = [fold_run(run) for run in runs]
    first = min(folded, key=lambda cycles: (abs(cycles.run.weight - FIRST_FITTED_WEIGHT) > 1e-9, cycles.run.weight))
    fitted = fit_run(first, Setup())
    setup, varied = fitted.setup, fitted.variations()
    own = [setup if each is first else fit_inputs(each, setup, "ratio")[0] for each in folded]
    inputs = [
        table.word_input(f"frame: {name}", getattr(setup, key), size, unit, source)
        for key, (size, name, unit, source) in INPUT_UNCERTAINTIES.items()
    ]
    inputs.append(_word_fitted_friction_ratio(fitted))
    parts = [
        _compare_run(each, "calibrated" if each is first else "predicted", setup, varied, fitted.shifted, best)
        for each, best in zip(folded, own)
    ]
    rest = [(each, best) for each, best in zip(folded, own) if each is not first]
    if any(_is_sliding(each) for each, _ in rest):
        parts.append(_compare_by_load(fitted, rest))
    return table.join_findings([table.ExperimentFindings([], inputs, [], [], []), *parts])


def _is_sliding(cycles: Cycles) -> bool:
    """Return whether the plate slides for a part of the mean cycle."""
    return bool(measure_cycle(cycles.mean, cycles.frequency)[2] < 100.0)


def _word_fitted_friction_ratio(fitted: FittedRun) -> str:
    """Return the fitted friction ratio as a row of the inputs, with its scatter over the cycles."""
    source = f"fitted to the motion of the run with {1e3 * fitted.cycles.run.weight:g} g; its scatter over the cycles"
    return table.word_input("frame: friction ratio", fitted.setup.ratio, fitted.spread, "", source)


def _compare_by_load(first: FittedRun, rest: Sequence[tuple[Cycles, Setup]]) -> table.ExperimentFindings:
    """Return predictions of runs by friction that is a power of the load, fitted to two other runs."""
    sliding = [cycles for cycles, _ in rest if _is_sliding(cycles)]
    chosen = min(sliding, key=lambda cycles: abs(cycles.run.weight - SECOND_FITTED_WEIGHT))
    second = fit_run(chosen, first.setup, first.shifted)
    one, two = first.setup.ratio, second.setup.ratio
    begin, end = (math.log(each.cycles.run.weight) for each in (first, second))
    exponent = math.log(two / one) / (end - begin)
    fact = (
        f"frame: the friction ratios fitted to {first.cycles.run.name} and to {second.cycles.run.name} "
        f"grow as the load to the power {exponent:.3f}"
    )
    found = [table.ExperimentFindings([], [_word_fitted_friction_ratio(second)], [fact], [], [])]
    for cycles, own in rest if len(rest) > 1 else ():
        share = (math.log(cycles.run.weight) - begin) / (end - begin)

        def between(setup: Setup, low: float, high: float, share: float = share) -> Setup:
            """Return the inputs with a friction ratio interpolated as a power of the load."""
            return setup._replace(ratio=low * (high / low) ** share)

        pairs = zip([*first.changed, first.shifted], [*second.changed, second.shifted])
        *changed, shifted = (between(low, low.ratio, high.ratio) for low, high in pairs)
        setup = between(first.setup, one, two)
        scattered = [between(setup, one + first.spread, two), between(setup, one, two + second.spread)]
        heavier = setup._replace(disc=setup.disc + INPUT_UNCERTAINTIES["disc"][0])
        use = "calibrated" if cycles is chosen else "predicted"
        found.append(
            _compare_run(cycles, use, setup, [*scattered, heavier, *changed], shifted, own, table.LOAD_FRICTION_SUFFIX)
        )
    return table.join_findings(found)


def _compare_run(
    cycles: Cycles, use: str, setup: Setup, varied: Sequence[Setup], other: Setup, own: Setup, law: str = ""
) -> table.ExperimentFindings:
    """Return the comparison of one run. other: setup with fitted base scale; own: setup with the ratio of this run."""
    title = cycles.run.name + law
    found = [measure_cycle(motion, cycles.frequency) for motion in cycles.motions]
    data = table.MeasuredData(
        NAMES, UNITS, [use] * 5, np.mean(found, axis=0), table.COVERAGE_FACTOR * np.std(found, axis=0, ddof=1)
    )
    motions = {side: compute_frame_motion(side, cycles, setup) for side in table.SIDES}
    answers = {side: read_quantities(cycles, motion) for side, motion in motions.items()}
    by_input, by_ratio = (np.abs(solve_quantities(cycles, each) - data.values) for each in (other, own))

    def explain(k: int, allowed: float) -> str:
        """Return which change of the inputs brings quantity `k` within the allowed difference."""
        shift = f"a base motion of {100.0 * (other.scale - 1.0):+.1f} % and ratio {other.ratio:.3f}"
        if by_input[k] <= allowed:
            return f"{table.INPUT_CAUSE}: gone with {shift}"
        if by_ratio[k] <= allowed:
            return (
                f"{table.LAW_CAUSE}: gone with the ratio of this run, {own.ratio:.3f}, so the ratio depends on the load"
            )
        return f"{table.NO_CAUSE}: gone neither with the ratio of this run, {own.ratio:.3f}, nor with {shift}"

    rows = table.compare_quantities(title, data, answers, [solve_quantities(cycles, each) for each in varied], explain)
    best = read_last_cycle(compute_frame_motion(EQUATIONS, cycles, own), cycles.frequency)
    lines = {"measured": cycles.mean} | {
        side: read_last_cycle(motions[side], cycles.frequency) for side in (EQUATIONS, ENGINE)
    }
    off = float(np.std(lines[EQUATIONS] - cycles.mean))
    middle = 0.5 * (cycles.mean.max() + cycles.mean.min())
    fact = (
        f"{title}: the friction ratio of this run alone is {own.ratio:.3f}; the motion over a cycle is then "
        f"off by {np.std(best - cycles.mean):.3f} mm rms, and by {off:.3f} mm with {setup.ratio:.3f}; the plate is "
        f"above its middle for {100.0 * np.mean(cycles.mean > middle):.0f} % of a cycle"
    )
    residual = table.CycleResidual(title, use, off / float(data.values[0]))
    axes, turn = ("phase of the base, deg", "top plate, mm"), np.arange(CYCLE_SAMPLES) * 360.0 / CYCLE_SAMPLES
    return table.ExperimentFindings(
        rows,
        [],
        [fact],
        [residual],
        table.make_plot_curves(title, axes, {name: (turn, y) for name, y in lines.items()}),
    )
