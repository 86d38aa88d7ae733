"""
Measure what friction that yields elastically changes, and write a table of docs/yielding_friction.json.

    python docs/yielding_friction.py measured FOLDER       frame and pendulum
    python docs/yielding_friction.py mastodon MASTODON.csv
    python docs/yielding_friction.py opensees              needs openseespy
    python docs/yielding_friction.py terms
    python docs/yielding_friction.py displacements         and draws yielding.png

Each command replaces its table alone. FOLDER holds the measured files of `phase-resonance validation`. The yield
displacement and the friction ratio of the frame are fitted to one run and used on the others; those of the pendulum are
fitted to its first turning points. A quantity counts as met by the u_val that the package records for it without a
yield displacement. MASTODON.csv is the input of its bearing's test, as for `phase-resonance benchmarks --mastodon`.
"""

from __future__ import annotations

import importlib.metadata
import json
import math
import sys
import time
from collections.abc import Callable
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import least_squares

import reference
from comparison.analyses.conditioning.analysis import QUESTIONS, YIELDS, conditioning_curves
from comparison.evidence.benchmarks import cases
from comparison.evidence.sides import EQUATIONS, interpolate_platform
from comparison.evidence.validation import frame, pendulum, table
from comparison.evidence.validation.files import FreeSwing, read_folder
from multibody.models.surface_heat import SurfaceHeat
from reference.problem import GRAVITY, Scene, Trajectory, ground_acceleration, ground_peak, load_scene
from reference.problem.friction import Heat
from reference.problem.readings import DEFAULT_V_C
from reference.problem.symmetry import distinct_pairs

STORED = Path(__file__).with_name("yielding_friction.json")
PLACE, V_REG, TOLERANCE = 1e-3, 1e-4, 1e-3
ROOT = Path(__file__).parents[1]
FRICTION = 0.1  # coefficient of the paper's cases
OPENSEES_YIELDS, OPENSEES_STEPS = (1e-3, 1e-4), (4e-3, 1e-3, 5e-4, 2.5e-4)  # m; s
STIFF_YIELD, STIFF_STEPS = 1e-5, (2e-3, 5e-4, 1.25e-4)  # m; s, of a spring as stiff as the example's knee
STIFF = "opensees, fig3-II, u_y = 0.01 mm, 4 phase pairs, against 0.000125 s"
INTEGRATORS = ((("Newmark", 0.5, 0.25), "Newmark"), (("HHT", 0.67), "HHT 0.67"))
FINE = 40  # steps in the platform's period on the spring, from which on mu_1 is trusted
HEAT_STEPS = 20  # steps of MASTODON's motion between two of its temperature
TURNS = 0.5 * np.pi * np.arange(4)
PHASES = np.array([(first + 0.3, second + 0.5) for first in TURNS for second in TURNS])
TERMS = ["the platform does not rise", "the slope counts twice", "friction and springs lie in the horizontal plane"]
# what is followed term by term: scene, scale of loading, friction and yield displacement, phase pairs
TERM_SCENES = (("fig3-I", 1.0, 2), ("fig3-II", 1.0, 2), ("fig3-I", 0.5, 1), ("fig3-I", 0.25, 1))
GRID, PICTURE = 16, Path(__file__).with_name("yielding.png")
TRIED = (0.0, 5e-3, 0.01, 0.02, 0.03, 0.05, 0.08, 0.12)  # mm, yield displacements from which each fit begins


def move_frame(cycles: frame.Cycles, ratio: float, yields: float) -> Trajectory:
    """Return the motion of a run with a friction ratio and a yield displacement, mm; 0: rigid friction."""
    scene, phases = frame.make_frame_scene(cycles, frame.Setup(ratio=ratio))
    if yields > 0.0:
        stated = scene.model_dump(exclude_none=True)["isolator"]["friction"]
        stiffness = ratio * cycles.run.weight * GRAVITY / (PLACE * yields)
        scene = scene.with_values({"isolator.friction": stated | {"initial_stiffness": stiffness}})
    start = np.array([PLACE * cycles.amplitude, 0.0])
    return table.compute_released_motion(EQUATIONS, scene, phases, start, V_REG, TOLERANCE, "small")


