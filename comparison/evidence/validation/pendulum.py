"""
The swinging pendulum: free decay under dry friction from small angles, and its period at large ones.

A pendulum with half period h at small angles is the platform on a sphere of radius g (h / pi)^2. Dry friction takes
the same angle from every half swing, twice the friction coefficient.
"""

from itertools import pairwise

import numpy as np
from scipy.special import ellipk

from comparison.evidence.sides import ENGINE, EQUATIONS, spline_along
from comparison.evidence.validation import table
from comparison.evidence.validation.files import DECAY, LARGE, Swing, wrong_file
from comparison.result_types import Array
from reference.problem import GRAVITY, Scene, Trajectory

REGULARIZATION, TOLERANCE = 1e-5, 1e-4  # settings of the engine; v_reg in m/s
STEPS = 3  # steps of the encoder: going back by more is a turn
COULOMB, HALF = 10, 5  # half swings that lose the same angle; of these, how many have their period fitted
SHOWN = (5, 10, 11, 12, 13)  # turning points in the table, the first one being number 0
PARTS = 20_001  # instants of a half swing
ANGLES, FITTED, REFITTED = (1.5, 1.25, 1.0), 0.3, 0.6  # rad, amplitudes of half periods predicted, fitted, tried
WINDOW, FEWEST = 0.1, 4  # rad, of amplitudes about each of them; half swings in it


def compare_decay(swing: Swing) -> table.Found:
    """Turning points and half periods of the swing to rest."""
    step = float(np.min(np.diff(np.unique(swing.angle))))
    instants, turns = _find_turns(swing, STEPS * step)
    numbers = np.arange(SHOWN[-1] + 1)
    if len(turns) < len(numbers):
        raise wrong_file(DECAY, f"Theta1 must have {len(numbers)} turning points, not {len(turns)}")
    sides = (-1.0) ** numbers
    terms = np.column_stack([np.ones(len(numbers)), -numbers, sides])  # first angle, loss, middle of the swings
    along, fitted = np.sign(turns[0]) * sides * turns[: len(numbers)], slice(0, COULOMB + 1)
    (start, loss, middle), *_ = np.linalg.lstsq(terms[fitted], along[fitted])
    residuals = along[fitted] - terms[fitted] @ [start, loss, middle]
    inverse = np.linalg.inv(terms[fitted].T @ terms[fitted])
    scatter = table.COVERAGE * float(np.sqrt(residuals @ residuals / (COULOMB - 2) * inverse[1, 1]))
    periods, reading = np.diff(instants)[: 2 * HALF], table.COVERAGE * step / np.sqrt(12.0)
    nominal = np.array([periods[:HALF].mean(), loss, start])
    uncertain = np.array([_uncertainty_of_mean(periods[:HALF]), scatter, reading])
    sizes = 1e3 * (along - middle * sides)
    data = table.Data(
        [*(f"turning point {number}" for number in SHOWN), f"half period of swings {HALF + 1} to {2 * HALF}"],
        [*["mrad"] * len(SHOWN), "ms"],
        [*("calibrated" if number <= COULOMB else "predicted" for number in SHOWN), "predicted"],
        np.array([*sizes[list(SHOWN)], 1e3 * periods[HALF:].mean()]),
        1e3 * np.array([*[reading] * len(SHOWN), _uncertainty_of_mean(periods[HALF:])]),
    )

    def read(motion: Trajectory) -> Array:
        passed, angles = _compute_turns(motion)
        return 1e3 * np.array([*angles[list(SHOWN)], (passed[2 * HALF] - passed[HALF]) / HALF])

    def compute(side: str, values: Array) -> Trajectory:
        half, loss, start = values.tolist()
        return _move_half_swings(side, half, 0.5 * loss, start, SHOWN[-1] + 2.5)

    motions = {side: compute(side, nominal) for side in table.SIDES}
    answers = {side: table.values_of_motion(motion, read, len(data.names)) for side, motion in motions.items()}
    varied = [read(compute(EQUATIONS, nominal + change)) for change in np.diag(uncertain)]
    cause = f"{table.LAW}: friction before sliding gives way like a spring, which Coulomb's law lacks (not computed)"
    rows = table.measured_quantities("pendulum, decay", data, answers, varied, lambda k, allowed: cause)
    named = zip(("half period", "loss of a half swing", "first angle"), nominal, uncertain, ("s", "rad", "rad"))
    source = f"fitted to the first {HALF} half periods and {COULOMB} half swings, and its scatter"
    fact = (
        f"pendulum, decay: each of the first {COULOMB} half swings loses {loss:.5f} rad; the turning points are within "
        f"{np.abs(residuals).max() / step:.1f} steps of the encoder ({step:.6f} rad) of a line"
    )
    drawn = {"measured": sizes} | {side: 1e3 * _compute_turns(motions[side])[1] for side in (EQUATIONS, ENGINE)}
    axes = ("number of the turning point", "angle, mrad")
    curves = table.plot_curves("pendulum, decay", axes, {name: (numbers, y) for name, y in drawn.items()})
    given = [
        table.word_input(f"pendulum, decay: {name}", value, size, unit, source) for name, value, size, unit in named
    ]
    return table.Found(rows, given, [fact], [], curves)


