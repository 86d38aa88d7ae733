"""Statistics of a study of pairwise different numbers, made of its surfaces with NumPy: a swap of two fails."""

import json
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import reading_table
from distinct_models import (
    CHAIN,
    COARSE,
    GRID,
    KEYS,
    STEPS,
    Array,
    differences_of,
    distinct_hierarchy,
    first_mu,
    grid_phases,
)
from known_analyses import analyses_are
from places import limited_scene
from report_texts import summary_of
from runs import RUN, quick_figures
from studies import solved

from comparison.analyses.worst_phases.analysis import LargestOverPhases
from comparison.registry import make_report
from comparison.report import page_data
from comparison.report.page_data import collect_page_data, find_crossings
from comparison.run import main
from comparison.study.models import label_of
from comparison.study.study import Study
from comparison.surfaces.budget import TOTAL
from reference.problem import load_scene

FEWER = ("translational", "spatial")  # models on COARSE phases
FRACTILES = 0.05, 0.16, 0.5, 0.84, 0.95


def phases_of(*keys: str) -> Array:
    return grid_phases(COARSE if {*keys} & {*FEWER} else GRID)


def level(key: str, body: int, phases: Array) -> Array:
    """mu over that of the first model of the chain."""
    mu, base = (1.0 + differences_of(each, body, phases) for each in (key, CHAIN[0]))
    return np.asarray(mu / base)


def mu_of(key: str, body: int, phases: Array) -> Array:
    return np.asarray(first_mu(body, phases) * (1.0 + differences_of(key, body, phases)))


def u_d(first: str, second: str, body: int, phases: Array) -> Array:
    """The errors of both models together, over mu of the first model of the chain."""
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
    assert reading_table.main(folder / "report", COARSE) == 0, "by a program that imports nothing of the project"
    [found] = summary_of(folder / "report")["scenes"]
    lists = {
        name: rows
        for name, rows in found.items()
        if isinstance(rows, list) and all(isinstance(row, dict) for row in rows)
    }
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
    assert list(entries) == [*CHAIN[1:], TOTAL]
    for (first, second), entry in zip([*pairwise(CHAIN), (CHAIN[0], CHAIN[-1])], entries.values()):
        phases = phases_of(first, second)
        both = [level(key, body, phases) for key in (first, second)]
        error, size = u_d(first, second, body, phases), np.abs(both[1] - both[0])
        agrees(entry, statistics(size, phases))
        more = {
            "rms": np.sqrt((size**2).mean()), "error_estimate": np.median(error), "points": len(size),
            "resolved": (size > 5.0 * error).mean(), "unresolved": ((size > error) & (size <= 5.0 * error)).mean(),
            "correlation": np.corrcoef(*(mu_of(key, body, phases) for key in (first, second)))[0, 1],
        }  # fmt: skip
        agrees(entry, more)


def test_every_statistic_of_a_difference_is_that_of_its_pair(scene: dict[str, Any]) -> None:
    body, rows = scene["number"], {row["pair"]: row for row in scene["differences"]}
    pairs = {"total": (CHAIN[0], "spatial"), "translational": (CHAIN[0], "translational")}
    pairs["like-for-like"] = "regularised", "translational"
    assert {row["pair"]: (row["first"], row["second"]) for row in scene["differences"]} == pairs
    phases, found = grid_phases(COARSE), {}
    for pair, (first, second) in pairs.items():
        one, other = (level(key, body, phases) for key in (first, second))
        signed, error = other / one - 1.0, u_d(first, second, body, phases) / one
        agrees(rows[pair], statistics(np.abs(signed), phases))
        more = {
            "mean": signed.mean(), "spread": signed.std(), "ratio": (np.abs(signed) / error).max(),
            "beyond_error": (np.abs(signed) > error).mean(), "numerical_error": error.mean(),
            "not_ok": 0, "unanswered": 0,
        }  # fmt: skip
        agrees(rows[pair], more)
        found[pair] = {**statistics(np.abs(signed), phases), **more}
        digits = {f"{abs(number):.2g}" for name, number in found[pair].items() if isinstance(number, float)}
        assert len(digits) == 8, "no two are written alike"
    limits = {limit["key"]: [breach["found"] for breach in limit["breaches"]] for limit in scene["limits"]}
    alike, total = found["like-for-like"], found["total"]["maximum"]
    for key, number in {
        **{name: alike[name] for name in ("median", "maximum", "ratio")},
        "total.maximum": total,
    }.items():
        assert limits[key][body - 1] == pytest.approx(number, rel=1e-9), key