def fit_ratio(cycles: frame.Cycles, yields: float) -> tuple[float, float]:
    """Fit the friction ratio of a run at a yield displacement, mm; return it and the rms misfit of the cycle, mm."""

    def misfit(ratio: Any) -> Any:
        return frame.read_last_cycle(move_frame(cycles, float(ratio[0]), yields), cycles.frequency) - cycles.mean

    found = least_squares(misfit, [0.3], diff_step=1e-3, xtol=1e-5, ftol=1e-7)
    return float(found.x[0]), float(np.sqrt(np.mean(found.fun**2)))


def compare_frame(runs: list[frame.Cycles], recorded: dict[str, dict[str, Any]]) -> dict[str, Any]:
    """Fit to the first run, and by friction of the load to two, and judge the quantities of all runs."""
    fits = {f"{1e3 * run.run.weight:.0f} g": [(u, *fit_ratio(run, u)) for u in TRIED] for run in runs}
    by_weight = {round(1e3 * run.run.weight): run for run in runs}
    first, second = fits["250 g"], fits["450 g"]
    best = min(range(len(TRIED)), key=lambda k: first[k][2])
    found: dict[str, Any] = {"fits": fits, "fitted at 250 g, mm": TRIED[best], "laws": {}}
    for law in ("one ratio", "friction of the load"):
        for yields, k in ((0.0, 0), (TRIED[best], best)):
            exponent = math.log(second[k][1] / first[k][1]) / math.log(450.0 / 250.0) if "load" in law else 0.0
            rows = []
            for weight, run in by_weight.items():
                ratio = first[k][1] * (weight / 250.0) ** exponent
                motion = move_frame(run, ratio, yields)
                curve = frame.read_last_cycle(motion, run.frequency)
                values = frame.measure_cycle(curve, run.frequency)
                name = f"frame, {weight} g" + (table.LOAD_FRICTION_SUFFIX if "load" in law and weight != 250 else "")
                for number, quantity in enumerate(frame.NAMES):
                    within = recorded[f"{name}: {quantity}"]
                    error = values[number] - within["measured"]
                    rows.append([name, quantity, float(error), within["u_val"], bool(abs(error) <= within["u_val"])])
                rms = float(np.sqrt(np.mean((curve - run.mean) ** 2)))
                rows.append([name, "rms of the cycle, mm", rms, None, None])
            found["laws"][f"{law}, u_y = {yields:g} mm"] = rows
    return found


def compare_pendulum(swing: FreeSwing, recorded: dict[str, dict[str, Any]]) -> dict[str, Any]:
    """Fit loss and yield displacement to turning points 0 to 10, and judge those behind."""
    instants, turns = pendulum._find_turns(
        swing, pendulum.TURN_ENCODER_STEPS * float(np.min(np.diff(np.unique(swing.angle))))
    )
    numbers = np.arange(pendulum.SHOWN_TURNING_POINTS[-1] + 1)
    sides = (-1.0) ** numbers
    terms = np.column_stack([np.ones(len(numbers)), -numbers, sides])
    along = np.sign(turns[0]) * sides * turns[: len(numbers)]
    (_, loss, middle), *_ = np.linalg.lstsq(terms[:11], along[:11])
    half = float(np.diff(instants)[: pendulum.PERIOD_HALF_SWINGS].mean())
    measured = along - middle * sides

    def turning_points(yields: float, lost: float, period: float) -> Any:
        radius = GRAVITY * (period / np.pi) ** 2
        friction: Any = 0.5 * lost
        if yields > 0.0:
            friction = {"slow": 0.5 * lost, "yield_displacement": yields * radius}
        scene = {
            "title": "Swinging pendulum",
            "name": "pendulum",
            "duration": 14.2 * period,
            "isolator": {"radius": radius, "friction": friction},
            "bodies": [{"mass": 1.0}],
            "excitation": {"amplitudes": [[0.0, 0.0], [0.0, 0.0]], "periods": [1.0, 1.0], "decay": [0.0, 0.0]},
        }
        made = Scene.model_validate(scene)
        place = np.array([made.radius * np.sin(measured[0])])
        motion = table.compute_released_motion(EQUATIONS, made, (0.0, 0.0), place, 1e-5, 1e-4, "exact")
        track = interpolate_platform(motion)
        ends = [0.0, *pendulum._find_zeros(motion), float(motion.time[-1])]
        sizes = [(track(np.linspace(a, b, 2001)) * (-1.0) ** k).max() for k, (a, b) in enumerate(pairwise(ends))]
        rest = [float(track(ends[-1])) * (-1.0) ** k for k in range(len(sizes), len(numbers))]
        return np.arcsin(np.array([*sizes, *rest][: len(numbers)]) / made.radius)

    tried = []
    for yields in (0.0, 2e-4, 5e-4, 1e-3, 1.5e-3, 2e-3, 3e-3, 4e-3, 6e-3, 8e-3):
        misfit = partial(_misfit, partial(turning_points, yields), half, measured)
        fit = least_squares(misfit, [loss], diff_step=1e-3, x_scale=loss)
        tried.append((yields, float(fit.x[0]), float(np.sqrt(np.mean(fit.fun**2)))))
    best = min(tried, key=lambda each: each[2])
    rows = []
    for yields, lost, _ in (tried[0], best):
        sizes = turning_points(yields, lost, half)
        for number in pendulum.SHOWN_TURNING_POINTS:
            within = recorded[f"pendulum, decay: turning point {number}"]
            error = 1e3 * float(sizes[number]) - within["measured"]
            rows.append(
                [yields, f"turning point {number}", error, within["u_val"], bool(abs(error) <= within["u_val"])]
            )
    return {"fits": tried, "fitted, rad": best[0], "rows": rows}


