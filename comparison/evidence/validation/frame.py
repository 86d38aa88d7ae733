"""
The shaken frame: the runs are predicted by friction that is fitted to others.

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

from comparison.evidence.sides import ENGINE, EQUATIONS, spline_along
from comparison.evidence.validation import table
from comparison.evidence.validation.cycles import SAMPLES, Cycles, fold_run, read_cycle
from comparison.evidence.validation.files import Shaken
from comparison.result_types import Array
from comparison.study.study import STUDY_TOLERANCE
from reference.problem import GRAVITY, Scene, Trajectory

HEAVY, LOOSE = 10.0, 1e4  # mass of the second body over that of the platform; period of its link, s
FAST = 1.0  # by how much friction would grow at infinite speed: the slope at zero is what counts
CYCLES = 12  # computed, of which the last is read
REGULARIZATION = 1e-4  # m/s, of the engine
FIRST = 0.250  # kg, weight of the disc in the run that the ratio is fitted to, if the folder has it
SECOND = 0.450  # kg, in the second run that friction of the load is fitted to, if the folder has it
STEP = 0.005  # step of ratio and scale in difference quotients
NAMES = ("half range", "rms about the mean", "share of time at rest", "phase of the starts", "phase of the stops")
UNITS = ("mm", "mm", table.CYCLE, table.DEGREES, table.DEGREES)


class Setup(NamedTuple):
    """Inputs of the computation: of the frame, of the base motion, of the disc."""

    mass: float = 3.0799  # kg
    stiffness: float = 1191.0  # N/m
    damping: float = 0.6690  # N s/m
    scale: float = 1.0  # factor of the base motion
    second: float = 0.0  # share of the measured second harmonic
    disc: float = 1.0  # its weight over the stated one
    ratio: float = 0.3  # friction


ASSUMED = {  # uncertainty of each input, its name, unit and source
    "mass": (0.01 * Setup().mass, "mass", "kg", "authors; 1 % assumed"),
    "stiffness": (0.01 * Setup().stiffness, "stiffness", "N/m", "authors; 1 % assumed"),
    "damping": (0.2 * Setup().damping, "viscous damping", "N s/m", "authors; 20 % assumed"),
    "scale": (0.01, "base motion over plate motion, scales of the sensors", "", "1 % assumed"),
    "second": (1.0, "share of the second harmonic of the base", "", "0 or the measured one, 1 % of the first: assumed"),
    "disc": (0.01, "weight of the disc over the stated one", "", "authors; 1 % assumed"),
}
# Inputs whose change by their uncertainty asks for another fit of the ratio
REFITTED = ("mass", "stiffness", "damping", "scale", "second")


def scene_of(cycles: Cycles, setup: Setup) -> tuple[Scene, tuple[float, float]]:
    """The frame as a scene with its phases."""
    weight = (1.0 + HEAVY) * setup.mass * GRAVITY
    base = setup.scale * np.array([cycles.amplitude, setup.second * cycles.second]) * 1e-3
    turns = 2j * np.pi * cycles.frequency * np.array([1.0, 2.0])
    ground = -(setup.stiffness + setup.damping * turns) * base / setup.mass
    mu = setup.ratio * setup.disc * cycles.run.weight * GRAVITY / weight
    scene = {
        "title": f"Shaken frame, {1e3 * cycles.run.weight:g} g",
        "name": "shaken-frame",
        "duration": CYCLES / cycles.frequency,
        "isolator": {
            "radius": weight / setup.stiffness,
            "friction": {"slow": mu, "fast": mu + FAST, "rate": setup.damping / (weight * FAST)},
        },
        "bodies": [{"mass": setup.mass}, {"mass": HEAVY * setup.mass, "period": [LOOSE, LOOSE]}],
        "excitation": {
            "amplitudes": [np.abs(ground).tolist(), [0.0, 0.0]],
            "periods": [1.0 / cycles.frequency, 0.5 / cycles.frequency],
            "decay": [0.0, 0.0],
        },
    }
    phases = np.angle(ground)
    return Scene.model_validate(scene), (float(phases[0]), float(phases[1]))


def last_cycle(motion: Trajectory, frequency: float) -> Array:
    """The last computed cycle, (SAMPLES,), mm about its mean."""
    grid = (CYCLES - 1 + np.arange(SAMPLES) / SAMPLES) / frequency
    place = 1e3 * spline_along(motion)(grid)
    about: Array = place - place.mean()
    return about


def compute_motion(side: str, cycles: Cycles, setup: Setup) -> Trajectory:
    """The motion of a run by one side, from the base's largest position on."""
    scene, phases = scene_of(cycles, setup)
    place = np.array([1e-3 * cycles.amplitude, 0.0])
    return table.motion_of(side, scene, phases, place, REGULARIZATION, STUDY_TOLERANCE, "small")


