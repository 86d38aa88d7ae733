"""What is said of a record that was read, and how a wrong unit, a zero line and a swapped direction show in it."""

import numpy as np
import pytest
from chains import refusal, scene_file
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import cumulative_trapezoid
from scipy.signal import detrend

import reference
from reference.problem import GRAVITY, SceneError, describe_record, ground_displacement, ground_velocity, load_scene
from reference.records.description import describe_samples
from reference.records.samples import subtract_zero_line

TIME = 0.01 * np.arange(2000)
SHAKING = np.exp(-(((TIME - 8.0) / 3.0) ** 2)) * np.sin(9.0 * TIME)
SHAKING -= SHAKING.mean()


def samples(x, y=0.0, z=0.0, time=TIME):
    return np.column_stack(np.broadcast_arrays(time, x, y, z))


def csv(values, unit="m/s^2", time=TIME):
    return f"time [s],ax [{unit}]\n" + "\n".join(f"{t:.2f},{v:.6f}" for t, v in zip(time, values))


def test_size_peaks_and_ends_are_those_of_the_samples():
    time = TIME + np.where(TIME > 0.0, 0.05, 0.0)  # the first step is longer than the others
    values = samples(2.0 * SHAKING - 0.01, SHAKING, 3.0 * SHAKING, time)
    read = describe_samples("a.csv", ["a.csv, CSV"], values, 1.5)
    assert (read.samples, read.step, read.duration) == (2000, pytest.approx(0.01), pytest.approx(20.04))
    assert "".join(one.axis for one in read.directions) == "xyz"
    along = read.directions[0]
    velocity = cumulative_trapezoid(2.0 * SHAKING - 0.01, time, initial=0.0)
    assert along.peak == np.abs(2.0 * SHAKING - 0.01).max() == pytest.approx(read.largest_peak / 1.5)
    assert along.mean == pytest.approx(-0.01, rel=1e-12)
    assert along.mean_over_peak == pytest.approx(-0.01 / along.peak)
    assert along.peak_velocity == pytest.approx(np.abs(velocity).max())
    assert along.final_velocity == pytest.approx(velocity[-1], rel=1e-12)
    assert along.final_displacement == pytest.approx(cumulative_trapezoid(velocity, time)[-1], rel=1e-4)
    text = str(read)
    assert text.startswith("Record a.csv: 2000 samples, step 0.01 s, 20.04 s, times 1.5\n  a.csv, CSV\n")
    peaks = [np.abs(column).max() / GRAVITY for column in values[:, 1:].T]
    assert (
        f"  x: peak {along.peak:.4g} m/s^2 = {peaks[0]:.4g} g, mean/peak {-0.01 / along.peak:+.2g}, final velocity "
        f"{velocity[-1]:+.2g} m/s, final displacement {along.final_displacement:+.2g} m\n"
    ) in text
    assert read.short_lines[0].endswith(", peaks x {:.3g} g, y {:.3g} g, z {:.3g} g".format(*peaks))


@given(st.lists(st.tuples(st.floats(1e-3, 1.0), st.floats(-5.0, 5.0)), min_size=2, max_size=20))
def test_the_final_displacement_is_that_of_the_ground(rows):
    """Of a motion that is linear between its samples."""
    time = np.cumsum([step for step, _ in rows])
    scene = reference.Scene.model_validate(
        {
            "title": "x",
            "isolator": {"radius": 2.0, "friction": 0.1},
            "bodies": [{"mass": 1.0}],
            "excitation": {"record": {"time": time, "acceleration": [value for _, value in rows]}},
        }
    )
    end = scene.excitation.samples[-1, 0]
    for one in describe_record(scene).directions:
        assert one.final_velocity == pytest.approx(ground_velocity(scene, (0.0, 0.0), [end])[0, 0], abs=1e-12)
        assert one.final_displacement == pytest.approx(ground_displacement(scene, (0.0, 0.0), [end])[0, 0], abs=1e-12)