def test_bars_and_headline_are_means_on_the_finest_grid_of_their_models(scene: dict[str, Any]) -> None:
    body, phases = scene["number"], grid_phases(COARSE)
    [waterfall], [headline] = scene["waterfalls"], scene["headlines"]
    sizes = {}
    for (first, second), bar in zip(pairwise(CHAIN), waterfall["bars"]):
        both = phases_of(first, second)
        sizes[second] = (level(second, body, both) - level(first, body, both)).mean()
        agrees(bar, {"model": second, "size": sizes[second]})
    signed = level("spatial", body, phases) - 1.0
    agrees(waterfall["total"], {"size": signed.mean()})
    agrees(waterfall["bars"][-1], {"model": "phases", "size": signed.mean() - sum(sizes.values()), "resolved": False})
    agrees(headline, {"mean": signed.mean(), "spread": signed.std(), "points": COARSE**2, "phases_per_axis": COARSE})
    for name, place in (("low", signed.argmin()), ("high", signed.argmax())):
        agrees(headline, {name: signed[place]})
        assert headline[f"{name}_phases"] == pytest.approx(phases[place].tolist())
    for effect in headline["effects"]:
        agrees(effect, {"mean": sizes[effect["model"]]})
        if headline["resolved"]:
            agrees(effect, {"share": sizes[effect["model"]] / signed.mean()})
    named = [e["effect"] for e in headline["effects"] if e["resolved"] and abs(e["mean"]) > 0.2 * abs(signed.mean())]
    assert set(headline["causes"]) == (set(named) if headline["resolved"] else set())
    of_engines = {key: level(key, body, phases) - 1.0 for key in FEWER}
    model = max(of_engines, key=lambda key: float(np.abs(of_engines[key]).max()))
    place = np.abs(of_engines[model]).argmax()
    agrees(headline, {"maximum": of_engines[model][place], "maximum_model": model})
    assert headline["maximum_phases"] == pytest.approx(phases[place].tolist())
    assert waterfall["largest"]["total"]["size"] == headline["maximum"]


# key of the pair: its models, and its base
EFFECTS = {
    "geometry": ("small-resolved", "resolved", "small-resolved"),
    "regularized-friction": ("resolved", "regularised", "small-resolved"),
    "elastic-contact": ("regularised", "translational", "small-resolved"),
    "turning-of-the-bodies": ("translational", "spatial", "small-resolved"),
    "geometry-supremum": ("small", "exact", "small"),
    "geometry-regularized": ("small-regularised", "regularised", "small-resolved"),
    "regularized-friction-small": ("small-resolved", "small-regularised", "small-resolved"),
    "supremum": ("small-resolved", "small", "small-resolved"),
    "reading": ("small", "small-resolved", "small"),
    "supremum-total": ("small", "spatial", "small"),
}


def test_every_effect_has_its_models_base_reading_and_grids(scene: dict[str, Any]) -> None:
    body, rows = scene["number"], {row["pair"]: row for row in scene["effects"]}
    assert {key: (row["first"], row["second"], row["base"]) for key, row in rows.items()} == EFFECTS
    literal = {"small", "exact"}
    for key, row in rows.items():
        first, second, base = EFFECTS[key]
        names = ["literal supremum" if each in literal else "as integrated" for each in (first, second)]
        assert row["reading"] == " to ".join(dict.fromkeys(names)), key
        for grid in row["grids"]:
            phases = grid_phases(grid["phases_per_axis"])
            size = (level(second, body, phases) - level(first, body, phases)) / level(base, body, phases)
            agrees(grid, {"mean": size.mean(), "maximum": np.abs(size).max()})
        assert row["grids"][-1]["phases_per_axis"] == row["phases_per_axis"]
        agrees(row, {"mean": row["grids"][-1]["mean"]})
    [headline] = scene["headlines"]
    agrees(headline, {"supremum_mean": rows["supremum"]["mean"], "supremum_maximum": rows["supremum"]["high"]})


@pytest.mark.parametrize("key", KEYS)
def test_largest_value_mean_and_fractiles_are_those_of_the_model(key: str, scene: dict[str, Any]) -> None:
    body, phases = scene["number"], phases_of(key)
    mu = mu_of(key, body, phases)
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
    agrees(
        scene["models"][key], {"cap_share": 0.011 * (1.0 + KEYS.index(key) + 0.3 * np.cos(phases[:, 0] - 0.7).max())}
    )
    assert (scene["models"][key]["outcomes"], scene["models"][key]["advice"]) == ({"ok": count**2}, {})