def _misfit(compute: Any, half: float, measured: Any, loss: Any) -> Any:
    return compute(float(loss[0]), half)[:11] - measured[:11]


def compute_mastodon(path: Path, yields: float, step: float) -> list[float]:
    """
    Compute the ranges of MASTODON's bearing, mm, with a yield displacement, m, in steps of its own.

    The equations refuse heat with friction that yields. The restoring force is theirs, N y / sqrt(R^2 - y^2) along each
    axis. Velocity Verlet with the closest point on the circle.
    """
    case = cases.load_mastodon_case(path)
    scene = case.scene
    law, weight = scene.dry_friction, scene.total_mass * GRAVITY
    assert law.heat is not None
    track = SurfaceHeat(law.heat, 1, scene.duration, 1.0, 1.0)
    track.begin(0.0)
    count = round(scene.duration / step)
    ground = ground_acceleration(scene, (0.0, 0.0), step * np.arange(count + 1))
    stiffness = law.largest * weight / yields
    place, speed, spring, force = np.zeros(2), np.zeros(2), np.zeros(2), np.zeros(2)
    acceleration, factor, extremes = -ground[0, :2], 1.0, []
    for row in range(1, count + 1):
        speed = speed + 0.5 * step * acceleration
        place, spring = place + step * speed, spring + step * speed
        load = 1.0 + float(ground[row, 2]) / GRAVITY
        limit = factor * law.coefficient_at(math.hypot(*speed), load) * load * weight / stiffness
        size, turned = math.hypot(*spring), np.zeros(2)
        if size > limit:
            turned, spring = spring * (1.0 - limit / size), spring * (limit / size)
        force = stiffness * spring + weight * load * place / np.sqrt(scene.radius**2 - place**2)
        acceleration = -force / scene.total_mass - ground[row, :2]
        speed = speed + 0.5 * step * acceleration
        if row % HEAT_STEPS == 0:
            cold = law.coefficient_at(math.hypot(*speed), load) * load * weight
            power = np.array([factor * cold * math.hypot(*turned) / step])
            track.step_to(row * step, power, math.hypot(*place))
            factor = float(Heat.factor(track.temperature(row * step, power, track.distance(row * step)))[0])
        extremes.append(place)
    ways = 1e3 * np.array(extremes)
    return [float(value) for axis in range(2) for value in (ways[:, axis].min(), ways[:, axis].max())]