RUNS = SHAKING.copy()
RUNS[[*range(900, 904), *range(920, 926), 950, 960]] = [2.0] * 4 + [-2.0] * 6 + [2.0] * 2
CLIPPED = np.clip(SHAKING, -0.5, 0.5)
UNEVEN = TIME + np.where(np.arange(2000) % 2, 0.002, 0.0)
WARNED = {
    "as it should be": (samples(SHAKING), ()),
    "noise": (samples(SHAKING + np.random.default_rng(1).normal(0.0, 0.01, 2000)), ()),
    "a zero line": (samples(SHAKING - 0.08), ("x ends at -1.6 m/s with a mean of -0.08 m/s^2 (7.4 % of its peak)",)),
    "a small zero line": (samples(SHAKING, SHAKING + 0.01), ("y ends at +0.2 m/s with a mean of +0.01 m/s^2",)),
    "one direction much smaller": (samples(SHAKING, 0.005 * SHAKING), ()),
    "g for m/s^2": (samples(SHAKING, GRAVITY**2 * SHAKING), ("the peak is 9.779 g, above 3 g: is the unit right?",)),
    "g called m/s^2": (
        samples(0.03 * SHAKING),
        (
            "the peak is 0.003048 g, below 0.005 g: values in g that are called m/s^2? Write [g] in the head of the "
            'file, or unit = "g" beside a plain text',
        ),
    ),
    "nothing at all": (samples(0.0), ("the peak is 0 g, below 0.005 g",)),
    "unequal steps": (samples(SHAKING, time=UNEVEN), ("the steps are not equal: 0.008 to 0.012 s",)),
    "clipped": (samples(CLIPPED - CLIPPED.mean()), ()),
    "clipped twice": (samples(0.0, RUNS), ("y stays at its peak of 2 m/s^2 for 6 samples: clipped?",)),
    "few samples": (samples(SHAKING + 0.1)[:50], ()),
}


@pytest.mark.parametrize("case", WARNED)
def test_a_line_warns_of_what_is_hardly_meant(case):
    given_samples, said = WARNED[case]
    warnings = describe_samples("a.csv", [], given_samples).warnings
    if case == "clipped":
        assert len(warnings) == 1
        assert warnings[0].startswith("x stays at its peak of 0.5")
        assert warnings[0].endswith("samples: clipped?")
    else:
        assert len(warnings) == len(said)
        for line, start in zip(warnings, said):
            assert line.startswith(start)


def test_a_line_warns_from_its_limit_on():
    """Of the final velocity, the samples, a run of them at the peak, and the steps."""
    velocity = cumulative_trapezoid(SHAKING, TIME, initial=0.0)
    strayed = np.abs(velocity - velocity[-1] * TIME / TIME[-1]).max()
    for share, count in ((0.19, 0), (0.21, 1)):
        offset = (share * strayed - velocity[-1]) / TIME[-1]
        assert len(describe_samples("a", [], samples(SHAKING + offset)).warnings) == count
    for length, count in ((99, 0), (100, 1)):
        assert len(describe_samples("a", [], samples(SHAKING + 0.1)[:length]).warnings) == count
    for run, below, count in ((3, 0.0, 0), (4, 1e-12, 1), (4, 1e-6, 0)):
        values = SHAKING.copy()
        values[900 : 900 + run] = [2.0] + [2.0 - below] * (run - 1)
        assert len(describe_samples("a", [], samples(values), 1.0, "mean").warnings) == count
    for late, count in ((0.44e-4, 0), (0.56e-4, 1)):
        uneven = samples(SHAKING, time=TIME + np.where(np.arange(2000) % 2, late, 0.0))
        assert len(describe_samples("a", [], uneven).warnings) == count


