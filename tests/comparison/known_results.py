"""Known results that commands leave beside a report, and columns whose models fail in known ways."""

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest
import xarray as xr

from comparison.analyses.assumptions.trials import DURATION, DirectionTrial
from comparison.analyses.assumptions.validity import (
    ASSUMPTIONS,
    PHASES,
    AssumptionCell,
    Validity,
    find_validity_ranges,
)
from comparison.analyses.assumptions.variations import TURNED_LINK, Variation
from comparison.analyses.ensemble import result as ensemble
from comparison.analyses.measured.analysis import ComputedPeak, MeasuredPeak
from comparison.analyses.worst_phases.analysis import LargestOverPhases
from comparison.evidence.benchmarks import table as benchmarks
from comparison.evidence.extremes import matrix as extremes
from comparison.evidence.extremes.columns import ModelColumn
from comparison.evidence.extremes.matrix import Extreme, Matrix, MatrixEntry
from comparison.evidence.extremes.rows import ExtremeCase
from comparison.evidence.extremes.scenes import make_baseline_scene
from comparison.evidence.tradeoff import command as tradeoff
from comparison.evidence.tradeoff import growth
from comparison.evidence.tradeoff.trade import MeasuredSetting as Setting
from comparison.evidence.tradeoff.trade import MeasuredTrade, SceneTrade, SolvedQuestion, mark_pareto_fronts
from comparison.evidence.validation import table as validation
from comparison.runner.output import publish_files
from reference.problem import load_scene
from reference.problem.readings import AS_INTEGRATED

MADE = {"command": "made <by a test>", "began": "then", "seconds": 1.0, "compute_seconds": 1.0, "jobs": 1,
        "quick": True, "provenance": {"commit": "abc", "processor": "one"}}  # fmt: skip
PLAIN = ExtremeCase("anything", "plain", make_baseline_scene(), ("fake",))
FOUND = Matrix(
    {"small": "small equations", "spatial": "spatial engine"},
    [
        Extreme(
            "friction", "1e-9", {"small": MatrixEntry("converged", "error 2e-07 confirmed", "ok", 2e-7, 0.25, 0.5)}
        ),
        Extreme("friction", "10", {"spatial": MatrixEntry("limit", "step limit", "step limit", None, 0.25, 0.5)}),
        Extreme("rho, m", "1e3", {"small": MatrixEntry("FAILED", "hangs: <forever>", "time limit", None, None, None)}),
    ],
    {"command": "made by a test", "began": "then", "seconds": 1.0, "cpu_seconds": 2.0, "jobs": 1, "limit": 90.0,
     "reduced": False, "provenance": {"commit": "abc"}},
)  # fmt: skip
SEARCHED = [
    LargestOverPhases(
        "fig3-I", "exact", "amplification", 1, 8.765, 1e-4, (1.0, 2.0), "smooth", runner_up=8.5, climbs=4, reached=3
    ),
    LargestOverPhases(
        "fig3-I", "exact", "displacement", 1, 0.123, 2e-5, (3.0, 4.0), "kink", runner_up=0.11, climbs=6, reached=5
    ),
    LargestOverPhases("fig3-I", "exact", "amplification", 2, 7.321, 3e-4, (5.0, 6.0), "jump", (0.25, -0.75), 7.1, 8, 7),
]
COMPUTED = [
    ComputedPeak("exact", 5.0, 1e-3, 1.0, True, "ok"),
    ComputedPeak("translational", 4.125, 2e-3, 0.125, False, "ok"),
    ComputedPeak("spatial", math.nan, math.nan, math.nan, None, "rim reached"),
]
MEASURED = [MeasuredPeak("fig3-I", "mu", 1, (1.0, 2.0), 4.0, 0.25, "run 7", COMPUTED)]


def known_assumptions() -> Validity:
    """Rings and heights of which the last ones tell, an offset in its worst direction, a blind angle."""
    scene, cells = load_scene("fig3-I"), []
    usual = [Variation(ring, height) for ring in (0.5, 1.0, 2.0) for height in (0.5, 1.0)]
    uneven = [Variation(offset=size, direction=1.5) for size in (0.1, 0.3)]
    for number, variation in enumerate([*usual, *uneven, Variation(supports=3), Variation(bars="softening")]):
        sizes = [0.0013 * (1.7 * number + 1.0) * (1.0 + 0.5 * pair) for pair in range(2)]
        change = tuple((size, -0.83 * size) for size in sizes)
        uncertainty = tuple((1e-4 * (1 + number), 2e-4 * (1 + number)) for _ in sizes)
        cells.append(AssumptionCell(scene.name, variation, change, uncertainty, ("ok",) * 2, cost=0.1 * number))
    none = ((float("nan"),) * 2,) * 2
    cells.append(AssumptionCell(scene.name, Variation(height=3.0), none, none, ("rim reached",) * 2, "it <broke>"))
    tried = (("offset", Variation(offset=0.1), ""), ("offset", uneven[0], ""), ("yaw", Variation(yaw=0.2), TURNED_LINK))
    directions = [
        DirectionTrial(scene.name, key, variation, *(((), ()) if blind else ((0.01 * n, -0.07), (0.002, 0.001))), blind,
                       variation is uneven[0])
        for n, (key, variation, blind) in enumerate(tried, start=1)
    ]  # fmt: skip
    of_scene = tuple(find_validity_ranges(scene, cells, directions))
    return Validity(ASSUMPTIONS, AS_INTEGRATED, PHASES, DURATION, tuple(cells), tuple(directions), of_scene)