def test_the_page_draws_every_value_of_its_scene_model_and_body() -> None:
    """Two scenes, the second under a record; the engine stands at fewer phases, and one of a user at all of them."""
    hierarchy, ready = distinct_hierarchy(), {"phases": (1.5, 0.25), "kind": "smooth"}
    mine = replace(hierarchy[5], key="mine", title="mine", side="user", like="regularised", settings={"key": "exact"})
    scenes = load_scene("fig3-I"), load_scene("synthetic-pair")
    study = Study(scenes, GRID, 1e-3, (*hierarchy, mine))
    largest = [
        LargestOverPhases("fig3-I", key, "amplification", body, value, **ready)  # type: ignore[arg-type]
        for key, body, value in (("exact", 2, 7.5), ("exact", 1, 8.123456789), ("spatial", 2, 9.25))
    ]
    report = make_report(study, solved(study), {"worst_phases": largest}, [], RUN, families=())
    first, record = json.loads(collect_page_data(report))["scenes"]
    assert [(each["name"], each["recorded"], each["flat"], each["duration"]) for each in (first, record)] == [
        (scene.name, number == 1, False, scene.duration) for number, scene in enumerate(scenes)
    ]
    assert (first["title"], first["bodies"], [*first["models"]]) == (scenes[0].title, 2, [*KEYS, "mine"])
    assert first["labels"] == {model.key: label_of(model, scenes[0]) for model in study.hierarchy}
    refused = {"through": "regularised", "certificate": "", "difference": False, "mu": None,
               "reason": "no phase pairs were held out to check an interpolation"}  # fmt: skip
    for key, drawn in first["models"].items():
        values = "exact" if key == "mine" else key
        phases = phases_of(key)
        count, surface = round(len(phases) ** 0.5), key not in (*FEWER, "mine")
        assert (drawn["phases"], drawn["computed"], drawn["surface"]) == (count, count**2, surface), key
        mu = [mu_of(values, body, phases).reshape(count, count) for body in (1, 2)]
        np.testing.assert_allclose(drawn["mu"], mu, rtol=5e-7)
        assert (drawn["error"] is None) == surface
        if not surface:
            np.testing.assert_allclose(drawn["error"], STEPS[values][-1] * np.array(mu), rtol=0.05)
        assert drawn["completed"] == [refused if key in FEWER else None] * 2
    for key, drawn in record["models"].items():
        assert (drawn["phases"], drawn["surface"], np.shape(drawn["mu"])) == (1, False, (2, 1, 1)), key
    for key, marks in first["worst"].items():
        near = [8.123457, "exact"], [7.5, "exact"] if key in ("small", "exact") else [9.25, "spatial"]
        assert marks == [[1.5, 0.25, *each] for each in near], key
    assert {str(marks) for marks in record["worst"].values()} == {"[None, None]"}
    pairs = {pair["key"]: pair for pair in first["pairs"]}
    assert {key: (pair["first"], pair["second"], pair["user"]) for key, pair in pairs.items()} == {
        "mine": ("regularised", "mine", True), "total": (CHAIN[0], "spatial", False),
        "translational": (CHAIN[0], "translational", False), "like-for-like": ("regularised", "translational", False),
    }  # fmt: skip
    for pair in pairs.values():
        one, other = pair["first"], "exact" if pair["second"] == "mine" else pair["second"]
        shown = phases_of(pair["second"])
        count = round(len(shown) ** 0.5)
        both = [(u_d(one, other, body, shown) / level(one, body, shown)).reshape(count, count) for body in (1, 2)]
        np.testing.assert_allclose(pair["uncertainty"], both, rtol=0.05)
        assert pair["contours"] == [[], []]
    alone = Study(scenes[:1], GRID, 1e-3, hierarchy[:6])
    surfaces = solved(alone)
    surfaces["error"] *= 900.0  # 3 % of mu, so that the difference crosses it
    [scene] = json.loads(collect_page_data(make_report(alone, surfaces, {}, [], RUN, families=())))["scenes"]
    [pair] = scene["pairs"]
    axis, every = 2.0 * np.pi * np.arange(GRID) / GRID, grid_phases(GRID)
    one, other = CHAIN[0], "regularised"
    lines = [
        find_crossings(*((each / level(one, body, every)).reshape(GRID, GRID) for each in (
            level(other, body, every) - level(one, body, every), 900.0 * u_d(one, other, body, every)
        )), axis) for body in (1, 2)
    ]  # fmt: skip
    assert (pair["second"], pair["uncertainty"], pair["contours"]) == (other, None, lines)
    assert [len(each) > 0 for each in lines] == [True, False], "the bodies are told apart"
    last, own = alone.hierarchy[-1], alone.scenes[0].name
    nothing: dict[str, Any] = {"certificate": "", "reason": "", "accepted": False, "difference_accepted": False}
    unlike = [SimpleNamespace(scene=name, model=last.key, body=2, through=name, **nothing) for name in (own, "another")]
    told = replace(make_report(alone, surfaces, {}, [], RUN, families=()), completions=unlike)
    drawn = page_data._model_data(told, alone.scenes[0], last)
    assert [each and each["through"] for each in drawn["completed"]] == [None, own]
    coarse = replace(alone, hierarchy=[replace(m, most=COARSE) if m.key == CHAIN[0] else m for m in alone.hierarchy])
    [scene] = json.loads(collect_page_data(make_report(coarse, solved(coarse), {}, [], RUN, families=())))["scenes"]
    assert np.shape(scene["pairs"][0]["uncertainty"]) == (2, COARSE, COARSE), "the first is drawn as points"