def test_the_zero_line_is_taken_off_when_asked_for(tmp_path):
    drifting = SHAKING + 0.08 + 0.003 * TIME
    (tmp_path / "a.csv").write_text(csv(drifting))
    plain, mean, linear = (
        load_scene(scene_file(tmp_path, f'record = "a.csv"\nscale = 2.0\n{line}'))
        for line in ("", 'detrend = "mean"', 'detrend = "linear"')
    )
    values = plain.excitation.samples[:, 1]
    np.testing.assert_allclose(mean.record[:2000, 1], 2.0 * detrend(values, type="constant"), atol=1e-14)
    np.testing.assert_allclose(linear.record[:2000, 1], 2.0 * detrend(values, type="linear"), atol=1e-13)
    assert not mean.record[:, 2:].any()
    assert (plain.record[:2000, 1] == 2.0 * values).all()
    assert plain.digest() != mean.digest() != linear.digest()
    assert plain.with_values({"excitation.detrend": "mean"}).digest() == mean.digest()
    assert [len(describe_record(scene).warnings) for scene in (plain, mean, linear)] == [1, 0, 0]
    line = samples(3.0 + 0.2 * TIME**2, time=TIME**2)
    subtract_zero_line(line, "linear")
    assert np.abs(line[:, 1]).max() < 1e-9, "at unequal steps, too"
    every = np.column_stack([TIME, 0.3 + SHAKING, 0.2 - SHAKING, 0.1 + SHAKING])
    subtract_zero_line(every, "mean")
    np.testing.assert_allclose(every[:, 1:].mean(axis=0), 0.0, atol=1e-14)
    assert 'times 2, detrend = "mean"' in str(describe_record(mean))


def test_where_samples_are_from_is_said_and_changes_no_result(tmp_path):
    (tmp_path / "a.csv").write_text("Time,Acc(g),Vel\n0,0.1,7\n0.01,0.2,7\n0.02,0,7\n")
    (tmp_path / "b.csv").write_text("time [s],ax [g]\n0,0.1\n0.01,0.2\n0.02,0\n")
    first, second = (load_scene(scene_file(tmp_path, f'record = "{name}.csv"')) for name in "ab")
    assert first.excitation.origin == ["x: a.csv, CSV", "a.csv: columns that are not needed: 'Vel'"]
    assert second.excitation.origin == ["b.csv, CSV"]
    both = load_scene(scene_file(tmp_path, 'record = {x = "b.csv", y = "a.csv"}'))
    assert both.excitation.origin == ["x: b.csv, CSV", "y: a.csv, CSV", first.excitation.origin[1]]
    assert first.digest() == second.digest()
    anew = first.with_values({"excitation.record": {"file": str(tmp_path / "b.csv")}})
    assert anew.excitation.origin == ["b.csv, CSV"]
    assert reference.Scene.model_validate(first.model_dump(exclude_none=True)) == first
    assert "no record" in str(refusal(describe_record, load_scene("fig3-I")))


def test_directions_of_files_are_said(tmp_path):
    """Whoever exchanges two of them sees it."""
    for name, number in (("a_NS", 1.0), ("a_EW", 2.0)):
        (tmp_path / f"{name}.AT2").write_text(
            f"PEER\nX\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= 2, DT= .0100 SEC\n{number} 0.0\n"
        )
    swapped = load_scene(scene_file(tmp_path, 'record = {x = "a_NS.AT2", y = "a_EW.AT2"}'))
    assert swapped.excitation.origin == ["x: a_NS.AT2, PEER .AT2", "y: a_EW.AT2, PEER .AT2"]
    (tmp_path / "a.csv").write_text("Time,NS(gal),EW(gal)\n0,1,2\n1,3,4\n")
    assert load_scene(scene_file(tmp_path, 'record = "a.csv"')).excitation.origin == ["a.csv, CSV, x = EW, y = NS"]


PLAIN = "dt = 0.01\n0.1\n0.2\n0.3\n0.4\n"


