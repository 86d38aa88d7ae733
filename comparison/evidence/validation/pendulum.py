"""
Swinging pendulum: its free decay under dry friction from small angles, and its period at large ones.

A pendulum with half period h at small angles is the platform on a sphere of radius g (h / pi)^2. Dry friction takes
the same angle from every half swing, twice the friction coefficient.
"""

from itertools import pairwise

import numpy as np
from scipy.special import ellipk

from comparison.evidence.sides import ENGINE, EQUATIONS, interpolate_platform
from comparison.evidence.validation import table
from comparison.evidence.validation.files import DECAY_FILE, LARGE_SWING_FILE, FreeSwing, make_file_error
from comparison.result_types import Array
from reference.problem import GRAVITY, Scene, Trajectory

ENGINE_V_REG, ENGINE_TOLERANCE = 1e-5, 1e-4  # Exudyn: v_reg, m/s, below which friction is linear; relative error
TURN_ENCODER_STEPS = 3  # A turning point counts if the angle then goes back by more than this many encoder steps.
# Number of first half swings to which the loss of angle per half swing, and the half period, are fitted
FITTED_HALF_SWINGS, PERIOD_HALF_SWINGS = 10, 5
SHOWN_TURNING_POINTS = (5, 10, 11, 12, 13)  # numbers of the turning points that are compared; the first is number 0
HALF_SWING_INSTANTS = 20_001  # number of instants in a computed half swing at which its turning point is looked for
# rad, amplitudes at which half periods are predicted; fitted for the prediction; fitted anew to explain a difference
PREDICTED_ANGLES, FITTED_ANGLE, REFITTED_ANGLE = (1.5, 1.25, 1.0), 0.3, 0.6
# The half period at an angle comes from half swings of amplitudes this close to it, rad; at least so many of them
ANGLE_HALF_WIDTH, MIN_HALF_SWINGS = 0.1, 4


def compare_decay(swing: FreeSwing) -> table.ExperimentFindings:
    """Compare turning points and half period of a pendulum that swings to rest with computed ones."""
    # The turning points are fitted by a line: every half swing loses the same angle, and the rest position is not quite
    # the middle, so that turns on both sides differ by its offset. The measured angles are then freed of the offset.
    step = float(np.min(np.diff(np.unique(swing.angle))))  # rad, step of the encoder that measured the angles
    instants, turns = _find_turns(swing, TURN_ENCODER_STEPS * step)
    numbers = np.arange(SHOWN_TURNING_POINTS[-1] + 1)
    if len(turns) < len(numbers):
        raise make_file_error(DECAY_FILE, f"Theta1 must have {len(numbers)} turning points, not {len(turns)}")
    sides = (-1.0) ** numbers  # 1 on the side of the first turning point, -1 on the other
    # Columns of the fit, by what they multiply: first angle, loss per half swing, offset of the rest position
    terms = np.column_stack([np.ones(len(numbers)), -numbers, sides])
    along, fitted = np.sign(turns[0]) * sides * turns[: len(numbers)], slice(0, FITTED_HALF_SWINGS + 1)
    (start, loss, middle), *_ = np.linalg.lstsq(terms[fitted], along[fitted])
    residuals = along[fitted] - terms[fitted] @ [start, loss, middle]
    inverse = np.linalg.inv(terms[fitted].T @ terms[fitted])
    scatter = table.COVERAGE_FACTOR * float(np.sqrt(residuals @ residuals / (FITTED_HALF_SWINGS - 2) * inverse[1, 1]))
    periods, reading = np.diff(instants)[: 2 * PERIOD_HALF_SWINGS], table.COVERAGE_FACTOR * step / np.sqrt(12.0)
    # Fitted inputs: half period, s; angle lost per half swing, rad; first angle, rad
    nominal = np.array([periods[:PERIOD_HALF_SWINGS].mean(), loss, start])
    uncertain = np.array([_compute_uncertainty_of_mean(periods[:PERIOD_HALF_SWINGS]), scatter, reading])
    sizes = 1e3 * (along - middle * sides)
    data = table.MeasuredData(
        names=[
            *(f"turning point {number}" for number in SHOWN_TURNING_POINTS),
            f"half period of swings {PERIOD_HALF_SWINGS + 1} to {2 * PERIOD_HALF_SWINGS}",
        ],
        units=[*["mrad"] * len(SHOWN_TURNING_POINTS), "ms"],
        use=[
            *("calibrated" if number <= FITTED_HALF_SWINGS else "predicted" for number in SHOWN_TURNING_POINTS),
            "predicted",
        ],
        values=np.array([*sizes[list(SHOWN_TURNING_POINTS)], 1e3 * periods[PERIOD_HALF_SWINGS:].mean()]),
        uncertainty=1e3
        * np.array(
            [*[reading] * len(SHOWN_TURNING_POINTS), _compute_uncertainty_of_mean(periods[PERIOD_HALF_SWINGS:])]
        ),
    )

    def read(motion: Trajectory) -> Array:
        """Return the quantities in `data` as a computed motion has them: turning points, mrad, and half period, ms."""
        passed, angles = _compute_turns(motion)
        return 1e3 * np.array(
            [
                *angles[list(SHOWN_TURNING_POINTS)],
                (passed[2 * PERIOD_HALF_SWINGS] - passed[PERIOD_HALF_SWINGS]) / PERIOD_HALF_SWINGS,
            ]
        )

    def compute(side: str, values: Array) -> Trajectory:
        """Return the motion by one code (side) with the inputs `values`, in the order of `nominal`."""
        half, loss, start = values.tolist()
        return _compute_half_swings(side, half, 0.5 * loss, start, SHOWN_TURNING_POINTS[-1] + 2.5)

    motions = {side: compute(side, nominal) for side in table.SIDES}
    answers = {side: table.read_motion_values(motion, read, len(data.names)) for side, motion in motions.items()}
    varied = [read(compute(EQUATIONS, nominal + change)) for change in np.diag(uncertain)]
    cause = (
        f"{table.LAW_CAUSE}: friction before sliding gives way like a spring, which Coulomb's law lacks (not computed)"
    )
    rows = table.compare_quantities("pendulum, decay", data, answers, varied, lambda k, allowed: cause)
    named = zip(("half period", "loss of a half swing", "first angle"), nominal, uncertain, ("s", "rad", "rad"))
    source = (
        f"fitted to the first {PERIOD_HALF_SWINGS} half periods and {FITTED_HALF_SWINGS} half swings, and its scatter"
    )
    fact = (
        f"pendulum, decay: each of the first {FITTED_HALF_SWINGS} half swings loses {loss:.5f} rad; "
        f"the turning points are within {np.abs(residuals).max() / step:.1f} steps of the encoder "
        f"({step:.6f} rad) of a line"
    )
    drawn = {"measured": sizes} | {side: 1e3 * _compute_turns(motions[side])[1] for side in (EQUATIONS, ENGINE)}
    axes = ("number of the turning point", "angle, mrad")
    curves = table.make_plot_curves("pendulum, decay", axes, {name: (numbers, y) for name, y in drawn.items()})
    given = [
        table.word_input(f"pendulum, decay: {name}", value, size, unit, source) for name, value, size, unit in named
    ]
    return table.ExperimentFindings(quantities=rows, inputs=given, facts=[fact], residuals=[], curves=curves)