def compare_opensees() -> dict[str, Any]:
    """Compare OpenSees' bearing with the equations under the same law and with its own law; needs openseespy."""
    sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "oracles")]
    phases = PHASES
    rows: dict[str, Any] = {"phases": phases.tolist(), "columns": ["mu_1", "mu_2", "displacement", "base shear"]}
    for name, yields in ((name, yields) for name in ("fig3-I", "fig3-II") for yields in OPENSEES_YIELDS):
        scene, ground = _yielding_scene(name, yields), ground_peak(load_scene(name), phases)[:, None]
        answer = reference.amplification(scene, phases, tolerance=1e-6)
        shear = [reference.demands(reference.trajectory(scene, phase)).base_shear.value for phase in phases]
        exact = np.column_stack([answer.mu, answer.displacement, shear])
        own = [_peaks_of_element(scene, phase) for phase in phases]
        by_itself = np.array(own)[:, :3] / np.hstack([ground, ground, np.ones_like(ground)])
        for integrator, named in INTEGRATORS:
            steps = {step: _follow_all(scene, phases, step, integrator) for step in OPENSEES_STEPS}
            finest = steps[OPENSEES_STEPS[-1]]
            row = {f"{step:g} s": _spread(value / finest - 1.0) for step, value in list(steps.items())[:-1]}
            row |= {"exact": _spread(finest / exact - 1.0), "own": _spread(finest[:, :3] / by_itself - 1.0)}
            rows[f"{name}, u_y = {1e3 * yields:g} mm, {named}"] = row
            print(name, yields, named, row, flush=True)
    scene, few = _yielding_scene("fig3-II", STIFF_YIELD), phases[::5]
    stiff: dict[str, Any] = {}
    for integrator, named in INTEGRATORS:
        finest = _follow_all(scene, few, STIFF_STEPS[-1], integrator)
        for step in STIFF_STEPS[:-1]:
            stiff[f"{named}, {step:g} s"] = _spread(_follow_all(scene, few, step, integrator) / finest - 1.0)
    version = importlib.metadata.version("openseespy")
    return {"openseespy": version, "opensees": rows, STIFF: stiff, f"{STIFF}: phases": few.tolist()}


def _yielding_scene(builtin: str, yields: float, **values: Any) -> Scene:
    return load_scene(builtin).with_values(values).with_yield_displacement(yields)


def _spring_of_element(scene: Scene) -> float:
    """Return kInit, which is that of spring and pendulum together, N/m."""
    weight = scene.total_mass * GRAVITY
    return scene.friction_coefficient * weight / scene.yield_displacement + weight / scene.radius


def _peaks_of_element(scene: Scene, phase: Any) -> list[float]:
    """Return largest accelerations, m/s^2, displacement, m, and base shear, N, by the element's own law."""
    from friction_pendulum_element import Element

    def shake(time: float) -> Any:
        return ground_acceleration(scene, phase, [time])[0, :2]

    law = scene.masses, scene.stiffness[0], scene.radius, scene.friction_coefficient, _spring_of_element(scene)
    return list(map(float, Element(*law, shake).peaks(scene.duration)))


def compare_terms() -> dict[str, Any]:
    """Replace the exact normal force by the element's, one term after the other, in an independent program."""
    sys.path[:0] = [str(ROOT / "tests" / "oracles")]
    found: dict[str, Any] = {"columns": ["mu_1", "mu_2", "displacement", "base shear"], "terms": TERMS, "rows": {}}
    for name, scale, count in TERM_SCENES:
        values = {"excitation.scale": scale, "isolator.friction": scale * FRICTION, "name": name}
        scene, steps, reach = _yielding_scene(name, 1e-3 * scale, **values), [], []
        for phase in PHASES[5::6][:count].tolist():
            steps.append(_follow_terms(scene, phase))
            reach.append(steps[-1][0][2] / scene.radius)
        peaks = np.array(steps)  # (P, program, quantity)
        changes = np.diff(peaks, axis=1) / peaks[:, :1]
        row: dict[str, Any] = {term: _spread(changes[:, place]) for place, term in enumerate(TERMS)}
        row |= {
            "all": _spread(peaks[:, -1] / peaks[:, 0] - 1.0),
            "u/R": float(f"{np.mean(reach):.3g}"),
            "phases": count,
        }
        found["rows"][f"{name}, times {scale:g}"] = row
        print(name, scale, row, flush=True)
    return {"terms": found}


