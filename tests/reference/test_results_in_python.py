"""Phases of any shape, results as xarray, and their drawings."""

import subprocess
import sys

import matplotlib.pyplot as plt
import numpy as np
import pytest

import multibody
import reference

SCENE = reference.load_scene("fig4-dry").with_values({"duration": 3.0})
PAIRS = reference.phase_grid(3)


@pytest.fixture(autouse=True)
def _closed_figures():
    yield
    plt.close("all")


@pytest.fixture(scope="module")
def surface():
    return reference.amplification(SCENE, PAIRS, tolerance=1e-4)


SHAPES = [(3, 3), (3, 1, 3)]


@pytest.mark.parametrize("shape", SHAPES)
def test_results_have_the_shape_of_the_phases(surface, shape):
    result = reference.amplification(SCENE, PAIRS.reshape(*shape, 2), tolerance=1e-4)
    for name in ("mu", "error"):
        np.testing.assert_array_equal(getattr(result, name), getattr(surface, name).reshape(*shape, 2))
    for name in ("status", "instant", "cap_share"):
        np.testing.assert_array_equal(getattr(result, name), getattr(surface, name).reshape(shape))
    np.testing.assert_array_equal(result.phases, PAIRS.reshape(*shape, 2))


def test_one_pair_gives_one_row(surface):
    result = reference.amplification(SCENE, PAIRS[4], tolerance=1e-4)
    np.testing.assert_array_equal(result.mu, surface.mu[4])
    assert (result.mu.shape, result.status.shape, str(result.status)) == ((2,), (), "ok")
    assert result.to_xarray()["mu"].dims == ("body",)


def test_the_engine_takes_phases_of_any_shape():
    scene, pairs = SCENE.with_values({"duration": 0.5}), PAIRS[:4]
    listed = multibody.amplification(scene, pairs, tolerance=1e-2)
    result = multibody.amplification(scene, pairs.reshape(2, 2, 2), tolerance=1e-2)
    np.testing.assert_array_equal(result.mu, listed.mu.reshape(2, 2, 2))
    np.testing.assert_array_equal(result.status, listed.status.reshape(2, 2))
    assert result.cap_share.shape == result.instant.shape == (2, 2)
    assert multibody.amplification(scene, pairs[1], tolerance=1e-2).mu.tolist() == listed.mu[1].tolist()


def test_a_list_is_labeled_by_itself_and_a_grid_by_its_axes(surface):
    data = surface.to_xarray()
    assert data["mu"].dims == ("phase", "body")
    np.testing.assert_array_equal(data["alpha2"], PAIRS[:, 1])
    grid = reference.amplification(SCENE, PAIRS.reshape(3, 3, 2), tolerance=1e-4).to_xarray()
    assert grid["mu"].dims == ("alpha1", "alpha2", "body")
    at = grid.sel(alpha1=PAIRS[5, 0], alpha2=PAIRS[5, 1])
    np.testing.assert_array_equal(at["mu"], surface.mu[5])
    assert str(at["status"].item()) == "ok"
    units = {"mu": "1", "error": "1", "instant": "s", "alpha1": "rad", "alpha2": "rad"}
    assert {name: grid[name].attrs["units"] for name in units} == units
    assert grid["body"].values.tolist() == [1, 2]


def test_pairs_that_are_no_grid_keep_their_own_phases():
    random = np.random.default_rng(1).uniform(0.0, 6.0, (2, 2, 2))
    data = reference.amplification(SCENE, random, tolerance=1e-3).to_xarray()
    assert data["mu"].dims == ("phase_1", "phase_2", "body")
    np.testing.assert_array_equal(data["alpha1"], random[..., 0])


def test_a_motion_is_labeled_with_units():
    motion = reference.trajectory(SCENE, (2.0, 0.7), tolerance=1e-4)
    data = motion.to_xarray()
    x = data["position"].sel(body=2, axis="x")
    np.testing.assert_array_equal(x, motion.position[:, 1, 0])
    assert (x.attrs["units"], data["time"].attrs["units"]) == ("m", "s")
    assert data["absolute_acceleration"].attrs["units"] == "m/s^2"
    np.testing.assert_array_equal(data["isolator_force"].sel(horizontal="y"), motion.isolator_force[:, 1])
    assert (data.attrs["scene"], data.attrs["status"]) == ("fig4-dry", "ok")
    assert data["support_force"].shape == (len(motion.time), 0), "the equations have no single supports"


def test_a_surface_is_drawn_with_its_heights_where_they_belong(surface):
    axes = surface.plot(body=2)
    assert axes.name == "3d"
    assert "mu_{2}" in axes.get_zlabel()
    low, high = axes.get_zlim()
    assert low <= surface.mu[:, 1].min()
    assert surface.mu[:, 1].max() <= high
    flat = surface.plot(axes=plt.figure().add_subplot())
    (mesh,) = flat.collections
    np.testing.assert_array_equal(np.asarray(mesh.get_array()).reshape(3, 3), surface.mu[:, 0].reshape(3, 3).T)


def test_a_motion_is_drawn_with_a_line_for_every_body_and_axis():
    motion = reference.trajectory(SCENE, (2.0, 0.7), tolerance=1e-4)
    axes = motion.plot()
    assert [line.get_label() for line in axes.get_lines()] == ["body 1, x", "body 1, y", "body 2, x", "body 2, y"]
    np.testing.assert_array_equal(axes.get_lines()[3].get_ydata(), motion.position[:, 1, 1])
    assert len(axes.patches) == len(motion.stick) > 0
    assert motion.plot("velocity", axes=plt.figure().add_subplot()).get_ylabel().endswith("m/s")


@pytest.mark.parametrize("body", [0, 3, "1", 1.0])
def test_a_body_that_is_not_there_is_refused(surface, body):
    with pytest.raises(ValueError, match="must be a whole number from 1 to 2"):
        surface.plot(body=body)


def test_what_is_no_surface_and_no_quantity_is_refused(surface):
    with pytest.raises(ValueError, match="must be a grid"):
        reference.amplification(SCENE, [(0.3, 1.1), (2.0, 0.7)], tolerance=1e-3).plot()
    with pytest.raises(ValueError, match="quantity = 'speed': must be one of position"):
        reference.trajectory(SCENE, (2.0, 0.7), tolerance=1e-3).plot("speed")


def test_importing_the_reference_loads_no_plotting_and_no_xarray():
    code = "import sys, reference; print(*({'matplotlib', 'xarray', 'pandas'} & set(sys.modules)))"
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ended.stdout.strip() == ""


def test_a_notebook_shows_scene_surface_and_motion_as_tables(surface):
    table = surface._repr_html_()
    assert f"<td>2</td><td>{surface.mu[:, 1].min():.5g}</td>" in table
    assert "9 ok" in table
    assert f"± {surface.error[:, 1].max():.1g}, 9 ok" in table
    motion = reference.trajectory(SCENE, (2.0, 0.7))
    far = 1e3 * np.linalg.norm(motion.position[:, 1, :2], axis=1).max()
    assert f"<td>2</td><td>{far:.4g}</td><td>{motion.peak[1]:.5g}</td>" in motion._repr_html_()
    named = SCENE.with_values({"title": "a < b"})._repr_html_()
    assert "a &lt; b" in named
    assert f"<td>{SCENE.masses[1]:.4g}</td>" in named