def read_quantities(cycles: Cycles, motion: Trajectory) -> table.ComputedValues:
    """The quantities of a computed motion of a run."""
    rate = cycles.frequency
    return table.values_of_motion(motion, lambda each: read_cycle(last_cycle(each, rate), rate), len(NAMES))


def solve_quantities(cycles: Cycles, setup: Setup) -> Array:
    """The quantities of a run by the equations."""
    return read_quantities(cycles, compute_motion(EQUATIONS, cycles, setup)).values


def fit_inputs(cycles: Cycles, setup: Setup, *names: str) -> tuple[Setup, Array]:
    """The inputs for which the equations come closest to the mean cycle, and their scatter (J, names)."""

    def curve(at: Setup) -> Array:
        return last_cycle(compute_motion(EQUATIONS, cycles, at), cycles.frequency)

    for _ in range(12):
        nearby = [setup._replace(**{name: getattr(setup, name) + STEP}) for name in names]
        begin = curve(setup)
        slopes = np.column_stack([(curve(each) - begin) / STEP for each in nearby])
        change = np.linalg.lstsq(slopes, cycles.mean - begin, rcond=None)[0]
        setup = setup._replace(**{n: max(1e-3, getattr(setup, n) + part) for n, part in zip(names, change)})
        if np.abs(change).max() < 1e-5:
            break
    each = cycles.motions - cycles.motions.mean(axis=1, keepdims=True) - cycles.mean
    scatter: Array = np.linalg.lstsq(slopes, each.T, rcond=None)[0].T
    return setup, scatter


class FittedRun(NamedTuple):
    """
    A run with the friction ratio of its motion.

    spread: of the ratio, by the scatter over the cycles. changed: fitted again with each input of REFITTED changed by
    its uncertainty. shifted: fitted with the base motion that the run of the constant ratio fits best.
    """

    cycles: Cycles
    setup: Setup
    spread: float
    changed: list[Setup]
    shifted: Setup

    def variations(self) -> list[Setup]:
        """Setups with each input changed by its uncertainty."""
        heavier = self.setup._replace(disc=self.setup.disc + ASSUMED["disc"][0])
        return [self.setup._replace(ratio=self.setup.ratio + self.spread), heavier, *self.changed]


def fit_run(cycles: Cycles, start: Setup, shift: Setup | None = None) -> FittedRun:
    """Fit the friction ratio of a run; shift: base motion of `shifted`, None to fit that of this run."""
    setup, scatter = fit_inputs(cycles, start, "ratio")
    spread = table.COVERAGE * float(scatter[:, 0].std(ddof=1))
    changes = ({name: getattr(setup, name) + ASSUMED[name][0]} for name in REFITTED)
    changed = [fit_inputs(cycles, setup._replace(**change), "ratio")[0] for change in changes]
    if shift is None:
        shifted, _ = fit_inputs(cycles, setup, "ratio", "scale")
    else:
        shifted, _ = fit_inputs(cycles, setup._replace(scale=shift.scale), "ratio")
    return FittedRun(cycles, setup, spread, changed, shifted)


def compare_frame(runs: Sequence[Shaken]) -> table.Found:
    """Compare all runs of a folder: by one ratio, and by friction of the load where there are runs to predict."""
    folded = [fold_run(run) for run in runs]
    first = min(folded, key=lambda cycles: (abs(cycles.run.weight - FIRST) > 1e-9, cycles.run.weight))
    fitted = fit_run(first, Setup())
    setup, varied = fitted.setup, fitted.variations()
    own = [setup if each is first else fit_inputs(each, setup, "ratio")[0] for each in folded]
    inputs = [
        table.word_input(f"frame: {name}", getattr(setup, key), size, unit, source)
        for key, (size, name, unit, source) in ASSUMED.items()
    ]
    inputs.append(_ratio_of_setup(fitted))
    parts = [
        _compare_run(each, "calibrated" if each is first else "predicted", setup, varied, fitted.shifted, best)
        for each, best in zip(folded, own)
    ]
    rest = [(each, best) for each, best in zip(folded, own) if each is not first]
    if any(_is_sliding(each) for each, _ in rest):
        parts.append(_compare_by_load(fitted, rest))
    return table.join_findings([table.Found([], inputs, [], [], []), *parts])


def _is_sliding(cycles: Cycles) -> bool:
    return bool(read_cycle(cycles.mean, cycles.frequency)[2] < 100.0)