def _follow_terms(scene: Scene, phase: Any) -> list[list[float]]:
    """Peaks of the exact equations and behind each of TERMS."""
    from yielding_motion import WithoutRise

    answer = reference.amplification(scene, [phase], tolerance=1e-6)
    ground = float(ground_peak(scene, [phase])[0])
    shear = reference.demands(reference.trajectory(scene, phase)).base_shear.value
    listed = [[*(answer.mu[0] * ground), float(answer.displacement[0]), shear]]
    for twice in (False, True):
        peaks = WithoutRise(scene, tuple(phase), twice).run(1e-8)
        listed.append([*peaks.acceleration, peaks.displacement, peaks.base_shear])
    return [*listed, _peaks_of_element(scene, phase)]


def compute_displacements() -> dict[str, Any]:
    """Compute mean and largest mu_1 of the exact equations over yield displacements and of rigid friction."""
    rows: dict[str, Any] = {}
    for name in ("fig3-I", "fig3-II"):
        scene = _yielding_scene(name, YIELDS[0])
        for number, question in enumerate(QUESTIONS):
            if question.argument != "yield_displacement":
                continue
            curves = [curve for curve in conditioning_curves((scene, number, GRID)) if curve.body == 1]
            yields, supremum = curves
            pairs, taken = distinct_pairs(scene, GRID)
            rigid = reference.amplification(question.with_damping(load_scene(name)), pairs, cutoff=DEFAULT_V_C).mu
            integrated = rigid[taken.ravel(), 0]
            rows[f"{name}, {100.0 * (yields.damping or 0.0):g} %"] = {
                "as integrated": [float(integrated.mean()), float(integrated.max())],
                "literal supremum": [supremum.mean[0], supremum.largest[0]],
                "phases per axis": GRID,
                "error": max(*yields.largest_error, *supremum.largest_error),
                **{f"{way:g}": list(pair) for way, *pair in zip(yields.v, yields.mean, yields.largest)},
            }
            print(rows, flush=True)
    return {"displacements": rows}


