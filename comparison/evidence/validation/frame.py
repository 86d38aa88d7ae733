"""
Shaken frame: runs predicted with friction that is fitted to other runs.

The friction ratio is the friction force over the weight of a disc that presses on the plate; runs differ in this
weight, the load. By the constant law, one ratio is fitted to the motion of one run, and all others are predicted. By
load-dependent friction, the ratio is a power of the load (`load_exponent`): it is fitted to the motions of two runs,
and the others are predicted.

With y the motion of the base, z that of the top plate, both absolute, and r w g the friction of the disc of mass w,

    M z'' + C z' + K z + r w g sign(z') = K y + C y'

is the equation of the platform on the isolator, shaken by the acceleration -(K y + C y') / M. Viscous damping becomes
friction that grows with the speed: the friction coefficient is f_0 + C v / (m_sum g), which is the velocity-dependent
law far below its limit. A second body, ten times as heavy, presses on the platform by a link so soft that it exerts no
other force. The sphere with the stiffness of the frame is then eleven times as large, so large that it acts as a
spring.
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

# Second body, which only presses on the platform: its mass / that of the platform; period of its soft link, s
SHAKER_MASS_RATIO, SHAKER_LINK_PERIOD = 10.0, 1e4
FRICTION_GROWTH = 1.0  # fast minus slow friction coefficient; its slope over speed, at zero, stands for frame damping
COMPUTED_CYCLES = 12  # number of cycles computed; only the last one is compared with the measurement
ENGINE_V_REG = 1e-4  # m/s, sliding speed below which friction is linear in Exudyn
FIRST_FITTED_WEIGHT = 0.250  # kg, disc of the run that constant friction is fitted to; if not measured, the lightest
# kg, disc of the second run, to which load-dependent friction is fitted as well, or the disc closest to it
SECOND_FITTED_WEIGHT = 0.450
DIFFERENCE_STEP = 0.005  # change of friction ratio, or of the factor on base motion, in difference quotients of the fit
# Quantities of a cycle of the plate that are compared, and their units
NAMES = ("half range", "rms about the mean", "share of time at rest", "phase of the starts", "phase of the stops")
# units of the compared quantities, in the order of NAMES
UNITS = ("mm", "mm", table.CYCLE, table.DEGREES, table.DEGREES)


class Setup(NamedTuple):
    """Inputs with which a run of the frame is computed; the defaults are those that the authors of the runs state."""

    mass: float = 3.0799  # kg, mass of the plate
    stiffness: float = 1191.0  # N/m, stiffness of the frame
    damping: float = 0.6690  # N s/m, damping of the frame
    scale: float = 1.0  # factor by which the measured base motion is multiplied
    second: float = 0.0  # share of the base's measured second harmonic that is applied: 0 none, 1 all
    disc: float = 1.0  # weight of the disc / stated weight
    ratio: float = 0.3  # friction force / weight of the disc


INPUT_UNCERTAINTIES = {  # inputs of a frame run, by field of Setup: uncertainty, name, unit and source
    "mass": (0.01 * Setup().mass, "mass", "kg", "authors; 1 % assumed"),
    "stiffness": (0.01 * Setup().stiffness, "stiffness", "N/m", "authors; 1 % assumed"),
    "damping": (0.2 * Setup().damping, "viscous damping", "N s/m", "authors; 20 % assumed"),
    "scale": (0.01, "base motion over plate motion, scales of the sensors", "", "1 % assumed"),
    "second": (1.0, "share of the second harmonic of the base", "", "0 or the measured one, 1 % of the first: assumed"),
    "disc": (0.01, "weight of the disc over the stated one", "", "authors; 1 % assumed"),
}
# Fields of Setup: when one is changed by its uncertainty, the friction ratio is fitted again
REFITTED_INPUTS = ("mass", "stiffness", "damping", "scale", "second")


def make_frame_scene(cycles: Cycles, setup: Setup) -> tuple[Scene, tuple[float, float]]:
    """
    Return a scene equivalent to a run of the frame, and the phases of its two harmonics, rad.

    The module's docstring derives it. Here base and ground motions are complex amplitudes of both harmonics.
    """
    weight = (1.0 + SHAKER_MASS_RATIO) * setup.mass * GRAVITY
    base = setup.scale * np.array([cycles.amplitude, setup.second * cycles.second]) * 1e-3  # m
    rates = 2j * np.pi * cycles.frequency * np.array([1.0, 2.0])  # i omega
    ground = -(setup.stiffness + setup.damping * rates) * base / setup.mass  # m/s^2
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
    """Return the platform's motion in the last computed cycle, mm, about its mean position, (samples,)."""
    grid = (COMPUTED_CYCLES - 1 + np.arange(CYCLE_SAMPLES) / CYCLE_SAMPLES) / frequency
    place = 1e3 * interpolate_platform(motion)(grid)
    about: Array = place - place.mean()
    return about


def compute_frame_motion(side: str, cycles: Cycles, setup: Setup) -> Trajectory:
    """Return the motion of a frame run by one code (side); it begins at the largest position of the base."""
    scene, phases = make_frame_scene(cycles, setup)
    place = np.array([1e-3 * cycles.amplitude, 0.0])
    return table.compute_released_motion(side, scene, phases, place, ENGINE_V_REG, STUDY_TOLERANCE, "small")


def read_quantities(cycles: Cycles, motion: Trajectory) -> table.ComputedValues:
    """Return the quantities `NAMES` of the last cycle of a computed frame motion, with numerical errors."""
    rate = cycles.frequency
    return table.read_motion_values(motion, lambda each: measure_cycle(read_last_cycle(each, rate), rate), len(NAMES))