def compare_large_swings(swing: FreeSwing) -> table.ExperimentFindings:
    """Compare half periods of a pendulum at large angles with those computed from its half period at a small one."""
    # A half period and the amplitude of its swing are read between passages of the lowest position. Without friction,
    # half period / half period for vanishing angle = K(sin^2(amplitude / 2)) / (pi / 2), with the elliptic integral K.
    passages = _find_passage_times(swing)
    sizes = np.array([np.abs(swing.angle[(swing.time > a) & (swing.time < b)]).max() for a, b in pairwise(passages)])
    periods = np.diff(passages)
    for angle in (*PREDICTED_ANGLES, FITTED_ANGLE, REFITTED_ANGLE):
        if np.sum(np.abs(sizes - angle) < ANGLE_HALF_WIDTH) < MIN_HALF_SWINGS:
            raise make_file_error(
                LARGE_SWING_FILE, f"Y must have {MIN_HALF_SWINGS} half swings within {ANGLE_HALF_WIDTH} of {angle} rad"
            )
    values, spreads = np.transpose(
        [_fit_half_period(sizes, periods, angle) for angle in (*PREDICTED_ANGLES, FITTED_ANGLE, REFITTED_ANGLE)]
    )
    at_rest = [0.5 * np.pi / float(ellipk(np.sin(0.5 * angle) ** 2)) for angle in (FITTED_ANGLE, REFITTED_ANGLE)]
    (half, other), scatter = values[-2:] * at_rest, float(spreads[-2] * at_rest[0])
    names = [f"half period at {angle:g} rad" for angle in PREDICTED_ANGLES]
    data = table.MeasuredData(
        names=names,
        units=["ms"] * 3,
        use=["predicted"] * 3,
        values=1e3 * values[:-2],
        uncertainty=1e3 * spreads[:-2],
    )

    def compute(side: str, half: float, equations: str = "exact") -> table.ComputedValues:
        """Return the half periods at PREDICTED_ANGLES, ms, by one code, if that for vanishing angle is `half`, s."""
        motions = [_compute_half_swings(side, half, 0.0, angle, 3.2, equations) for angle in PREDICTED_ANGLES]
        parts = [table.read_motion_values(each, _read_half_period, 1) for each in motions]
        return table.ComputedValues(*(np.concatenate(each) for each in zip(*parts)))

    answers = {side: compute(side, half) for side in table.SIDES}
    again = compute(EQUATIONS, other).values
    varied = compute(EQUATIONS, half + scatter).values
    small = compute(EQUATIONS, half, "small").values
    gone = f"gone with the half period fitted at {REFITTED_ANGLE} rad"

    def explain(k: int, allowed: float) -> str:
        """Return in words whether the half period fitted at REFITTED_ANGLE makes the error of quantity `k` allowed."""
        if abs(again[k] - data.values[k]) <= allowed:
            return f"{table.INPUT_CAUSE}: {gone}, where friction weighs less"
        return f"{table.NO_CAUSE}: not {gone}"

    rows = table.compare_quantities("pendulum, large angles", data, answers, [varied], explain)
    off = zip(100.0 * (small / data.values - 1.0), PREDICTED_ANGLES)
    fact = "pendulum, large angles: the half period of the small-vibration equations is off by "
    fact += ", ".join(f"{error:.1f} % at {angle:g} rad" for error, angle in off)
    source = f"fitted to the half period at {FITTED_ANGLE} rad, and the scatter of the swings about it"
    given = table.word_input("pendulum, large angles: half period", half, scatter, "s", source)
    drawn = {"measured": (sizes, 1e3 * periods)} | {
        s: (np.array(PREDICTED_ANGLES), answers[s].values) for s in (EQUATIONS, ENGINE)
    }
    axes = ("amplitude, rad", "half period, ms")
    curves = table.make_plot_curves("pendulum, large angles", axes, drawn)
    return table.ExperimentFindings(quantities=rows, inputs=[given], facts=[fact], residuals=[], curves=curves)


