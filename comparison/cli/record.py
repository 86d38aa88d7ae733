"""
Records the one table of costs, which `--plan` and `--tolerance` of `comparison.run` read, in one run.

For every model of the hierarchy and every tolerance: what a point costs beside one at the usual tolerance, and at which
share of the points the accuracy was met, on the paper's scenes. The file goes into the user's cache, where the commands
of this machine read it in place of that of the package.
"""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from comparison.analysis.tradeoff.measure import Measured, Measurement, measure, sample
from comparison.analysis.tradeoff.settings import SPATIAL_TIGHT, TIGHT
from comparison.cli.arguments import CommandParser, command, writing
from comparison.execution.provenance import provenance
from comparison.study.accuracy_record import RecordedModels, load_record, machine_file, recorded
from comparison.study.batches import imported
from comparison.study.models import (
    EXACT,
    MODEL_HIERARCHY,
    REFERENCE_TOLERANCE,
    REGULARIZED,
    SPATIAL,
    TRANSLATIONAL,
    Model,
)
from comparison.study.planning import DEFAULT_GRID
from reference.problem import Scene, SceneError, builtin_scenes, load_scene
from reference.problem.files import write_atomically

Array = NDArray[np.float64]

REFERENCE_TOLERANCES = tuple(10.0**-power for power in range(2, 9))
ENGINE_TOLERANCES = (1e-2, 1e-3, 1e-4, 1e-5)
POINTS = {"reference": 64, "translational": 8, "spatial": 4}
REPEATS = {"reference": 5, "engine": 1}  # of a measurement; the fastest counts: those of the reference are short


@command
def main(argv: Sequence[str]) -> int:
    """Record, print a line for every model, and write the file; the exit code."""
    parser = CommandParser("tradeoff.record", "Cost and accuracy of every model, recorded on this machine.")
    parser.add_argument("--out", type=Path, metavar="FILE", help="where to (default: the user's cache)")
    file = _place(parser.parse_args(argv).out)
    scenes = [load_scene(name) for name in builtin_scenes()]
    record: dict[str, Any] = {"machine": provenance()["processor"], "models": {}}
    seconds: dict[str, dict[str, float]] = {scene.digest(): {} for scene in scenes}
    for model in MODEL_HIERARCHY:
        applying = [scene for scene in scenes if model.applies(scene)]
        rows, costs = _rows(model, applying)
        record["models"][model.key] = {"usual": _usual(model), "tolerances": rows}
        for scene, cost in zip(applying, costs):
            seconds[scene.digest()][model.key] = float(f"{cost:.4g}")
        print(model.key, *(f"{row['tolerance']:.0e}: {row['cost']:.2f}, {row['met']:.3f}" for row in rows), sep="  ")
    record["seconds"] = seconds
    with writing(file):
        write_atomically(file, (json.dumps(record, indent=1) + "\n").encode())
    recorded.cache_clear()
    print(*surface_costs(load_record(file)), file, sep="\n")
    return 0


def _place(out: Path | None) -> Path:
    """Where the record goes. Raises SceneError, one line, before anything is measured."""
    file = machine_file() if out is None else out
    if file is None:
        raise SceneError("command line", "--out", "absent", "the user's cache cannot be written: give a file")
    if file.is_dir() or not os.access(file if file.exists() else file.parent, os.W_OK):
        raise SceneError("command line", "--out", str(file), "cannot be written: give another file")
    return file


def surface_costs(record: RecordedModels) -> list[str]:
    """What a surface of the default study costs, s, by the accuracy asked: the rows in docs/guide/accuracy.md."""
    rows = []
    for power in range(2, 9):
        tolerance, cells = 10.0**-power, []
        for model in (EXACT, REGULARIZED, TRANSLATIONAL, SPATIAL):
            accuracy = record.accuracy[model.key]
            if tolerance < accuracy.tightest:
                cells += ["cannot", ""] if model is TRANSLATIONAL else [""]
                continue
            asks = accuracy.setting(model.tolerance(tolerance))
            each = np.mean([seconds[model.key] for seconds in record.seconds.values() if model.key in seconds])
            seconds = each * accuracy.cost(asks) * (model.most or DEFAULT_GRID) ** 2
            exponent = f"{asks:.0e}".replace("e-0", "e-")
            cells += [*([exponent] if model in (EXACT, TRANSLATIONAL) else []), f"{float(f'{seconds:.2g}'):g}"]
        rows.append(f"| 1e-{power} | {' | '.join(cells)} |".replace("|  |", "| |").replace("|  |", "| |"))
    return rows


def _usual(model: Model) -> float:
    return REFERENCE_TOLERANCE if model.side == "reference" else 1e-3


def _rows(model: Model, scenes: list[Scene]) -> tuple[list[dict[str, Any]], list[float]]:
    """What every tolerance gives in all scenes together; processor time of a point of each scene as usual, s."""
    phases = sample(POINTS.get(model.key, POINTS["reference"]))
    tolerances = REFERENCE_TOLERANCES if model.side == "reference" else ENGINE_TOLERANCES
    reference_solutions = [_reference_solution(model, scene, phases) for scene in scenes]
    measured = {tolerance: [_answer(model, scene, phases, tolerance) for scene in scenes] for tolerance in tolerances}
    usual = measured[_usual(model)]
    rows = []
    for tolerance, answers in measured.items():
        errors = np.concatenate(
            [
                np.abs(answer.mu / reference_solution - 1.0).max(axis=1)
                for answer, reference_solution in zip(answers, reference_solutions)
                if reference_solution is not None
            ]
        )
        claims = np.concatenate([(answer.error_estimate / answer.mu).max(axis=1) for answer in answers])
        cost = sum(answer.seconds for answer in answers) / sum(answer.seconds for answer in usual)
        rows.append(
            {
                "tolerance": tolerance,
                "cost": float(f"{cost:.3g}"),
                "met": float((np.nan_to_num(errors, nan=np.inf) <= tolerance).mean()),
                "met_by_estimate": float((np.nan_to_num(claims, nan=np.inf) <= tolerance).mean()),
                "error": float(f"{np.quantile(errors, 0.99, method='higher'):.2g}"),
                "points": len(errors),
                "reference_tolerance": SPATIAL_TIGHT if model.key == "spatial" else TIGHT,
            }
        )
    return rows, [answer.seconds / len(phases) for answer in usual]


def _answer(model: Model, scene: Scene, phases: Array, tolerance: float) -> Measured:
    measurement = Measurement(scene, (model.amplification, {**model.settings, "tolerance": tolerance}), 0, phases)
    return min((measure(measurement) for _ in range(REPEATS[model.side])), key=lambda answer: answer.seconds)


def _reference_solution(model: Model, scene: Scene, phases: Array) -> Array:
    """mu (M, N): of the same question by the reference, and of the spatial model, which it does not know, by itself."""
    if model.key == "spatial":
        return _answer(model, scene, phases, SPATIAL_TIGHT).mu
    if model.side == "engine":
        law = {"regularization": None if scene.lubricated else model.settings["regularization"]}
        return np.array(imported("reference:amplification")(scene, phases, tolerance=TIGHT, **law).mu)
    return _answer(model, scene, phases, TIGHT).mu