def _ratio_of_setup(fitted: FittedRun) -> str:
    source = f"fitted to the motion of the run with {1e3 * fitted.cycles.run.weight:g} g; its scatter over the cycles"
    return table.word_input("frame: friction ratio", fitted.setup.ratio, fitted.spread, "", source)


def _compare_by_load(first: FittedRun, rest: Sequence[tuple[Cycles, Setup]]) -> table.Found:
    """Friction that is a power of the load, fitted to two runs; the others are predicted."""
    sliding = [cycles for cycles, _ in rest if _is_sliding(cycles)]
    chosen = min(sliding, key=lambda cycles: abs(cycles.run.weight - SECOND))
    second = fit_run(chosen, first.setup, first.shifted)
    one, two = first.setup.ratio, second.setup.ratio
    begin, end = (math.log(each.cycles.run.weight) for each in (first, second))
    exponent = math.log(two / one) / (end - begin)
    fact = (
        f"frame: the friction ratios fitted to {first.cycles.run.name} and to {second.cycles.run.name} "
        f"grow as the load to the power {exponent:.3f}"
    )
    found = [table.Found([], [_ratio_of_setup(second)], [fact], [], [])]
    for cycles, own in rest if len(rest) > 1 else ():
        share = (math.log(cycles.run.weight) - begin) / (end - begin)

        def between(setup: Setup, low: float, high: float, share: float = share) -> Setup:
            return setup._replace(ratio=low * (high / low) ** share)

        pairs = zip([*first.changed, first.shifted], [*second.changed, second.shifted])
        *changed, shifted = (between(low, low.ratio, high.ratio) for low, high in pairs)
        setup = between(first.setup, one, two)
        scattered = [between(setup, one + first.spread, two), between(setup, one, two + second.spread)]
        heavier = setup._replace(disc=setup.disc + ASSUMED["disc"][0])
        use = "calibrated" if cycles is chosen else "predicted"
        found.append(_compare_run(cycles, use, setup, [*scattered, heavier, *changed], shifted, own, table.LOADED))
    return table.join_findings(found)


def _compare_run(
    cycles: Cycles, use: str, setup: Setup, varied: Sequence[Setup], other: Setup, own: Setup, law: str = ""
) -> table.Found:
    """One run; other: ratio and base motion fitted to the first run, own: ratio to this one; each may explain E."""
    title = cycles.run.name + law
    found = [read_cycle(motion, cycles.frequency) for motion in cycles.motions]
    data = table.Data(NAMES, UNITS, [use] * 5, np.mean(found, axis=0), table.COVERAGE * np.std(found, axis=0, ddof=1))
    motions = {side: compute_motion(side, cycles, setup) for side in table.SIDES}
    answers = {side: read_quantities(cycles, motion) for side, motion in motions.items()}
    by_input, by_ratio = (np.abs(solve_quantities(cycles, each) - data.values) for each in (other, own))

    def explain(k: int, allowed: float) -> str:
        shift = f"a base motion of {100.0 * (other.scale - 1.0):+.1f} % and ratio {other.ratio:.3f}"
        if by_input[k] <= allowed:
            return f"{table.INPUT}: gone with {shift}"
        if by_ratio[k] <= allowed:
            return f"{table.LAW}: gone with the ratio of this run, {own.ratio:.3f}, so the ratio depends on the load"
        return f"{table.OPEN}: gone neither with the ratio of this run, {own.ratio:.3f}, nor with {shift}"

    rows = table.measured_quantities(title, data, answers, [solve_quantities(cycles, each) for each in varied], explain)
    best = last_cycle(compute_motion(EQUATIONS, cycles, own), cycles.frequency)
    lines = {"measured": cycles.mean} | {
        side: last_cycle(motions[side], cycles.frequency) for side in (EQUATIONS, ENGINE)
    }
    off = float(np.std(lines[EQUATIONS] - cycles.mean))
    middle = 0.5 * (cycles.mean.max() + cycles.mean.min())
    fact = (
        f"{title}: the friction ratio of this run alone is {own.ratio:.3f}; the motion over a cycle is then "
        f"off by {np.std(best - cycles.mean):.3f} mm rms, and by {off:.3f} mm with {setup.ratio:.3f}; the plate is "
        f"above its middle for {100.0 * np.mean(cycles.mean > middle):.0f} % of a cycle"
    )
    residual = table.CycleResidual(title, use, off / float(data.values[0]))
    axes, turn = ("phase of the base, deg", "top plate, mm"), np.arange(SAMPLES) * 360.0 / SAMPLES
    return table.Found(
        rows, [], [fact], [residual], table.plot_curves(title, axes, {name: (turn, y) for name, y in lines.items()})
    )