def _compute_half_swings(
    side: str, half: float, friction: float, start: float, swings: float, equations: str = "exact"
) -> Trajectory:
    """
    Return the motion of a pendulum let go at the angle `start`, rad, as one code (side) computes it.

    half: half period for vanishing angle, s. friction: friction coefficient. swings: duration in half periods.
    """
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
    return table.compute_released_motion(side, made, (0.0, 0.0), place, ENGINE_V_REG, ENGINE_TOLERANCE, equations)


def _find_turns(swing: FreeSwing, back: float) -> tuple[Array, Array]:
    """
    Return the instants, s, and angles, rad, of the turning points of a measured swing, and of its end.

    A turning point counts if the angle then goes back by more than `back`, rad.
    """
    # `best` is the farthest angle of this half swing, held from the instant `first` to `last`; `way` is its direction.
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


def _compute_uncertainty_of_mean(values: Array) -> float:
    """Return the expanded uncertainty of the mean of values, from their scatter."""
    return table.COVERAGE_FACTOR * float(values.std(ddof=1)) / float(np.sqrt(len(values)))


def _find_passage_times(swing: FreeSwing) -> Array:
    """Return the instants at which the measured pendulum passes its lowest position, s."""
    k = np.flatnonzero((swing.angle[:-1] < 0.0) != (swing.angle[1:] < 0.0))
    before, after = swing.angle[k], swing.angle[k + 1]
    instants: Array = swing.time[k] + (swing.time[k + 1] - swing.time[k]) * before / (before - after)
    return instants


def _fit_half_period(sizes: Array, periods: Array, angle: float) -> tuple[float, float]:
    """
    Return the half period at an amplitude, with its uncertainty, s.

    It is read from a line that is fitted to the half periods of nearby amplitudes over the squares of these.
    """
    near = np.abs(sizes - angle) < ANGLE_HALF_WIDTH
    line = np.polyfit(sizes[near] ** 2 - angle**2, periods[near], 1)
    return float(line[1]), _compute_uncertainty_of_mean(periods[near] - np.polyval(line, sizes[near] ** 2 - angle**2))


def _find_zeros(motion: Trajectory) -> Array:
    """Return the instants at which the platform passes its lowest point in a computed motion, s."""
    zeros: Array = interpolate_platform(motion).roots(extrapolate=False)
    return zeros


def _read_half_period(motion: Trajectory) -> Array:
    """Return the time between the first two passages of the lowest point in a computed motion, ms, (1,)."""
    return 1e3 * np.diff(_find_zeros(motion))[:1]


def _compute_turns(motion: Trajectory) -> tuple[Array, Array]:
    """
    Return the instants, s, and the sizes of the angles, rad, of a computed motion's turning points and of its end.

    There are as many as SHOWN_TURNING_POINTS need; those after the end of the motion are NaN.
    """
    # Between two passages of the lowest point lies one turning point, to alternate sides.
    place, end = interpolate_platform(motion), float(motion.time[-1])
    found: list[tuple[float, float]] = []
    for begin, stop in pairwise([0.0, *_find_zeros(motion), end]):
        dense = np.linspace(begin, stop, HALF_SWING_INSTANTS)
        along = place(dense) * (-1.0) ** len(found)
        found.append((dense[np.argmax(along)], along.max()))
    found.append((end, float(place(end)) * (-1.0) ** len(found)))
    instants, places = np.array([*found, *[(np.nan, np.nan)] * SHOWN_TURNING_POINTS[-1]])[
        : SHOWN_TURNING_POINTS[-1] + 1
    ].T
    return instants, np.arcsin(places / motion.scene.radius)
