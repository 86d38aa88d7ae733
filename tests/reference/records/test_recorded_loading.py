"""A scene with a recorded motion: its samples, what is between and behind them, and how it is refused."""

from itertools import product

import numpy as np
import pytest
from chains import refusal, scene_file
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.integrate import quad

from reference.problem import (
    Scene,
    SceneError,
    example_scenes,
    ground_acceleration,
    ground_displacement,
    ground_peak,
    ground_velocity,
    load_family,
    load_scene,
    loading_period,
)

CSV = "time [s],ax [m/s^2],ay [m/s^2]\n0,0.5,0\n0.1,1,-2\n0.3,-3,1\n0.4,2,4\n"
AT2 = "A\nB\nIN UNITS OF G\nNPTS= 3, DT= .0200 SEC\n 0.0 0.1 0.0\n"
KNOTS = [[0.0, 0.5, 0.0, 0.0], [0.1, 1.0, -2.0, 0.0], [0.3, -3.0, 1.0, 0.0], [0.4, 2.0, 4.0, 0.0], [0.5, 0, 0, 0]]
ANY = (0.0, 0.0)  # a record has no phases


@pytest.fixture
def folder(tmp_path):
    files = {"a.csv": CSV, "b.csv": CSV.replace("-3", "-6"), "x.AT2": AT2, "slow.AT2": AT2.replace("200 ", "2000005 ")}
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    return tmp_path


def written(folder, excitation: str):
    return scene_file(folder, excitation, "duration = 0.8\n")


def test_a_record_is_read_beside_its_scene_and_scaled(folder, monkeypatch):
    scene = load_scene(written(folder, 'record = "a.csv"'))
    assert (scene.record, scene.duration) == (pytest.approx(np.array(KNOTS)), 0.8)
    monkeypatch.chdir(folder)
    assert load_scene("mine.toml").record == pytest.approx(np.array(KNOTS))
    assert load_scene(scene_file(folder, 'record = "a.csv"')).duration == pytest.approx(0.4), "that of the record"
    upright = load_scene(written(folder, 'record = {z = "x.AT2"}\nscale = 2.0'))
    assert upright.record[:, 3] == pytest.approx([0.0, 2.0 * 0.981, 0.0])
    assert len(load_scene(written(folder, 'record = "synthetic-pair.csv"')).record) == 801, "a shipped one"
    uneven = {"time": [0.0, 0.1, 0.4], "acceleration": [1.0, 2.0, 3.0]}
    assert scene.with_values({"excitation.record": uneven}).record[-1].tolist() == pytest.approx([0.7, 0.0, 0.0, 0.0])
    (folder / "synthetic-pair.csv").write_text(CSV)
    assert len(load_scene(written(folder, 'record = "synthetic-pair.csv"')).record) == len(KNOTS), "one's own"
    (folder / "synthetic-pair").write_text(CSV)
    assert len(load_scene(written(folder, 'record = "synthetic-pair"')).record) == len(KNOTS), "one's own, too"


def test_acceleration_is_linear_between_samples_and_integrated_exactly(folder):
    """Velocity and displacement against quadrature that knows the knots, to its own 1e-13."""
    scene = load_scene(written(folder, 'record = "a.csv"'))
    time, knots = np.linspace(-0.2, 0.8, 41), np.array(KNOTS)
    expected = np.column_stack([np.interp(time, knots[:, 0], knots[:, k], left=0.0, right=0.0) for k in (1, 2, 3)])
    assert ground_acceleration(scene, (1.0, 2.0), time) == pytest.approx(expected, abs=1e-14)
    for end, axis in product([0.05, 0.1, 0.37, 0.47, 0.8], range(2)):

        def integral(weight, end=end, axis=axis):
            inside = [t for t, *_ in KNOTS if 0.0 < t < end]
            return quad(lambda t: weight(t) * ground_acceleration(scene, ANY, [t])[0, axis], 0.0, end, points=inside)[0]

        gained, covered = integral(lambda t: 1.0), integral(lambda t, end=end: end - t)
        assert ground_velocity(scene, ANY, [end])[0, axis] == pytest.approx(gained, abs=1e-13)
        assert ground_displacement(scene, ANY, [end])[0, axis] == pytest.approx(covered, abs=1e-13)


@pytest.mark.parametrize("integral", [ground_velocity, ground_displacement, ground_acceleration])
def test_instants_that_are_none_are_refused_for_a_record_as_well(folder, integral):
    scene = load_scene(written(folder, 'record = "a.csv"'))
    for time in ([0.1, np.nan], np.ma.masked_array([0.1, 0.2], mask=[False, True])):
        assert "time" in str(refusal(integral, scene, ANY, time))


