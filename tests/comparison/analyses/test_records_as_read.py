"""Recorded motions stand on the page and in summary.json as they were read, each once."""

from dataclasses import replace
from types import SimpleNamespace

import pytest
from report_texts import Tables

from comparison.analyses.records.feature import FEATURE, list_recorded_motions, word_warnings
from comparison.report.page import _make_template_environment
from comparison.study.records import describe_records
from reference.problem import GRAVITY, Scene, load_scene

SCENE = """
title = "Block"
[isolator]
radius = 2.0
friction = 0.05
[[bodies]]
mass = 3.0
[excitation]
record = {{file = "{name}"}}
scale = {scale}
"""


def scene_of(folder, scale: float = 1.0, offset: float = 0.02) -> Scene:
    """A scene under a record of 301 samples: a peak of 1.52 m/s^2 along x with a zero line of `offset`."""
    samples = [1.5 if number == 100 else -1.5 if number == 103 else 0.0 for number in range(301)]
    lines = [f"{0.01 * number!r},{value + offset!r},{0.5 * value!r}" for number, value in enumerate(samples)]
    (folder / "motion.csv").write_text("\n".join(["t [s],x [m/s^2],y [m/s^2]", *lines]))
    (folder / "scene.toml").write_text(SCENE.format(name="motion.csv", scale=scale))
    return load_scene(folder / "scene.toml")


def test_every_record_is_told_once_and_its_scale_where_the_scenes_agree(tmp_path) -> None:
    scene = scene_of(tmp_path, 2.0)
    (one,) = describe_records([scene, scene, load_scene("fig3-I")])
    assert (one.scale, one.samples) == (2.0, 301)
    (several,) = describe_records([scene, scene_of(tmp_path, 3.0)])
    assert several.scale == 1.0
    for name, offset in (("a", 0.02), ("b", 0.03)):
        (tmp_path / name).mkdir()
        scene_of(tmp_path / name, offset=offset)
    alike, other = (load_scene(tmp_path / name / "scene.toml") for name in "ab")  # files of one name in two folders
    listed = describe_records([scene, alike, other, scene.with_values({"excitation.detrend": "mean"})])
    assert [record.detrend for record in listed] == [None, None, "mean"]
    assert ["mean of +0.03 m/s^2" in "".join(record.warnings) for record in listed] == [False, True, False]
    findings = SimpleNamespace(study=SimpleNamespace(scenes=[load_scene("fig3-I")]))
    assert list_recorded_motions(findings, []) is None  # type: ignore[arg-type]


def test_the_table_has_what_was_read_below_its_heads_and_every_warning(tmp_path) -> None:
    findings = SimpleNamespace(study=SimpleNamespace(scenes=[scene_of(tmp_path, 2.0)]))
    records = list_recorded_motions(findings, [])  # type: ignore[arg-type]
    assert records is not None
    text = (
        _make_template_environment()
        .get_template("records/section.html.j2")
        .render(results=SimpleNamespace(records=records), gravity=GRAVITY)
    )
    x, y = Tables(text).rows(0)
    assert (x["motion"], x["samples"], x["step, s"], x["duration, s"]) == ("motion.csv", "301", "0.01", "3")
    assert (x["times"], x["detrend"], x["direction"], y["direction"]) == ("2", "none", "x", "y")
    assert (x["peak, m/s²"], x["peak, g"], y["peak, m/s²"]) == ("1.52", "0.1549", "0.75")
    assert float(x["mean/peak"]) == pytest.approx(0.02 / 1.52, rel=0.05)
    assert (x["final velocity, m/s"], x["final displacement, m"]) == ("+0.06", "+0.09")
    assert "Warning:</strong> x ends at +0.06 m/s with a mean of +0.02 m/s^2" in text
    assert word_warnings(records) == "1 motion read, 1 with a warning"
    twice = replace(records[0], warnings=("a", "b"))
    assert word_warnings([twice, replace(records[0], warnings=())]) == "2 motions read, 1 with a warning"
    assert word_warnings([replace(records[0], warnings=())]) == "1 motion read, no warning"
    assert FEATURE.section is not None
    verdict = FEATURE.section.verdict
    assert verdict is not None
    assert verdict(SimpleNamespace(records=records)) == "1 motion read, 1 with a warning"  # type: ignore[arg-type]
