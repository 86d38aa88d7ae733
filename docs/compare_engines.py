"""
Measure every engine of examples/engines beside ours and write docs/engines.md with its picture.

    python docs/compare_engines.py [NAME ...]

Without names every engine that is installed here is measured. What was measured before is kept in docs/engines.json, so
that an engine that is installed elsewhere keeps its rows. 64 phase pairs of two scenes; those whose motion mirrors
another's are computed once. Error: relative, against the reference at a tolerance of 1e-9. Time: of the processor.

docs/question.json states what is asked, and the answer with its errors, for codes that no adapter calls.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from functools import partial
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import yielding_friction
from matplotlib.figure import Figure

import reference
from comparison.runner.environment import COMPUTING_PACKAGES
from comparison.runner.processes import Workers
from comparison.study.user_models import amplification
from reference.problem import GRAVITY, load_scene, phase_grid
from reference.problem.excitation import exponents
from reference.problem.symmetry import indices_of_solved_pairs

DOCS = Path(__file__).parent
GRID, SCENES = 8, ("fig3-I", "fig3-II")
LIMIT = 1800.0  # s of processor time of one setting
V_REG = 1e-3  # m/s
SOLUTIONS: dict[str, dict[str, Any]] = {
    "supremum": {},
    "resolved": {"cutoff": V_REG},
    "regularized": {"regularization": V_REG},
    "small, resolved": {"equations": "small", "cutoff": V_REG},
}
MEASURES = (  # what is compared: title, body, solution; None: of the law that the engine solves
    ("μ₁, supremum", 0, "supremum"),
    ("μ₁, resolved", 0, "resolved"),
    ("μ₁, own law", 0, None),
    ("μ₂, exact", 1, "supremum"),
    ("μ₂, own law", 1, None),
)


class Engine(NamedTuple):
    """law: the solution that has its law. varied: settings, one row each. lacks: what it cannot express."""

    name: str
    function: str
    law: str
    varied: tuple[dict[str, Any], ...]
    package: str
    lacks: str


ENGINES = (
    Engine(
        "equations",
        "reference:amplification",
        "supremum",
        ({"tolerance": 1e-3}, {"tolerance": 1e-6}),
        "phase-resonance",
        "bodies that turn",
    ),
    Engine(
        "Exudyn, translational",
        "multibody:amplification",
        "regularized",
        ({"tolerance": 1e-2}, {"tolerance": 1e-3}),
        "exudyn",
        "true rest: friction is linear below v_reg",
    ),
    Engine(
        "SciPy, LSODA",
        "examples.engines.scipy_equations:amplification",
        "regularized",
        ({"rtol": 1e-4}, {"rtol": 1e-6}),
        "scipy",
        "true rest",
    ),
    Engine(
        "OpenSees",
        "examples.engines.opensees:amplification",
        "resolved",
        ({"step": 4e-3}, {"step": 2e-3}, {"step": 1e-3}),
        "openseespy",
        "the sphere: its restoring force is N x/R; friction linear in the velocity: it is an elastic-plastic spring",
    ),
    Engine(
        "Siconos",
        "examples.engines.siconos_moreau:amplification",
        "resolved",
        ({"step": 8e-3}, {"step": 4e-3}, {"step": 2e-3}),
        "python3-siconos",
        "one-sided limits at stops: a step has one mean acceleration",
    ),
    Engine(
        "solve_nivp",
        "examples.engines.solve_nivp_slider:amplification",
        "resolved",
        ({"step": 8e-3}, {"step": 4e-3}),
        "solve_nivp",
        "one-sided limits at stops",
    ),
    Engine(
        "nosnoc",
        "examples.engines.nosnoc_slider:amplification",
        "resolved",
        ({"step": 0.04},),
        "nosnoc",
        "a friction force in any direction; one-sided limits at stops",
    ),
    Engine(
        "MuJoCo",
        "examples.engines.mujoco_slider:amplification",
        "small, resolved",
        ({"step": 2e-3}, {"step": 1e-3}, {"step": 5e-4}),
        "mujoco",
        "the sphere: its restoring force is m_sum g x/R; friction linear in the velocity; a hard contact that slides",
    ),
)


HEAD = """# What engines cost for which error

Made by `python docs/compare_engines.py`, which measures what is installed. How an engine joins a study:
[other engines](other-engines.md).