def compare_large(swing: Swing) -> table.Found:
    """Half periods at large angles."""
    passages = _passage_times(swing)
    sizes = np.array([np.abs(swing.angle[(swing.time > a) & (swing.time < b)]).max() for a, b in pairwise(passages)])
    periods = np.diff(passages)
    for angle in (*ANGLES, FITTED, REFITTED):
        if np.sum(np.abs(sizes - angle) < WINDOW) < FEWEST:
            raise wrong_file(LARGE, f"Y must have {FEWEST} half swings within {WINDOW} of {angle} rad")
    values, spreads = np.transpose([_half_period_near(sizes, periods, angle) for angle in (*ANGLES, FITTED, REFITTED)])
    at_rest = [0.5 * np.pi / float(ellipk(np.sin(0.5 * angle) ** 2)) for angle in (FITTED, REFITTED)]
    (half, other), scatter = values[-2:] * at_rest, float(spreads[-2] * at_rest[0])
    names = [f"half period at {angle:g} rad" for angle in ANGLES]
    data = table.Data(names, ["ms"] * 3, ["predicted"] * 3, 1e3 * values[:-2], 1e3 * spreads[:-2])

    def compute(side: str, half: float, equations: str = "exact") -> table.ComputedValues:
        motions = [_move_half_swings(side, half, 0.0, angle, 3.2, equations) for angle in ANGLES]
        parts = [table.values_of_motion(each, _read_half_period, 1) for each in motions]
        return table.ComputedValues(*(np.concatenate(each) for each in zip(*parts)))

    answers = {side: compute(side, half) for side in table.SIDES}
    again, varied, small = (compute(EQUATIONS, *each).values for each in ((other,), (half + scatter,), (half, "small")))

    def explain(k: int, allowed: float) -> str:
        if abs(again[k] - data.values[k]) <= allowed:
            return f"{table.INPUT}: gone with the half period fitted at {REFITTED} rad, where friction weighs less"
        return f"{table.OPEN}: not gone with the half period fitted at {REFITTED} rad"

    rows = table.measured_quantities("pendulum, large angles", data, answers, [varied], explain)
    off = zip(100.0 * (small / data.values - 1.0), ANGLES)
    fact = "pendulum, large angles: the half period of the small-vibration equations is off by "
    fact += ", ".join(f"{error:.1f} % at {angle:g} rad" for error, angle in off)
    source = f"fitted to the half period at {FITTED} rad, and the scatter of the swings about it"
    given = table.word_input("pendulum, large angles: half period", half, scatter, "s", source)
    drawn = {"measured": (sizes, 1e3 * periods)} | {
        s: (np.array(ANGLES), answers[s].values) for s in (EQUATIONS, ENGINE)
    }
    axes = ("amplitude, rad", "half period, ms")
    return table.Found(rows, [given], [fact], [], table.plot_curves("pendulum, large angles", axes, drawn))