def solve_quantities(cycles: Cycles, setup: Setup) -> Array:
    """Return the quantities `NAMES` of a frame run as computed by the reference equations."""
    return read_quantities(cycles, compute_frame_motion(EQUATIONS, cycles, setup)).values


def fit_inputs(cycles: Cycles, setup: Setup, *names: str) -> tuple[Setup, Array]:
    """
    Return `setup` with the inputs in `names` fitted to the mean measured cycle, and their scatter over the cycles.

    The motions are computed by the equations. The scatter has a row for each measured cycle, a column for each name.
    """

    def curve(at: Setup) -> Array:
        """Return the motion of the plate in the last computed cycle with the inputs `at`, mm."""
        return read_last_cycle(compute_frame_motion(EQUATIONS, cycles, at), cycles.frequency)

    # Gauss-Newton iteration: a linear least-squares fit with slopes by difference quotients, again and again.

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
    Measured run of the frame with the inputs of its computation, the friction ratio among them fitted to its motion.

    setup: fitted inputs. spread: uncertainty of the ratio, from its scatter over the cycles. changed: for each of
    REFITTED_INPUTS, the inputs that are fitted after it was changed by its uncertainty. shifted: inputs that are
    fitted with the factor on the base motion fitted as well, or taken over from another run.
    """

    cycles: Cycles
    setup: Setup
    spread: float
    changed: list[Setup]
    shifted: Setup

    def variations(self) -> list[Setup]:
        """Return a list of the fitted inputs, in each of which one input is changed by its uncertainty."""
        heavier = self.setup._replace(disc=self.setup.disc + INPUT_UNCERTAINTIES["disc"][0])
        return [self.setup._replace(ratio=self.setup.ratio + self.spread), heavier, *self.changed]


def fit_run(cycles: Cycles, start: Setup, shift: Setup | None = None) -> FittedRun:
    """
    Return a run with its fitted friction ratio; the fits begin at the inputs `start`.

    shift: inputs whose factor on the base motion enters `FittedRun.shifted`; if None, this factor is fitted as well.
    """
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
    """Compare all frame runs with predictions by one friction ratio, and by load-dependent friction if possible."""
    # The first run is that to which the ratio is fitted. `own` has, for each run, the inputs with the ratio fitted to
    # it alone: they serve to find the cause of a difference.
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
    of_inputs = table.ExperimentFindings(quantities=[], inputs=inputs, facts=[], residuals=[], curves=[])
    return table.join_findings([of_inputs, *parts])


def _is_sliding(cycles: Cycles) -> bool:
    """Return whether the plate of a run slides during part of its mean cycle."""
    return bool(measure_cycle(cycles.mean, cycles.frequency)[2] < 100.0)


def _word_fitted_friction_ratio(fitted: FittedRun) -> str:
    """Return in words the fitted friction ratio and its scatter over the measured cycles, for the list of inputs."""
    source = f"fitted to the motion of the run with {1e3 * fitted.cycles.run.weight:g} g; its scatter over the cycles"
    return table.word_input("frame: friction ratio", fitted.setup.ratio, fitted.spread, "", source)


def _compare_by_load(first: FittedRun, rest: Sequence[tuple[Cycles, Setup]]) -> table.ExperimentFindings:
    """
    Compare frame runs with predictions by friction that is a power of the load, fitted to two of the runs.

    first: the run to which constant friction was fitted. rest: the other runs, with the inputs fitted to each alone.
    """
    # The ratio of a run is interpolated between those of the two fitted runs, linearly in logarithms of ratio and load.
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
    inputs = [_word_fitted_friction_ratio(second)]
    found = [table.ExperimentFindings(quantities=[], inputs=inputs, facts=[fact], residuals=[], curves=[])]
    for cycles, own in rest if len(rest) > 1 else ():
        share = (math.log(cycles.run.weight) - begin) / (end - begin)  # 0 at the first fitted load, 1 at the second

        def between(setup: Setup, low: float, high: float, share: float = share) -> Setup:
            """Return `setup` with the ratio at this load, if it is `low` at the first and `high` at the second one."""
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
    """
    Compare a measured run with what the inputs `setup` give.

    use: "calibrated" or "predicted". varied: inputs changed by their uncertainties, which give u_input. other, own:
    inputs with the factor on the base motion fitted, and with the ratio fitted to this run; they tell the cause of a
    difference. law: friction law, in words, as a suffix of the run's name.
    """
    title = cycles.run.name + law
    found = [measure_cycle(motion, cycles.frequency) for motion in cycles.motions]
    data = table.MeasuredData(
        names=NAMES,
        units=UNITS,
        use=[use] * 5,
        values=np.mean(found, axis=0),
        uncertainty=table.COVERAGE_FACTOR * np.std(found, axis=0, ddof=1),
    )
    motions = {side: compute_frame_motion(side, cycles, setup) for side in table.SIDES}
    answers = {side: read_quantities(cycles, motion) for side, motion in motions.items()}
    by_input, by_ratio = (np.abs(solve_quantities(cycles, each) - data.values) for each in (other, own))

    def explain(k: int, allowed: float) -> str:
        """Return in words which change of the inputs makes the error of quantity `k` at most `allowed`."""
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
        quantities=rows,
        inputs=[],
        facts=[fact],
        residuals=[residual],
        curves=table.make_plot_curves(title, axes, {name: (turn, y) for name, y in lines.items()}),
    )