64 phase pairs of `fig3-I` and `fig3-II`, each engine in a process of its own on one processor of a busy machine. Phase
pairs whose motion mirrors another's are computed once, and the time is scaled to all of them. Errors are relative,
against the equations at a tolerance of 1e-9: median / largest over the phase pairs. “Own law” is the solution with the
law that the engine solves: set-valued (supremum); the same, read at rest or faster than 1 mm/s (resolved); linear below
1 mm/s (regularized); or that of the equations for small vibrations. The supremum of μ₁ includes the one-sided limits at
stops, which no step shows: against it every engine but the equations has the error of its model, whatever it costs.

![Error over processor time, by quantity and scene](engines.png)

Solid: median; dotted: largest."""


def main(names: list[str]) -> None:
    """Measure, store, and write the page."""
    store = DOCS / "engines.json"
    rows: list[dict[str, Any]] = json.loads(store.read_text()) if store.exists() else []
    for engine in ENGINES:
        if names and engine.name not in names:
            continue
        for measured in _measured(engine):
            rows = [row for row in rows if any(row[key] != measured[key] for key in ("scene", "engine", "setting"))]
            rows.append(measured)
            store.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    (DOCS / "question.json").write_text(json.dumps(question()) + "\n", encoding="utf-8")
    order = [engine.name for engine in ENGINES]
    rows.sort(key=lambda row: (SCENES.index(row["scene"]), order.index(row["engine"]), row["seconds"]))
    _draw(rows)
    (DOCS / "engines.md").write_text(_page(rows), encoding="utf-8")


def question() -> dict[str, Any]:
    """What every engine is asked, in SI units and without this package, and the answer with its errors."""
    phases = phase_grid(GRID)
    asked: dict[str, Any] = {
        "asked": "mu[i]: largest absolute acceleration of body i over the largest ground acceleration, from rest at "
        "the lowest point, 0 <= t <= duration, for each pair of phases",
        "system": "Body 1 slides inside a sphere of the radius; its contact force carries the weight of all bodies. "
        "Bodies 2, 3, ... rise and fall with it and move relative to it in x and y; link j joins bodies j and j + 1. "
        "Friction: Coulomb, at rest up to the same coefficient.",
        "ground": "acceleration along axis a: sum over k of amplitude[a][k] exp(-decay[k] t) cos(omega[k] t + "
        "phase[k])",
        "answers": {
            "supremum": "one-sided limits at stops included",
            "resolved": f"the same, read at rest or faster than {V_REG} m/s",
            "regularized": f"friction linear in the speed below {V_REG} m/s",
            "small, resolved": "equations of small vibrations, read like resolved",
        },
        "phases": phases.tolist(),
        "scenes": {},
    }
    for name in SCENES:
        scene = load_scene(name)
        waves = exponents(scene)
        results = {key: reference.amplification(scene, phases, tolerance=1e-9, **law) for key, law in SOLUTIONS.items()}
        asked["scenes"][name] = {
            "gravity": GRAVITY,
            "radius": scene.radius,
            "friction": scene.friction_coefficient,
            "masses": scene.masses.tolist(),
            "stiffness": scene.stiffness.tolist(),
            "amplitude": scene.amplitudes.tolist(),
            "omega": waves.imag.tolist(),
            "decay": (-waves.real).tolist(),
            "duration": scene.duration,
            "mu": {key: found.mu.tolist() for key, found in results.items()},
            "error": {key: found.error.tolist() for key, found in results.items()},
        }
    return asked


def _measured(engine: Engine) -> Iterator[dict[str, Any]]:
    """A row for every scene and setting; none where the engine is not installed."""
    for settings in engine.varied:
        for name in SCENES:
            workers = Workers(1)  # a fresh process: no setting finds another's work done
            try:
                task = workers.start(partial(_asked, engine.function, name, settings), LIMIT)
                mu, solutions, seconds = task.result()
            except Exception as error:
                print(f"{engine.name}, {name}, {settings}: {type(error).__name__}: {error}", file=sys.stderr)
                continue
            finally:
                workers.abandon()
            row: dict[str, Any] = {"scene": name, "engine": engine.name, "setting": _words(settings)}
            row |= {"version": _version(engine), "seconds": round(seconds, 3), "points": len(mu)}
            row["lost"] = int((~np.isfinite(mu).all(axis=1)).sum())
            for title, body, solution in MEASURES:
                error = np.abs(mu[:, body] / solutions[solution or engine.law][:, body] - 1.0)
                known = error[np.isfinite(error)]
                row[title] = [float(f"{np.quantile(known, share):.2g}") if len(known) else None for share in (0.5, 1.0)]
            print(row, file=sys.stderr)
            yield row


def _asked(function: str, name: str, settings: dict[str, Any]) -> tuple[Any, dict[str, Any], float]:
    """mu of an engine and of every solution, (64, N), and processor time of 64 phase pairs, s. In a worker process."""
    scene, phases = load_scene(name), phase_grid(GRID)
    alike = indices_of_solved_pairs(scene, GRID)
    solved = np.unique(alike)
    law = {"regularization": V_REG} if function.startswith("multibody") else {}
    engine = {"engine": {"function": function}, **law, **settings}
    amplification(scene.with_values({"duration": 0.2}), phases[:1], **engine)  # imports and compiles
    answer = amplification(scene, phases[solved], **engine)
    place = np.searchsorted(solved, alike)
    solutions = {
        key: reference.amplification(scene, phases[solved], tolerance=1e-9, **law).mu[place]
        for key, law in SOLUTIONS.items()
    }
    return answer.mu[place], solutions, answer.cost * len(phases) / len(solved)


def _words(settings: dict[str, Any]) -> str:
    return ", ".join(f"{key} {value:g}{' s' if key == 'step' else ''}" for key, value in settings.items())


def _version(engine: Engine) -> str:
    try:
        return version(engine.package)
    except PackageNotFoundError:
        return "of the system"


def _draw(rows: list[dict[str, Any]]) -> None:
    """Error over time, a panel for every measure, a row for every scene."""
    figure = Figure(figsize=(15.0, 6.4), dpi=100, layout="constrained")
    panels = figure.subplots(len(SCENES), len(MEASURES), sharex=True, sharey=True)
    for line, scene in zip(panels, SCENES):
        for axes, (title, _, _) in zip(line, MEASURES):
            axes.set(xscale="log", yscale="log", ylim=(1e-10, 10.0))
            axes.grid(alpha=0.3)
            for number, engine in enumerate(ENGINES):
                chosen = [row for row in rows if (row["scene"], row["engine"]) == (scene, engine.name)]
                if not chosen:
                    continue
                errors = np.array([row[title] for row in chosen], dtype=float).reshape(-1, 2).clip(1e-10, 10.0)
                seconds = [row["seconds"] for row in chosen]
                axes.plot(seconds, errors[:, 0], marker="osD^v<>P"[number], color=f"C{number}", label=engine.name)
                axes.plot(seconds, errors[:, 1], ":", color=f"C{number}")
            if scene == SCENES[0]:
                axes.set_title(title)
            else:
                axes.set_xlabel("processor time of 64 phase pairs, s")
        line[0].set_ylabel(f"{scene}: relative error")
    panels[0, 0].legend(fontsize=8)
    figure.savefig(DOCS / "engines.png")


def _page(rows: list[dict[str, Any]]) -> str:
    text = [HEAD]
    for scene in SCENES:
        heads = ["engine", "setting", "64 phase pairs, s", *(title for title, _, _ in MEASURES), "lost"]
        text += ["", f"## {scene}", "", f"| {' | '.join(heads)} |", f"|{'---|' * len(heads)}"]
        for row in rows:
            if row["scene"] == scene:
                sizes = [
                    " / ".join("none" if error is None else f"{error:.0e}" for error in row[title])
                    for title, _, _ in MEASURES
                ]
                cells = [row["engine"], row["setting"], f"{row['seconds']:.2g}", *sizes, str(row["lost"])]
                text.append(f"| {' | '.join(cells)} |")
    text += ["", "## What each solves", "", "| engine | version | law | cannot express |", "|---|---|---|---|"]
    for engine in ENGINES:
        measured = [row["version"] for row in rows if row["engine"] == engine.name]
        if measured:
            text.append(f"| {engine.name} | {engine.package} {measured[-1]} | {engine.law} | {engine.lacks} |")
    text += ["", *yielding_friction.opensees_section()]
    with_versions = ", ".join(f"{name} {version(name)}" for name in COMPUTING_PACKAGES)
    return "\n".join([*text, "", f"Measured with Python {sys.version.split()[0]}, {with_versions}.", ""])


if __name__ == "__main__":
    main(sys.argv[1:])