def _move_half_swings(
    side: str, half: float, friction: float, start: float, swings: float, equations: str = "exact"
) -> Trajectory:
    """So many half swings from rest at an angle."""
    scene = {
        "title": "Swinging pendulum",
        "name": "pendulum",
        "duration": swings * half,
        "isolator": {"radius": GRAVITY * (half / np.pi) ** 2, "friction": friction},
        "bodies": [{"mass": 1.0}],
        "excitation": {"amplitudes": [[0.0, 0.0], [0.0, 0.0]], "periods": [1.0, 1.0], "decay": [0.0, 0.0]},
    }
    made = Scene.model_validate(scene)
    place = np.array([made.radius * np.sin(start)])
    return table.motion_of(side, made, (0.0, 0.0), place, REGULARIZATION, TOLERANCE, equations)


def _find_turns(swing: Swing, back: float) -> tuple[Array, Array]:
    """Instants, in the middle of the encoder's step, and angles of turns by more than `back`; at last the rest."""
    turns: list[tuple[float, float]] = []
    best, way, first, last = swing.angle[0], 0.0, swing.time[0], swing.time[0]
    for time, angle in zip(swing.time, swing.angle):
        if way == 0.0 and abs(angle - best) > back:
            way = np.sign(angle - best)
        if way * (angle - best) > 0.0:
            best, first, last = angle, time, time
        elif angle == best:
            last = time
        elif way * (best - angle) > back:
            turns.append((0.5 * (first + last), best))
            way, best, first, last = -way, angle, time, time
    turns.append((last, swing.angle[-1]))
    instants, angles = np.array(turns).T
    return instants, angles


def _uncertainty_of_mean(values: Array) -> float:
    """Uncertainty of a mean, from the scatter."""
    return table.COVERAGE * float(values.std(ddof=1)) / float(np.sqrt(len(values)))


def _passage_times(swing: Swing) -> Array:
    """Instants at which the pendulum passes its lowest position, s."""
    k = np.flatnonzero((swing.angle[:-1] < 0.0) != (swing.angle[1:] < 0.0))
    before, after = swing.angle[k], swing.angle[k + 1]
    instants: Array = swing.time[k] + (swing.time[k + 1] - swing.time[k]) * before / (before - after)
    return instants


def _half_period_near(sizes: Array, periods: Array, angle: float) -> tuple[float, float]:
    """The half period at an amplitude and its uncertainty: of a line in the squares of those about it."""
    near = np.abs(sizes - angle) < WINDOW
    line = np.polyfit(sizes[near] ** 2 - angle**2, periods[near], 1)
    return float(line[1]), _uncertainty_of_mean(periods[near] - np.polyval(line, sizes[near] ** 2 - angle**2))


def _find_zeros(motion: Trajectory) -> Array:
    zeros: Array = spline_along(motion).roots(extrapolate=False)
    return zeros


def _read_half_period(motion: Trajectory) -> Array:
    """The time between the first two passages, ms."""
    return 1e3 * np.diff(_find_zeros(motion))[:1]


def _compute_turns(motion: Trajectory) -> tuple[Array, Array]:
    """Instants and angles, towards the side of each turn, of the turning points from the first on; at last the rest."""
    place, end = spline_along(motion), float(motion.time[-1])
    found: list[tuple[float, float]] = []
    for begin, stop in pairwise([0.0, *_find_zeros(motion), end]):
        dense = np.linspace(begin, stop, PARTS)
        along = place(dense) * (-1.0) ** len(found)
        found.append((dense[np.argmax(along)], along.max()))
    found.append((end, float(place(end)) * (-1.0) ** len(found)))
    instants, places = np.array([*found, *[(np.nan, np.nan)] * SHOWN[-1]])[: SHOWN[-1] + 1].T
    return instants, np.arcsin(places / motion.scene.radius)