def fake(model: str, finer: str = "") -> ModelColumn:
    """A column whose model, and the finer one that confirms it, are from extreme_models."""
    path = f"extreme_models:{model}"
    return ModelColumn("fake", model, path, {}, 1e-3, ((f"extreme_models:{finer or model}", {}, 1e-5),))


def known_trade(name: str) -> SceneTrade:
    """Two settings of one method, the second of which is dearer and worse."""
    scene, nothing = load_scene(name), (None, None)
    one = Setting("exact", "reference, one run", "tolerance inside a step", "", 1e-3, False, False, 3, 3, 0.002,
                (1e-9, 2e-9), (3e-8, 4e-8), nothing, 0.1)  # fmt: skip
    entries = [one, replace(one, value=1e-2, seconds=0.003, most=(1e-3, 1e-3), error_message="<b>")]
    question = SolvedQuestion("exact", "exact equations", 3, "the reference", 1e-10, ["it agrees <with itself>"])
    return SceneTrade(scene.name, scene.title, scene.digest(), 2, [question], mark_pareto_fronts(entries, 2), MADE)


def known_benchmarks() -> benchmarks.Benchmarks:
    """One number, which the engine does not answer."""
    numbers = {
        "equations": benchmarks.SideNumber(2.02423, 2e-8, "met"),
        "smoothed": benchmarks.SideNumber(2.02425, 3e-8, "met"),
        "engine": benchmarks.SideNumber(None, None, "not compared"),
    }
    rows = [benchmarks.PublishedNumber("isolation period", "s", 2.0242, 5e-5, numbers)]
    about = "frame", "a <frame>", "a book", "links", 1e-4, "theirs is heated"
    return benchmarks.Benchmarks([benchmarks.Benchmark(*about, rows, {"engine": "it broke"}, {"engine": 1.0})], MADE)


def known_growth() -> growth.MeasuredGrowth:
    """One series without a value."""
    series = [
        growth.make_cost_series("bodies", "", "engine", (2.0, 4.0, 8.0), (1.0, 4.0, 16.0)),
        growth.make_cost_series("bodies", "", "slow engine", (2.0, 4.0, 8.0), (1.0, float("nan"), 16.0)),
        growth.make_cost_series("workers", "", "equations", (1.0, 2.0), (2.0, 1.5)),
    ]
    return growth.MeasuredGrowth(growth.SCHEMA, "fig3-I", "a scene", series, MADE)


def known_ensemble() -> ensemble.EnsembleResult:
    """Displacements of three motions at two scales: the third reaches the rim at the larger one."""
    known = {"motion 1": (0.1, 0.2), "motion 2": (0.2, 0.5), "motion 3": (0.3, None)}
    curves = [
        ensemble.DemandCurve(
            "tower", "displacement", None, "exact", motion, (1.0, 2.0), values, (0.0, 0.0 if values[1] else None)
        )
        for motion, values in known.items()
    ]
    engine = ensemble.DemandCurve("tower", "displacement", None, "translational", "motion 2", (2.0,), (0.51,), (1e-3,))
    low, high = (
        [
            ensemble.DemandFractile(value, None if value is None else 0.0, share)
            for share, value in zip((0.16, 0.5, 0.84), values)
        ]
        for values in ((0.132, 0.2, 0.268), (0.296, 0.5, None))
    )
    mean, largest, smallest = (ensemble.Statistic(value, 0.0) for value in (0.21, 0.3, 0.1))
    none, named = ensemble.Statistic(None, None), ("tower", "displacement", None, "exact", "m")
    stripes = [ensemble.DemandAtScale(*named, 1.0, 3, mean, low, largest, smallest),
               ensemble.DemandAtScale(*named, 2.0, 2, none, high, none, ensemble.Statistic(0.2, 1e-3))]  # fmt: skip
    spectrum = ensemble.FloorSpectrumStatistics(
        "tower", 1, 2.0, 0.05, (0.1, 1.0), (mean,) * 2, [(mean,) * 2] * 3, (largest,) * 2
    )
    moved = ensemble.ChosenMotion("tower", "motion 2", 2.0, ["largest displacement"], {"translational": "ok"})
    return ensemble.EnsembleResult(
        schema=ensemble.SCHEMA, structures=[ensemble.Structure("tower", "Tower & <town>", 1, 9.81e3)],
        scales=(1.0, 2.0), spectra=[spectrum],
        motions=3, outcomes={"ok": 5, "rim reached": 1}, stripes=stripes, curves=[*curves, engine],
        engine=ensemble.EngineMotions("translational", [moved]), run=MADE,
        suite=[ensemble.GroundMotion(motion, 20.0, 1.5) for motion in known],
    )  # fmt: skip


FILES: Mapping[str, bytes] = {
    extremes.FILE: extremes.STORED.as_json(FOUND),
    benchmarks.TABLE_FILE: benchmarks.STORED.as_json(known_benchmarks()),
    growth.FILE: growth.STORED.as_json(known_growth()),
    validation.STORED.name: validation.STORED.as_json(replace(validation.load_record(), facts=["a <fact>"])),
}


def leave_beside(place: Path, files: Mapping[str, bytes], *scenes: str) -> None:
    """What other commands leave beside a report: these files, and a known trade-off of every scene."""
    publish_files(place, files, "a test")
    for name in scenes:
        trade = MeasuredTrade(known_trade(name), xr.Dataset({"mu": ("point", [1.0])}))
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(tradeoff, "measure_trades", lambda *rest, trade=trade: [trade])
            assert tradeoff.main([name, "--out", str(place)]) == 0
