"""Statistics of a study of pairwise different numbers, made of its surfaces with NumPy: a swap of two fails."""

from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from distinct_models import COARSE, GRID, KEYS, STEPS, Array, differences_of, distinct_hierarchy, first_mu, grid_phases
from known_analyses import analyses_are
from places import limited_scene
from report_texts import summary_of
from runs import quick_figures

from comparison.run import main
from comparison.surfaces.budget import TOTAL

FEWER = ("translational", "spatial")  # models on COARSE phases
FRACTILES = 0.05, 0.16, 0.5, 0.84, 0.95


def phases_of(*keys: str) -> Array:
    return grid_phases(COARSE if {*keys} & {*FEWER} else GRID)


def level(key: str, body: int, phases: Array) -> Array:
    """mu over that of the first model."""
    return np.asarray(1.0 + differences_of(key, body, phases))


def u_d(first: str, second: str, body: int, phases: Array) -> Array:
    """The errors of both models together, over mu of the first of all models."""
    return np.asarray(np.hypot(*(STEPS[key][-1] * level(key, body, phases) for key in (first, second))))


@pytest.fixture(scope="module", params=[1, 2])
def scene(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """What summary.json says of one body: its rows, in lists by their names."""
    body, folder = request.param, tmp_path_factory.mktemp("limited")
    with pytest.MonkeyPatch.context() as patch:
        quick_figures(patch)
        analyses_are(patch, motions=[])
        limits = "[acceptance]\nmedian = 1e-6\nmaximum = 2e-6\nratio = 1.0\n[acceptance.total]\nmaximum = 3e-6\n"
        words = [limited_scene(folder, limits), "--grid", str(GRID), "--only", "differences,budget"]
        assert main([*words, "--out", str(folder / "report")], distinct_hierarchy(), ThreadPoolExecutor) == 0
    [found] = summary_of(folder / "report")["scenes"]
    lists = {name: rows for name, rows in found.items() if isinstance(rows, list) and name != "analyses"}
    of_body = {name: [row for row in rows if row.get("body", body) == body] for name, rows in lists.items()}
    return {**of_body, "number": body, "models": found["models"]}


def statistics(sizes: Array, phases: Array) -> dict[str, Any]:
    """Of absolute sizes."""
    return {
        "median": np.median(sizes), "maximum": sizes.max(), "percentile95": np.percentile(sizes, 95.0, method="hazen"),
        "phases": pytest.approx(phases[sizes.argmax()].tolist()), "asked": len(sizes),
    }  # fmt: skip


def agrees(found: dict[str, Any], expected: dict[str, Any]) -> None:
    for name, number in expected.items():
        assert found[name] == (pytest.approx(number, rel=1e-9) if isinstance(number, float) else number), name


def test_every_statistic_of_a_step_is_that_of_its_sizes(scene: dict[str, Any]) -> None:
    body, entries = scene["number"], {entry["step"]: entry for entry in scene["budget"]}
    assert list(entries) == [*KEYS[1:], TOTAL]
    for (first, second), entry in zip([*pairwise(KEYS), (KEYS[0], KEYS[-1])], entries.values()):
        phases = phases_of(first, second)
        both = [level(key, body, phases) for key in (first, second)]
        error, size = u_d(first, second, body, phases), np.abs(both[1] - both[0])
        agrees(entry, statistics(size, phases))
        more = {
            "rms": np.sqrt((size**2).mean()), "error_estimate": np.median(error), "points": len(size),
            "real": (size > 5.0 * error).mean(), "unresolved": ((size > error) & (size <= 5.0 * error)).mean(),
            "correlation": np.corrcoef(*(first_mu(body, phases) * each for each in both))[0, 1],
        }  # fmt: skip
        agrees(entry, more)


def test_every_statistic_of_a_difference_is_that_of_its_pair(scene: dict[str, Any]) -> None:
    body, rows = scene["number"], {row["pair"]: row for row in scene["differences"]}
    pairs = {"total": ("small", "spatial"), "translational": ("small", "translational")}
    pairs["like-for-like"] = "regularised", "translational"
    assert {row["pair"]: (row["first"], row["second"]) for row in scene["differences"]} == pairs
    phases, found = grid_phases(COARSE), {}
    for pair, (first, second) in pairs.items():
        one, other = (level(key, body, phases) for key in (first, second))
        signed, error = other / one - 1.0, u_d(first, second, body, phases) / one
        agrees(rows[pair], statistics(np.abs(signed), phases))
        more = {
            "mean": signed.mean(), "spread": signed.std(), "ratio": (np.abs(signed) / error).max(),
            "beyond_error": (np.abs(signed) > error).mean(), "not_ok": 0, "unanswered": 0,
        }  # fmt: skip
        agrees(rows[pair], more)
        found[pair] = {**statistics(np.abs(signed), phases), **more}
        digits = {f"{abs(number):.2g}" for name, number in found[pair].items() if isinstance(number, float)}
        assert len(digits) == 7, "no two are written alike"
    limits = {limit["key"]: [breach["found"] for breach in limit["breaches"]] for limit in scene["limits"]}
    alike, total = found["like-for-like"], found["total"]["maximum"]
    for key, number in {
        **{name: alike[name] for name in ("median", "maximum", "ratio")},
        "total.maximum": total,
    }.items():
        assert limits[key][body - 1] == pytest.approx(number, rel=1e-9), key


def test_bars_and_headline_are_means_that_add_up(scene: dict[str, Any]) -> None:
    body, phases = scene["number"], grid_phases(COARSE)
    [waterfall], [headline] = scene["waterfalls"], scene["headlines"]
    for (first, second), bar in zip(pairwise(KEYS), waterfall["bars"], strict=True):
        size, error = level(second, body, phases) - level(first, body, phases), u_d(first, second, body, phases)
        agrees(bar, {"model": second, "size": size.mean(), "error": error.mean()})
        assert bar["real"] == (abs(size.mean()) > 5.0 * error.mean())
    assert {bar["real"] for bar in waterfall["bars"]} == {True, False}
    signed = differences_of("spatial", body, phases)
    assert sum(bar["size"] for bar in waterfall["bars"]) == pytest.approx(signed.mean(), rel=1e-12)
    agrees(waterfall, {"spread": signed.std(), "points": COARSE**2})
    agrees(headline, {"mean": signed.mean(), "spread": signed.std(), "points": COARSE**2, "phases_per_axis": COARSE})
    direction = "less" if signed.mean() < 0.0 else "more"
    share = f"{100.0 * abs(signed.mean()):.2g} %"
    assert f"the engine gives {share} {direction} than the paper's equations (mean over 4 × 4" in headline["sentence"]
    assert f"standard deviation {100.0 * signed.std():.2g} %;" in headline["sentence"]
    of_engines = {key: differences_of(key, body, phases) for key in FEWER}
    model = max(of_engines, key=lambda key: float(np.abs(of_engines[key]).max()))
    place = np.abs(of_engines[model]).argmax()
    agrees(headline, {"maximum": of_engines[model][place], "maximum_model": model})
    assert headline["maximum_phases"] == pytest.approx(phases[place].tolist())
    assert waterfall["largest"]["total"]["size"] == headline["maximum"]


@pytest.mark.parametrize("key", KEYS)
def test_largest_value_mean_and_fractiles_are_those_of_the_model(key: str, scene: dict[str, Any]) -> None:
    body, phases = scene["number"], phases_of(key)
    mu = first_mu(body, phases) * level(key, body, phases)
    [largest] = [each for each in scene["grid_maxima"] if each["model"] == key]
    agrees(largest, {"mu": mu.max(), "error": STEPS[key][-1] * mu.max()})
    assert largest["phases"] == pytest.approx(phases[mu.argmax()].tolist())
    [spread] = [each for each in scene["distributions"] if each["model"] == key]
    agrees(spread["mean"], {"value": mu.mean()})
    for each, probability in zip(spread["fractiles"], FRACTILES, strict=True):
        agrees(each, {"probability": probability, "value": np.quantile(mu, probability, method="hazen")})
    assert spread["curve"] == pytest.approx(np.percentile(mu, np.linspace(1.0, 99.0, 50), method="hazen"))
    count = round(len(phases) ** 0.5)
    agrees(scene["models"][key], {"phases_per_axis": count, "points": count**2, "cost": 0.001 * count**2})
