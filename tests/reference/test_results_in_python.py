"""Phases of any shape, results as xarray, in one line and as tables, and their drawings."""

import math
import subprocess
import sys
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from chains import chain, refusal

import multibody
import reference
from reference.problem import Amplification
from reference.problem.phases import phase_axis, phase_coordinates
from reference.solver.samples import step_instants
from reference.support import drawing
from reference.support.html_table import html_table

SCENE = reference.load_scene("fig4-dry").with_values({"duration": 3.0})
PAIRS = reference.phase_grid(3)


@pytest.fixture(scope="module")
def surface():
    return reference.amplification(SCENE, PAIRS, tolerance=1e-4)


@pytest.fixture(scope="module")
def motion():
    return reference.trajectory(SCENE, (2.0, 0.7), tolerance=1e-4)


def test_results_have_the_shape_of_the_phases(surface):
    shape = (3, 1, 3)
    result = reference.amplification(SCENE, PAIRS.reshape(*shape, 2), tolerance=1e-4)
    for name in ("mu", "error", "phases"):
        np.testing.assert_array_equal(getattr(result, name), getattr(surface, name).reshape(*shape, 2))
    for name in ("status", "instant", "cap_share", "displacement"):
        np.testing.assert_array_equal(getattr(result, name), getattr(surface, name).reshape(shape))
    one = reference.amplification(SCENE, PAIRS[4], tolerance=1e-4)
    assert (one.mu.tolist(), one.status.shape, str(one.status)) == (surface.mu[4].tolist(), (), "ok")
    assert one.to_xarray()["mu"].dims == ("body",)
    scene, pairs = SCENE.with_values({"duration": 0.5}), PAIRS[:4]
    listed, engine = (multibody.amplification(scene, p, tolerance=1e-2) for p in (pairs, pairs.reshape(2, 2, 2)))
    np.testing.assert_array_equal(engine.mu, listed.mu.reshape(2, 2, 2))
    assert engine.status.shape == engine.cap_share.shape == engine.instant.shape == (2, 2)


def assert_units(data, names_of):
    found = {name: data[name].attrs["units"] for name in data.variables if "units" in data[name].attrs}
    assert found == {name: unit for unit, names in names_of.items() for name in names.split()}


def test_a_list_is_labeled_by_itself_and_a_grid_by_its_axes(surface):
    data = surface.to_xarray()
    assert data["mu"].dims == ("phase", "body")
    np.testing.assert_array_equal(data["alpha2"], PAIRS[:, 1])
    across = PAIRS.reshape(3, 3, 2) + np.array([0.0, 0.1])  # no phase on both axes
    assert phase_coordinates(across)[1]["alpha2"][1].tolist() == across[0, :, 1].tolist()
    grid = reference.amplification(SCENE, PAIRS.reshape(3, 3, 2), tolerance=1e-4).to_xarray()
    assert grid["mu"].dims == ("alpha1", "alpha2", "body")
    at = grid.sel(alpha1=PAIRS[5, 0], alpha2=PAIRS[5, 1])
    for name in ("mu", "error", "displacement", "cap_share"):
        np.testing.assert_array_equal(at[name], getattr(surface, name)[5])
    assert str(at["status"].item()) == "ok"
    assert_units(grid, {"1": "mu error cap_share", "s": "instant", "m": "displacement", "rad": "alpha1 alpha2"})
    assert grid["body"].values.tolist() == [1, 2]
    loose = reference.amplification(SCENE, PAIRS[:4].reshape(2, 2, 2) ** 2, tolerance=1e-3).to_xarray()
    assert loose["mu"].dims == ("phase_1", "phase_2", "body")


@pytest.mark.parametrize("points", [2.5, 2.0, 0, 10_001, "2", None])
def test_an_axis_of_phases_has_a_whole_number_of_them(points):
    assert "must be a whole number from 1 to 10000" in str(refusal(phase_axis, points))