@given(arrays(float, (6, 3), elements=st.floats(-5.0, 5.0)), st.floats(0.05, 1.2))
def test_the_peak_is_at_a_knot_or_at_the_end(values, duration):
    """No dense sampling finds more, and it finds as much to the spacing times the largest rate."""
    table = {
        "title": "record",
        "duration": duration,
        "isolator": {"period": 1.0, "friction": 0.1},
        "bodies": [{"mass": 1.0}],
        "excitation": {"record": "x.csv", "samples": np.column_stack([0.2 * np.arange(6), values]).tolist()},
    }
    scene = Scene.model_validate(table)
    dense = np.linalg.norm(ground_acceleration(scene, ANY, np.linspace(0.0, duration, 2001)), axis=1).max()
    (peak,) = ground_peak(scene, [ANY])
    assert dense <= peak * (1.0 + 1e-12)
    assert dense >= peak - duration / 2000 * 10.0 * np.sqrt(3.0) / 0.2


def test_the_amplitude_is_the_largest_sample_and_the_hash_that_of_the_samples(folder):
    scene = load_scene(written(folder, 'record = "a.csv"'), amplitude=8.0)
    assert np.abs(scene.record[:, 1:]).max() == pytest.approx(8.0, rel=1e-15)
    assert loading_period(scene) == pytest.approx(2.0 * np.pi * 4.0 / 50.0)
    (folder / "copy.csv").write_text("# another name\n" + CSV)
    one, same, other = (load_scene(written(folder, f'record = "{name}.csv"')) for name in ("a", "copy", "b"))
    assert one.digest() == same.digest() != other.digest()


@pytest.mark.parametrize(
    ("excitation", "key", "said"),
    [
        ('record = "none.csv"', "excitation.record", "No such file or directory; paths are relative to the scene file"),
        ('record = "a.txt"', "excitation.record", "No such file or directory"),
        ("record = 3", "excitation.record", "must be a file"),
        ('record = {w = "x.AT2"}', "excitation.record", "must be a file"),
        ('record = {x = "x.AT2", y = {step = 0.1}}', "excitation.record.y", "must be a file"),
        ('record = {file = "a.csv", column = 1, stp = 0.1}', "excitation.record.stp", "did you mean step?"),
        ('record = "a.csv"\norigin = []', "excitation.origin", "unknown key"),
        ('record = "a.csv"\ndetrend = "median"', "excitation.detrend", "must be 'mean' or 'linear'"),
        ('record = {x = "x.AT2", y = "gone.AT2"}', "excitation.record.y", "No such file or directory"),
        ('record = {x = "x.AT2", y = "slow.AT2"}', "excitation.record", "DT = 0.02 s along x and 0.02000005 s"),
        ('record = {x = "x.AT2", w = "x.AT2"}', "excitation.record", "must be a file"),
        ('record = "a.csv"\nsamples = [[0.0, 0.0, 0.0, 0.0]]', "excitation.samples", "unknown key"),
        ('record = "a.csv"\nscale = 1e308', "excitation.scale", "must leave every acceleration finite"),
        ('record = "a.csv"\nscale = 0.0', "excitation.scale", "greater than 0"),
        ("scale = 2.0", "excitation.amplitudes", "required"),
    ],
)
def test_a_wrong_record_is_refused_in_one_line(folder, excitation, key, said):
    line = refusal(load_scene, written(folder, excitation), kind=SceneError)
    assert line.key == key
    assert said in line.rule


def test_families_run_over_records_and_over_scales(folder):
    files = load_family(written(folder, 'record = {values = ["a.csv", "b.csv"]}'))
    assert [scene.name for scene in files.scenes] == ["mine[record=a]", "mine[record=b]"]
    assert [float(scene.record[2, 1]) for scene in files.scenes] == [-3.0, -6.0]
    tables = load_family(written(folder, 'record = {values = [{x = "x.AT2"}, {x = "x.AT2", y = "x.AT2"}]}'))
    assert tables.values == ("x", "x+x")
    scales = load_family(written(folder, 'record = "a.csv"\nscale = {range = [0.5, 2.0], steps = 4}'))
    assert [float(scene.record[1, 1]) for scene in scales.scenes] == [0.5, 1.0, 1.5, 2.0]


def test_examples_are_reached_by_name_and_none_of_the_paper_s(folder, monkeypatch):
    monkeypatch.chdir(folder)
    (folder / "synthetic-pair.csv").write_text(CSV)  # a file of that name elsewhere changes nothing
    pair, triple = map(load_scene, example_scenes())
    assert (len(pair.record), len(triple.record), triple.record[:, 3].any()) == (801, 601, True)