def draw_displacements(found: dict[str, Any]) -> None:
    """Draw mean and largest mu_1 over the yield displacement beside both readings of rigid friction."""
    rows = found["displacements"]
    figure = Figure(figsize=(11.0, 8.6), dpi=100, layout="constrained")
    for axes, (title, row) in zip(figure.subplots(-(-len(rows) // 2), 2).flat, rows.items()):
        yields = [key for key in row if key[0].isdigit()]
        for place, quantity in enumerate(("mean", "largest")):
            axes.semilogx(list(map(float, yields)), [row[way][place] for way in yields], f"C{place}o-", label=quantity)
            for style, reading in (("--", "literal supremum"), (":", "as integrated")):
                axes.axhline(row[reading][place], color=f"C{place}", ls=style, label=f"{quantity}, rigid, {reading}")
        grid, axes_of = row["phases per axis"], {"xlabel": "yield displacement, m", "ylabel": "$\\mu_1$"}
        axes.set(title=f"{title.replace(', ', ', links damped by ')}, {grid} × {grid} phases", **axes_of)
        axes.legend(fontsize=7)
        axes.grid(alpha=0.3)
    figure.savefig(PICTURE)


def displacement_table() -> str:
    """Mean and largest mu_1 over the yield displacement and of rigid friction, as lines of a page."""
    rows = json.loads(STORED.read_text(encoding="utf-8"))["displacements"]
    columns = [column for column, cell in next(iter(rows.values())).items() if isinstance(cell, list)]
    heads = [f"u<sub>y</sub> = {1e3 * float(c):g} mm" if c[0].isdigit() else f"rigid, {c}" for c in columns]
    lines = [f"| scene, link damping | phases | {' | '.join(heads)} |", f"|{'---|' * (len(heads) + 2)}"]
    for title, row in rows.items():
        grid, pairs = row["phases per axis"], [row[column] for column in columns]
        cells = " | ".join(f"{mean:.3f} ({largest:.3f})" for mean, largest in pairs)
        lines.append(f"| {title} | {grid} × {grid} | {cells} |")
    return "\n".join(lines)


def _follow_all(scene: Scene, phases: Any, step: float, integrator: tuple[Any, ...]) -> Any:
    """Return mu_1, mu_2, displacement and base shear (M, 4) of OpenSees at phase pairs (M, 2)."""
    from examples.engines import opensees

    found = []
    for phase in phases:
        place, absolute = opensees.follow(scene, phase, step, integrator)
        force = np.einsum("b,tbx->tx", scene.masses, absolute[..., :2])
        peaks = np.linalg.norm(absolute, axis=2).max(axis=0) / ground_peak(scene, [phase])
        found.append([*peaks, np.linalg.norm(place, axis=1).max(), np.linalg.norm(force, axis=1).max()])
    return np.array(found)


def _steps_in_period(row: str, step: float) -> float:
    """Return how many steps the platform's period on the spring has; row: name of a row, with scene and u_y."""
    name, stated = row.split(", u_y = ")
    scene = load_scene(name)
    limit = FRICTION * scene.total_mass * GRAVITY
    period = 2.0 * math.pi * math.sqrt(scene.masses[0] * 1e-3 * float(stated.partition(" mm")[0]) / limit)
    return period / step


def _spread(change: Any) -> list[list[float]]:
    """Median and largest size of relative changes (M, Q) in each column."""
    return [[float(f"{value:.2g}") for value in (np.median(each), each.max())] for each in np.abs(change).T]


def state_frame(found: dict[str, Any]) -> str:
    """Say whether a yield displacement that is fitted to one run of the frame meets what is not met without."""
    frame_ = found["frame"]
    lines = []
    for law in ("one ratio", "friction of the load"):
        rigid, elastic = (
            {tuple(row[:2]): row for row in rows if row[4] is not None}
            for name, rows in frame_["laws"].items()
            if name.startswith(law)
        )
        gained = [key for key, row in elastic.items() if row[4] and not rigid[key][4]]
        lost = [key for key, row in elastic.items() if not row[4] and rigid[key][4]]
        met = [sum(row[4] for row in rows.values()) for rows in (rigid, elastic)]
        lines.append(
            f"by {law} {met[0]} of {len(rigid)} quantities are met without and {met[1]} with it, "
            f"{len(gained)} gained and {len(lost)} lost"
        )
    misfits = ", ".join(
        f"{run} {fits[0][2]:.3f} to {next(f[2] for f in fits if f[0] == frame_['fitted at 250 g, mm']):.3f} mm"
        for run, fits in frame_["fits"].items()
    )
    return (
        f"Frame: a yield displacement of {frame_['fitted at 250 g, mm']:g} mm, fitted to the run with 250 g, does not "
        f"validate more: {'; '.join(lines)}. It brings the cycle closer where the ratio is fitted to each run (rms: "
        f"{misfits}), and shortens the time at rest too much."
    )


def state_pendulum(found: dict[str, Any]) -> str:
    """Say which turning points of the pendulum a fitted yield displacement meets."""
    rows, fitted = found["pendulum"]["rows"], found["pendulum"]["fitted, rad"]
    words = []
    for yields in (0.0, fitted):
        met = [row[1].removeprefix("turning point ") for row in rows if row[0] == yields and row[4]]
        words.append(", ".join(met) if met else "none")
    last = [next(row[2] for row in rows if row[0] == yields and row[1].endswith("13")) for yields in (0.0, fitted)]
    return (
        f"Pendulum: with a yield displacement of {1e3 * fitted:g} mrad, fitted to turning points 0 to 10 together with "
        f"the loss, the turning points that are met are {words[1]}; without it {words[0]}. The last one, 13, is off by "
        f"{last[1]:+.1f} in place of {last[0]:+.1f} mrad."
    )


def state_mastodon(found: dict[str, Any]) -> str:
    """Say how far the displacements of MASTODON's bearing are from the published ones, with and without its 1 mm."""
    published = found["mastodon"]["published"]
    off = {
        name: max(abs(a - b) for a, b in zip(found["mastodon"][name], published))
        for name in ("u_y = 0.01 mm", "u_y = 1 mm")
    }
    with_it = ", ".join(f"{value:.1f}" for value in found["mastodon"]["u_y = 1 mm"])
    return (
        f"MASTODON: with its own restoring force N y / sqrt(R² − y²) and its yield displacement of 1 mm the ranges are "
        f"{with_it} mm. The largest difference from the published ones is {off['u_y = 1 mm']:.1f} mm; without the "
        f"yield displacement (0.01 mm) it is {off['u_y = 0.01 mm']:.1f} mm. The loops can be read to 3 mm."
    )


def state_opensees(found: dict[str, Any]) -> str:
    """Say which outputs of OpenSees' bearing may be trusted at which step and stiffness, and which are artifacts."""
    rows = [row for name, row in found["opensees"].items() if "u_y" in name]
    stiff = found[STIFF]

    def worst(column: str, *places: int) -> str:
        return f"{100.0 * max(row[column][place][1] for row in rows for place in places):.1f} %"

    fine = [
        row[f"{step:g} s"][0][1]
        for name, row in found["opensees"].items()
        for step in (OPENSEES_STEPS[:-1] if "u_y" in name else ())
        if _steps_in_period(name, step) >= FINE
    ]
    coarse = f"{_steps_in_period('fig3-II, u_y = 0.01 mm', STIFF_STEPS[0]):.0f}"
    own = max(row["own"][place][1] for row in rows for place in range(3))
    wrong = {name: f"{100.0 * row[0][1]:.1f} %" for name, row in stiff.items()}
    return (
        "Friction of such an element is a spring k = μW/u_y up to μN. The law explains it: with `kInit` = k + W/R (the "
        f"element subtracts N/R) and steps of {OPENSEES_STEPS[-1]:g} s, OpenSees' bearing is within {100.0 * own:.2g} "
        "% of an independent program of the element's own law in μ₁, μ₂ and displacement at all phase pairs. "
        f"Trustworthy at every step tried, up to {OPENSEES_STEPS[0]:g} s: μ₂ (within {worst('0.004 s', 1)} of its "
        f"limit), displacement ({worst('0.004 s', 2)}) and base shear ({worst('0.004 s', 3)}). μ₁ needs "
        f"{FINE} steps in the period 2π √(m₁ u_y / (μW)) of the platform on the spring: then it is within "
        f"{100.0 * max(fine):.1f} % of its limit. With longer steps its peaks are artifacts of the step: at u_y = 0.01 "
        f"mm and {STIFF_STEPS[0]:g} s, {coarse} steps in that period, HHT with α = 0.67 is off by up to "
        f"{wrong['HHT 0.67, 0.002 s']} and Newmark by {wrong['Newmark, 0.002 s']}, in "
        f"place of {wrong['HHT 0.67, 0.0005 s']} and {wrong['Newmark, 0.0005 s']} at 0.0005 s. What no step removes is "
        f"the element. Against the exact equations of the same law it is off by up to {worst('exact', 1)} of μ₂, "
        f"{worst('exact', 2)} of the displacement, {worst('exact', 0)} of μ₁ and {worst('exact', 3)} of the base "
        "shear. The rows above have u_y = 0.01 mm and steps of 0.002 and 0.004 s: their μ₁ is such an artifact."
    )


def state_terms(found: dict[str, Any]) -> str:
    """Say which term of the element's normal force makes which part of its difference from the exact equations."""
    rows = found["terms"]["rows"]
    whole = [row for title, row in rows.items() if title.endswith("times 1")]
    smaller = [row for title, row in rows.items() if title.startswith(f"{TERM_SCENES[0][0]},")]

    def worst(term: str) -> str:
        sizes = [max(row[term][place][1] for row in whole) for place in range(4)]
        return ", ".join(f"{100.0 * size:.2g} %" for size in sizes)

    parts = "; ".join(f"{term}: {worst(term)}" for term in found["terms"]["terms"])
    first, *_ = found["terms"]["terms"]
    ratios = ", ".join(f"{row['u/R']:.2g}" for row in smaller)
    sizes = [row[first][0][1] for row in smaller]
    power = math.log(sizes[0] / sizes[-1]) / math.log(smaller[0]["u/R"] / smaller[-1]["u/R"])
    count = sum(row["phases"] for row in whole)
    return (
        "The reason is its normal force N = W + V u/R. In an independent program of the exact equations only that "
        "force was replaced, one term after the other, at u_y = 1 mm. Largest changes of μ₁, μ₂, displacement and base "
        f"shear at {count} phase pairs of fig3-I and fig3-II: {parts}. The last step ends at the element's own law, "
        "which OpenSees meets and whose program reads peaks to 0.1 %. Loading, friction and yield displacement of "
        f"fig3-I times 1, 1/2 and 1/4 have a largest u/R of {ratios} in the mean. Of μ₁ the first term is then "
        f"{', '.join(f'{100.0 * size:.2g} %' for size in sizes)}: it falls with the power {power:.1f} of u/R."
    )


def opensees_section() -> list[str]:
    """Lines of the page of engines on an element that yields elastically, from what is recorded."""
    found = json.loads(STORED.read_text(encoding="utf-8"))
    rows = {name: row for name, row in found["opensees"].items() if "u_y" in name}
    finest = f"{OPENSEES_STEPS[-1]:g} s"
    columns = [f"{step:g} s" for step in OPENSEES_STEPS[:-1]]
    heads = [*(f"{step} against {finest}" for step in columns), "element's law", "exact equations"]
    text = [
        "## An element that yields elastically",
        "",
        state_opensees(found),
        "",
        state_terms(found),
        "",
        "`python docs/yielding_friction.py opensees` records the table and `terms` the terms, with openseespy "
        f"{found['openseespy']}. 16 phase pairs; "
        "median / largest relative difference of μ₁, μ₂, displacement and base shear; the last two columns are those "
        "of "
        f"{finest}. Base shear counts where it is not that of the first instant.",
        "",
        f"| scene, u_y, integrator | {' | '.join(heads)} |",
        f"|{'---|' * (len(heads) + 1)}",
    ]
    for name, row in rows.items():
        cells = [", ".join(f"{a:.0e} / {b:.0e}" for a, b in row[column]) for column in (*columns, "own", "exact")]
        text.append(f"| {name} | {' | '.join(cells)} |")
    return text


def compare_measured(folder: Path) -> dict[str, Any]:
    """Compare the frame and the pendulum with their measured files."""
    kept = json.loads(Path(table.__file__).with_name("recorded.json").read_text())
    recorded = {
        f"{row['experiment']}: {row['name']}": {
            "measured": row["measured"],
            "u_val": row["sides"][EQUATIONS]["validation"],
        }
        for row in kept["quantities"]
    }
    files = read_folder(folder)
    return {
        "frame": compare_frame([frame.fold_run(run) for run in files.runs], recorded),
        "pendulum": compare_pendulum(files.decay, recorded),
    }


def compare_mastodon(path: Path) -> dict[str, Any]:
    """Compare MASTODON's bearing with its published displacements."""
    return {
        "mastodon": {
            "published": list(cases.MASTODON_EXTREMES),
            "u_y = 0.01 mm": compute_mastodon(path, 1e-5, 5e-5),
            "u_y = 1 mm": compute_mastodon(path, 1e-3, 1e-4),
        }
    }


TABLES: dict[str, Callable[..., dict[str, Any]]] = {
    "measured": compare_measured,
    "mastodon": compare_mastodon,
    "opensees": compare_opensees,
    "terms": compare_terms,
    "displacements": compute_displacements,
}


def main(name: str, *files: Path) -> None:
    """Compute a table, and store it beside the others with its day and the package's version."""
    made = TABLES[name](*files)
    found = json.loads(STORED.read_text(encoding="utf-8"))
    computed = {"day": time.strftime("%Y-%m-%d"), "phase-resonance": importlib.metadata.version("phase-resonance")}
    found |= made | {"computed": found.get("computed", {}) | {name: computed}}
    STORED.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    if name == "displacements":
        draw_displacements(found)


if __name__ == "__main__":
    main(sys.argv[1], *map(Path, sys.argv[2:]))