def test_plain_texts_are_read_alone_and_by_direction(tmp_path):
    (tmp_path / "a.acc").write_text(PLAIN)
    (tmp_path / "b.csv").write_text("Time,Acc\n0,1\n0.01,2\n0.02,3\n")
    table = '{file = "a.acc", step = 0.01, unit = "g", skip = 1}'
    alone = load_scene(scene_file(tmp_path, f"record = {table}"))
    np.testing.assert_allclose(alone.record[:3, 1], GRAVITY * np.array([0.1, 0.2, 0.3]), rtol=1e-15)
    both = load_scene(scene_file(tmp_path, f'record = {{x = {{file = "b.csv", unit = "gal"}}, z = {table}}}'))
    np.testing.assert_allclose(both.record[0, 1:], [0.01, 0.0, 0.1 * GRAVITY], rtol=1e-15)
    np.testing.assert_allclose(both.record[3], [0.03, 0.0, 0.0, 0.4 * GRAVITY], rtol=1e-15)
    assert both.excitation.files == "b.csv, a.acc"
    family = reference.load_family(
        scene_file(tmp_path, f'record = {{values = [{table}, {{file = "b.csv", unit = "g"}}]}}')
    )
    assert [scene.name for scene in family.scenes] == ["mine[record=a]", "mine[record=b]"]
    other = both.with_values({"excitation.record": {"file": str(tmp_path / "b.csv"), "unit": "m/s^2"}})
    assert other.record[0, 1] == 1.0
    line = str(refusal(load_scene, scene_file(tmp_path, 'record = "a.acc"'), kind=SceneError))
    assert "excitation.record = 'a.acc': plain text needs step and unit: write record = {file = \"a.acc\", " in line


def test_components_with_other_instants_are_refused(tmp_path):
    (tmp_path / "a.csv").write_text("time [s],ax [g]\n0,1\n0.01,2\n0.02,0\n")
    (tmp_path / "b.csv").write_text("time [s],ax [g]\n0,1\n0.02,2\n0.04,0\n")
    (tmp_path / "two.csv").write_text("time [s],ax [g],ay [g]\n0,1,1\n0.02,2,2\n")
    (tmp_path / "one.csv").write_text("time [s],ax [g]\n0,1\n")
    for name, times in {"late": (5.0, 5.01, 5.02), "near": (0, 0.01005, 0.02), "off": (0, 0.01, 0.0302)}.items():
        (tmp_path / f"{name}.csv").write_text("time [s],ax [g]\n{},1\n{},2\n{},0\n".format(*times))
    other, two = "other instants along x than along y", "holds several directions"
    for pair, said in (("a", ""), ("late", ""), ("near", ""), ("b", other), ("two", two), ("one", other)):
        place = scene_file(tmp_path, f'record = {{x = "a.csv", y = "{pair}.csv"}}')
        if said:
            assert said in refusal(load_scene, place, kind=SceneError).rule
        else:
            assert (load_scene(place).record[:, 1] == load_scene(place).record[:, 2]).all()
    (tmp_path / "a.csv").write_text("time [s],ax [g]\n0,1\n0.01,2\n0.03,0\n")
    for record, said in (('{x = "off.csv", y = "a.csv"}', other), ('{x = "two.csv"}', two)):
        place = scene_file(tmp_path, f"record = {record}")
        assert said in refusal(load_scene, place, kind=SceneError).rule, "a hundredth of the shortest step"
    third = scene_file(tmp_path, 'record = {x = "a.csv", y = "a.csv", z = "b.csv"}')
    assert "other instants along y than along z" in refusal(load_scene, third, kind=SceneError).rule


@pytest.mark.parametrize(("name", "directions"), [("synthetic-pair", "xy"), ("synthetic-triple", "xyz")])
def test_an_example_is_a_record_by_its_name(tmp_path, name, directions):
    read = describe_record(load_scene(scene_file(tmp_path, f'record = "{name}"')))
    assert "".join(one.axis for one in read.directions) == directions
    assert read.warnings == ()
