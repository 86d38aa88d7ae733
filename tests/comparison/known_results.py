"""Known results of extremes and of a trade-off, and columns whose models fail in known ways."""

from dataclasses import replace

from comparison.analyses.extremes.matrix import Entry, Extreme, Matrix
from comparison.analyses.extremes.rows import Column, Row, scene
from comparison.analyses.tradeoff.trade import Answered, Trade, with_pareto_fronts
from comparison.analyses.tradeoff.trade import Entry as Setting
from reference.problem import load_scene

MADE = {"command": "made <by a test>", "began": "then", "seconds": 1.0, "compute_seconds": 1.0, "jobs": 1,
        "quick": True, "provenance": {"commit": "abc", "processor": "one"}}  # fmt: skip
PLAIN = Row("anything", "plain", scene(), ("fake",))
FOUND = Matrix(
    {"small": "small equations", "spatial": "spatial engine"},
    [
        Extreme("friction", "1e-9", {"small": Entry("converged", "error 2e-07 confirmed", "ok", 2e-7, 0.25, 0.5)}),
        Extreme("friction", "10", {"spatial": Entry("limit", "step limit", "step limit", None, 0.25, 0.5)}),
        Extreme("rho, m", "1e3", {"small": Entry("FAILED", "hangs: <forever>", "time limit", None, None, None)}),
    ],
    {"command": "made by a test", "began": "then", "seconds": 1.0, "cpu_seconds": 2.0, "jobs": 1, "limit": 90.0,
     "reduced": False, "provenance": {"commit": "abc"}},
)  # fmt: skip


def fake(model: str, finer: str = "") -> Column:
    """A column whose model, and the finer one that confirms it, are from extreme_models."""
    path = f"extreme_models:{model}"
    return Column("fake", model, path, {}, 1e-3, ((f"extreme_models:{finer or model}", {}, 1e-5),))


def known_trade(name: str) -> Trade:
    """Two settings of one method, the second of which is dearer and worse."""
    scene, nothing = load_scene(name), (None, None)
    one = Setting("exact", "reference, one run", "tolerance inside a step", "", 1e-3, False, False, 3, 3, 0.002,
                (1e-9, 2e-9), (3e-8, 4e-8), nothing, 0.1)  # fmt: skip
    entries = [one, replace(one, value=1e-2, seconds=0.003, most=(1e-3, 1e-3), error_message="<b>")]
    question = Answered("exact", "exact equations", 3, "the reference", 1e-10, ["it agrees <with itself>"])
    return Trade(scene.name, scene.title, scene.digest(), 2, [question], with_pareto_fronts(entries, 2), MADE)