@pytest.mark.parametrize(("count", "most"), [(60, 200), (60, 60), (60, 31), (1, 7), (900, 999)])
def test_instants_are_in_every_step_up_to_the_most_that_are_kept(count: int, most: int) -> None:
    """Ten steps of unequal length, of which the last has no instant just before its end."""
    ends = np.cumsum(np.arange(1.0, 11.0))
    starts, lengths = np.append(0.0, ends[:-1]), np.arange(1.0, 11.0)
    record: Any = SimpleNamespace(
        counts=np.array([10, 0]), start=starts, length=lengths, contact=np.zeros(10, int), clock=np.zeros((10, 7))
    )
    every = step_instants(record, count, 10_000)
    parts = min(max(count // 10, 4), 48)
    expected = np.concatenate([start + length * np.arange(parts) / parts for start, length in zip(starts, lengths)])
    np.testing.assert_allclose(every, np.sort([*expected, *starts[1:]]), rtol=1e-15)
    assert {*np.nextafter(starts[1:], -np.inf)} < {*every}
    kept = step_instants(record, count, most)
    assert len(kept) <= most
    np.testing.assert_array_equal(kept, every[:: -(-len(every) // most)])


def test_a_motion_is_labeled_with_units(motion):
    data = motion.to_xarray()
    np.testing.assert_array_equal(data["position"].sel(body=2, axis="x"), motion.position[:, 1, 0])
    np.testing.assert_array_equal(data["isolator_force"].sel(horizontal="y"), motion.isolator_force[:, 1])
    of = {"m": "position", "m/s": "velocity", "m/s^2": "absolute_acceleration peak ground", "W": "friction_power"}
    of |= {"N": "contact_force isolator_force support_force", "s": "time"}
    assert_units(data, of)
    assert (data.attrs["scene"], data.attrs["status"]) == ("fig4-dry[duration=3]", "ok")
    assert np.isin(np.linspace(0.0, 3.0, 215), motion.time).all(), "64 instants in 0.9 s, and those of the steps"
    assert data["support_force"].shape == (len(motion.time), 0), "the equations have no single supports"
    forces = np.arange(3.0 * len(motion.time)).reshape(-1, 3)
    on_three = replace(motion, extra={"support_force": forces}).to_xarray()
    np.testing.assert_array_equal(on_three["support_force"].sel(support=3), forces[:, 2])


def test_a_surface_is_drawn_with_its_heights_where_they_belong(surface):
    axes = surface.plot(body=2)
    assert (axes.name, axes.get_xlabel(), axes.get_ylabel()) == ("3d", r"$\alpha_1$, rad", r"$\alpha_2$, rad")
    assert "mu_{2}" in axes.get_zlabel()
    (bar,) = (other for other in axes.figure.axes if other is not axes)
    assert (bar.get_ylabel(), *bar.get_ylim()) == (axes.get_zlabel(), surface.mu[:, 1].min(), surface.mu[:, 1].max())
    assert axes.get_title() == "fig4-dry[duration=3], body 2\nexact equations, literal supremum"
    axes.figure.canvas.draw()
    names = {label.get_text() for label in axes.get_xticklabels()}
    assert {"0", "π/2", "π"} <= names, "quarter turns, and no numbers that look like names of phases"
    low, high = axes.get_zlim()
    assert low <= surface.mu[:, 1].min() < surface.mu[:, 1].max() <= high
    small = reference.amplification(SCENE, PAIRS.reshape(3, 3, 2) / 4.0, tolerance=1e-3).plot()
    small.figure.canvas.draw()
    assert not {"0", "π/2"} & {label.get_text() for label in small.get_xticklabels()}, "so short an axis"
    (mesh,) = replace(surface, mu=surface.mu[:6], phases=PAIRS[:6]).plot(axes=plt.figure().add_subplot()).collections
    np.testing.assert_array_equal(np.asarray(mesh.get_array()).reshape(3, 2), surface.mu[:6, 0].reshape(2, 3).T)
    solid = replace(surface, mu=surface.mu[:6], phases=PAIRS[:6]).plot()
    solid.figure.canvas.draw()
    assert solid.get_xlim()[1] < 3.0 < solid.get_ylim()[1]
    ticks = solid.get_xticklabels(), solid.get_yticklabels()
    assert ["π/2" in {label.get_text() for label in labels} for labels in ticks] == [False, True]
    assert len({label.get_text() for label in ticks[1]}) == len(ticks[1]), "no label twice"
    flat = surface.plot(axes=plt.figure().add_subplot())
    (mesh,) = flat.collections
    plt.close("all")
    np.testing.assert_array_equal(np.asarray(mesh.get_array()).reshape(3, 3), surface.mu[:, 0].reshape(3, 3).T)


def test_a_motion_is_drawn_with_a_line_for_every_body_and_axis(motion, monkeypatch):
    axes = motion.plot()
    assert [line.get_label() for line in axes.get_lines()] == ["body 1, x", "body 1, y", "body 2, x", "body 2, y"]
    np.testing.assert_array_equal(axes.get_lines()[3].get_ydata(), motion.position[:, 1, 1])
    assert [patch.get_x() for patch in axes.patches] == [start for start, _ in motion.stick] != []
    for name, unit in (("position", "m"), ("velocity", "m/s"), ("absolute_acceleration", "m/s$^2$")):
        assert motion.plot(name, axes=plt.figure().add_subplot()).get_ylabel().endswith(f", {unit}")
    priced = replace(motion, scene=motion.scene.with_values({"title": "from $5 to $6"})).plot()
    monkeypatch.setattr(drawing, "MAX_TIME_POINTS", len(motion.time) // 3)
    assert len(motion.plot().get_lines()[0].get_xdata()) == math.ceil(len(motion.time) / 4), "every fourth instant"
    assert priced.get_title() == r"from \$5 to \$6", "no formula"
    plt.close("all")


def test_what_is_no_body_surface_or_quantity_is_refused(surface, motion):
    for body in (0, 3, "1", 1.0):
        assert "must be a whole number from 1 to 2" in str(refusal(surface.plot, body=body))
    for phases in ([(0.3, 1.1), (2.0, 0.7)], (0.3, 1.1), [[(0.3, 1.1), (0.3, 2.2)]]):
        assert "must be a grid" in str(refusal(reference.amplification(SCENE, phases, tolerance=1e-3).plot))
    assert "quantity = 'speed': must be one of position" in str(refusal(motion.plot, "speed"))


def test_importing_the_reference_loads_no_plotting_and_no_xarray():
    code = "import sys, reference; print(*({'matplotlib', 'xarray', 'pandas'} & set(sys.modules)))"
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ended.stdout.strip() == ""


def cells(html):
    return [row.removesuffix("</td></tr>").split("</td><td>") for row in html.split("<tr><td>")[1:]]


def test_a_terminal_and_a_notebook_show_scene_surface_and_motion(motion):
    mu = np.array([[1.0, 2.25], [1.5, 2.5], [3.0, 5.0], [np.nan, np.nan]])
    error = np.array([[0.01, 0.2], [0.03, 0.1], [np.nan, 0.4], [np.nan, np.nan]])
    shown = Amplification(mu, error, np.array(["ok", "ok", "ok", "rim reached"]), np.zeros(4), 0.0)
    for name, shape in (("phases", (4, 2)), ("regularization_effect", (4, 2)), ("displacement", 4), ("cap_share", 4)):
        np.testing.assert_array_equal(getattr(shown, name), np.full(shape, np.nan), err_msg=name)
    line = "Amplification of 4 phase pairs: mu_1 1 to 3 ± 0.03, mu_2 2.25 to 5 ± 0.4, 3 ok, 1 rim reached"
    assert repr(shown) == f"<{line}>"
    table = shown._repr_html_().removesuffix("</tbody></table>")
    assert line in table
    assert "<th>smallest μ</th><th>median μ</th><th>largest μ</th><th>largest error</th>" in table
    assert cells(table) == [["1", "1", "1.5", "3", "0.03"], ["2", "2.25", "2.5", "5", "0.4"]]
    one = Amplification(mu[0], error[0], np.array("ok"), np.array(np.nan), 0.0)
    assert repr(one) == "<Amplification of 1 phase pair: mu_1 = 1 ± 0.01, mu_2 = 2.25 ± 0.2, 1 ok>"
    nine = repr(Amplification(np.ones((1, 9)), np.ones((1, 9)), np.array(["ok"]), np.zeros(1), 0.0))
    assert nine.endswith(
        ": mu_1 = 1 ± 1, mu_2 = 1 ± 1, mu_3 = 1 ± 1, mu_4 = 1 ± 1, mu_5 = 1 ± 1, mu_6 = 1 ± 1, ..., 1 ok>"
    )
    far = 1e3 * np.linalg.norm(motion.position[:, :, :2], axis=2).max(axis=0)
    head = f"{len(motion.time)} instants to 3 s, {len(motion.stick)} rests, platform at most {far[0]:.4g} mm off, ok"
    law = "set-valued Coulomb friction; literal supremum"
    assert repr(motion) == f"<Trajectory of fig4-dry[duration=3]: {head}; {law}>"
    rows = [[str(n + 1), f"{far[n]:.4g}", f"{motion.peak[n]:.5g}"] for n in range(2)]
    assert cells(motion._repr_html_().removesuffix("</tbody></table>")) == rows
    scene = chain(0.4, 0.07, (3.0, 2.0), [(150.0, 110.0)], duration=7.0)
    scene = scene.with_values({"title": "a < b", "bodies.1.damping": [5.0, 6.0], "name": "scene"})
    assert repr(scene) == "<Scene scene: 2 bodies, 5 kg, radius 0.4 m, two-frequency motion, 7 s>"
    table = scene._repr_html_().removesuffix("</tbody></table>")
    assert "7 s: a &lt; b; friction coefficient at most 0.07</p>" in table
    assert cells(table) == [["1", "3", "", ""], ["2", "2", "150, 110", "5, 6"]]
    assert "; lubrication 0.4 s/m</p>" in chain(lubrication=0.4)._repr_html_()
    table = html_table("<A>", ["b <"], [["<c>", 3]])
    assert table.startswith("<p>A</p><table><thead><tr><th>b &lt;</th></tr></thead><tbody>")
    assert cells(table.removesuffix("</tbody></table>")) == [["&lt;c&gt;", "3"]]
