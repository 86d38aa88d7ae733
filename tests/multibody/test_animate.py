"""The film of a run is written without a display, and shows the motion that was computed."""

import dataclasses
import itertools
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from exudyn.rigidBodyUtilities import RotXYZ2RotationMatrix
from matplotlib.patches import Circle
from PIL import Image

from multibody import animate
from multibody import film as film_module
from multibody.animate import main
from multibody.film import FilmSettings, arrange_boxes, choose_magnification, draw_film
from reference.problem import ADVICE, Outcome, load_scene
from reference.support.drawing import escape_for_matplotlib

SHORT = """
title = "short"
duration = 0.2
isolator = {period = 1.0, friction = 0.05}
bodies = [{mass = 1.0}, {mass = 1.0, period = [1.5, 1.2]}]
excitation = {amplitudes = [[2.0, 0.0], [0.0, 2.0]], periods = [0.9, 1.1], decay = [0.3, 0.3]}
"""
PHASES = ["--phases", "0.3", "1.1"]


@pytest.fixture
def words(tmp_path: Path) -> list[str]:
    (tmp_path / "short.toml").write_text(SHORT)
    return [str(tmp_path / "short.toml"), *PHASES, "--out", str(tmp_path / "run.GIF")]


def test_a_film_is_made_as_asked_for(
    words: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    out, computed, trajectory = Path(words[-1]), [], animate.trajectory
    out.write_bytes(b"mine")

    def noted(scene: Any, *given: Any, **more: Any) -> Any:
        computed.append((scene.amplitudes.max(), *given[1:], more))
        return trajectory(scene, *given, **more)

    monkeypatch.setattr(animate, "trajectory", noted)
    of_motion = ["--amplitude", "1.5", "--regularization", "5e-3", "--max-work", "1e5"]
    assert main([*words, *of_motion, "--rate", "50", "--speed", "0.5", "--size", "640", "400"]) == 0
    assert computed == [(1.5, "translational", 5e-3, {"max_work": 1e5})]
    assert out.read_bytes() == b"mine", "a film never takes the place of a file"
    written, said = out.with_name("run-2.GIF"), capsys.readouterr()
    assert said.err == f"{out} exists and stays: the film is in {written}\n"
    assert said.out == f"{written}: 0.20 s of motion, status ok\n"
    with Image.open(written) as film:
        assert (film.n_frames, film.size) == (21, (640, 400))
        assert film.info["duration"] == 20  # ms


def test_a_motion_that_ends_early_has_a_shorter_film(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    Path(words[0]).write_text(SHORT.replace("friction = 0.05", "friction = 0.0, travel = 0.01"))
    assert main(words) == 0
    shown, status = capsys.readouterr().out.split(": ")[1].split(" s of motion, status ")
    assert (status, 0.08 < float(shown) < 0.14) == ("travel reached\n", True)
    with Image.open(words[-1]) as film:
        assert film.n_frames == round(25 * float(shown)) + 1


def test_a_refused_motion_is_one_line(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    Path(words[0]).write_text(SHORT.replace("duration = 0.2", "duration = 1e4"))
    assert main([*words, "--speed", "1e3"]) == 2
    message = capsys.readouterr().err
    assert message.startswith("short: there is no motion to show: step limit: refused before any step")
    assert "a looser tolerance does not help" in message
    assert message.count("\n") == 1
    Path(words[0]).write_text(SHORT.replace("duration = 0.2", "duration = 0.1"))  # 26 steps; the first chunk takes 32
    assert main([*words, "--max-work", "28"]) == 2
    advice = ADVICE[Outcome.STEP_LIMIT]
    assert capsys.readouterr().err == f"short: there is no motion to show: step limit: {advice}\n"
    assert not Path(words[-1]).exists()


def test_a_film_that_cannot_be_written_is_one_line(words: list[str], capsys: Any) -> None:
    assert main([*words[:-1], str(Path(words[-1]).with_name(f"{'x' * 300}.gif"))]) == 3
    said = capsys.readouterr().err
    assert said.startswith("command line: --out = ")
    assert ("could not be written: [Errno 36]" in said, said.count("\n")) == (True, 1)


@pytest.mark.parametrize("model", ["translational", "spatial"])
def test_the_viewer_shows_the_whole_run_of_the_model_asked_for(model: str, monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[Any] = []
    built = animate.assemble
    renderer = SimpleNamespace(
        **{name: lambda name=name: calls.append(name) for name in ("Start", "DoIdleTasks", "Stop")}
    )

    def assemble(*given: Any) -> Any:
        model = built(*given)
        system = SimpleNamespace(SolveDynamic=lambda settings: calls.append((model, settings.timeIntegration)))
        system.systemData, system.SetObjectParameter = model.mbs.systemData, model.mbs.SetObjectParameter
        return dataclasses.replace(model, mbs=system, references=(SimpleNamespace(renderer=renderer),))

    monkeypatch.setattr(animate, "assemble", assemble)
    monkeypatch.setenv("DISPLAY", ":0")
    assert main(["fig3-I", *PHASES, "--model", model, "--regularization", "2e-3", "--view"]) == 0
    start, before, (shown, run), after, stop = calls
    assert [start, before, after, stop] == ["Start", "DoIdleTasks", "DoIdleTasks", "Stop"]
    assert shown.allows_liftoff == (model == "spatial")
    assert shown.corner * shown.units.velocity == pytest.approx(2e-3)
    assert [phase.Evaluate() for phase in shown.ground.phases] == [0.3, 1.1]
    assert (run.endTime, run.numberOfSteps) == (pytest.approx(20.0 / shown.units.time), 20_000)
    assert (run.realtime.active, run.realtime.factor) == (True, pytest.approx(1.0 / shown.units.time))


NAMED = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the screen is not named by a variable")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nowhere.toml"], "nowhere.toml"),
        (["fig3-I", "--phases", "0", "nan"], "phases"),
        (["fig3-I", "--model", "flexible"], "model"),
        (["fig3-I", "--speed", "1e-9"], "--speed: 1e-09: a film of 20 s of motion has 2 to 1500 frames, 25 per second: "
         "give 0.33 to 5e+02"),
        (["fig3-I", "--speed", "501"], "give 0.33 to 5e+02"),
        (["fig3-I", "--speed", "1e-320"], "--speed: 9.99989e-321: a film of 20 s"),
        (["fig3-I", "--speed", "-1"], "--speed: -1.0: must be finite and greater than 0"),
        (["fig3-I", "--stretch", "1e300"], "--stretch"),
        (["fig3-I", "--stretch", "0"], "--stretch: 0.0: must be greater than 0 and at most 1e+06"),
        (["fig3-I", "--rate", "30"], "--rate: 30: must be 1, 2, 4, 5, 10, 20, 25 or 50 per second"),
        (["fig3-I", "--size", "500", "10"], "--size: 500 10: must be 320 to 4000 pixels each"),
        (["fig3-I", "--out", "/dev/null/run.gif"], "--out"),
        (["fig3-I", "--out", "run.mp4"], "must end in .gif"),
        (["fig3-I", "--out", "/"], "is a folder"),
        (["fig3-I", "--out", f"{'x' * 300}/run.gif"], "its folder does not exist"),
        pytest.param(["fig3-I", "--view"], "--view: no screen", marks=NAMED),
    ],
)  # fmt: skip
def test_wrong_options_end_with_one_line_before_anything_is_run(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    if said not in ("phases", "model"):  # which the run itself refuses, before its first step
        monkeypatch.setattr(animate, "trajectory", lambda *given: pytest.fail("a motion was computed"))
    monkeypatch.delenv("DISPLAY", raising=False)
    assert main([words[0], *PHASES, *words[1:]]) == 2
    message = capsys.readouterr().err
    assert said in message
    assert message.count("\n") == 1


@pytest.mark.parametrize(
    ("largest", "factor"), [(0.0, 1e4), (1e-9, 1e4), (9.4e-5, 2e3), (1.4e-3, 200.0), (0.3, 1.0), (1.0, 1.0)]
)
def test_turns_are_magnified_by_round_factors_and_never_reduced(largest: float, factor: float) -> None:
    assert choose_magnification(np.array([0.0, -largest]), 0.3) == factor


def test_a_frame_lasts_whole_hundredths_of_a_second_as_files_count_it() -> None:
    assert [100 % rate for rate in animate.FRAME_RATES] == [0] * 8


def test_reduced_heights_of_a_tall_frame_are_named() -> None:
    scene = load_scene("fig3-I").with_values({"bodies.1.height": 40.0})
    motion: Any = SimpleNamespace(time=np.array([0.0, 1.0]), position=np.zeros((2, 2, 3)), extra={})
    factor = arrange_boxes(scene)[2]
    assert factor == pytest.approx(1.2 * 2.0 / (40.0 - scene.bodies[0].height)), "1.2 widths of the widest box"
    assert film_module.make_drawing(scene, motion, 1.0, 2).scales.endswith(f", heights x {factor:.2g}")


def test_the_help_says_what_a_speed_is(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["--help"])
    assert "seconds of motion per second of film" in " ".join(capsys.readouterr().out.split())
    page = " ".join((Path(animate.__file__).parent / "README.md").read_text(encoding="utf-8").split())
    assert "The film shows the boxes from above and from two sides, the supports on their ring" in page
    options = (
        "sets the size in pixels, `--rate 10` the frames per second, `--speed 2` the seconds of motion per second."
    )
    assert f"`--size 800 400` {options}" in page


def test_the_fastest_film_has_two_frames() -> None:
    settings = FilmSettings(speed=500.0)
    stated = animate._parse_arguments(["fig3-I", *PHASES])
    assert (stated.stretch, stated.speed, stated.rate, stated.size) == (5.0, 1.0, 25, (1200, 480))
    assert (stated.out, stated.model, stated.regularization) == (Path("run.gif"), "translational", 1e-3)
    animate.check_film_options(load_scene("fig3-I"), Path("run.gif"), settings)
    assert animate.count_frames(20.0, settings) == 2


@pytest.mark.parametrize("flat", [False, True])
def test_a_scene_without_supports_is_drawn_on_four_and_a_plane_without_a_curve(words: list[str], flat: bool) -> None:
    """At the corners of a square on a ring of 1 m, on spheres of 5 cm."""
    scene = load_scene(words[0]).with_values({"isolator.period": None, "isolator.radius": np.inf if flat else 0.25})
    position = np.zeros((2, 2, 3))
    position[1, 0], position[1, 1] = [0.01, -0.02, 0.0], [0.03, 0.0, 0.0]
    motion: Any = SimpleNamespace(time=np.array([0.0, 1.0]), position=position, extra={})
    drawn, factor = film_module.make_drawing(scene, motion, 4.0, 2), 1e4 if flat else 50.0
    assert drawn.scales == f"displacements x 4, contact paths x {factor:g}"
    corners = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]) / np.sqrt(2.0)
    np.testing.assert_allclose(drawn.supports, corners)
    moved = [0.0, 0.0] if flat else -factor * 0.05 / 0.25 * position[1, 0, :2]
    np.testing.assert_allclose(drawn.paths[1], corners + moved)
    ends = [[-0.03, 0.0], [0.03, 0.0]] if flat else np.outer([1.0, 1.0], [0.0, 0.25 - np.sqrt(0.25**2 - 0.0625**2)])
    ends = np.array(ends) + (0.0 if flat else 0.0625) * np.array([[-1.0, 0.0], [1.0, 0.0]])
    np.testing.assert_allclose(drawn.swing_curve[[0, -1]], 4.0 * ends, atol=1e-15)


def test_six_bodies_are_named_and_neighbors_have_other_colors() -> None:
    colors, names = zip(*film_module._colors_and_names(8))
    assert names == ("platform", *(f"body {number}" for number in range(2, 7)), "_", "_")
    assert len(set(colors)) == 8


def test_boxes_without_stated_sizes_stand_half_a_width_apart(words: list[str]) -> None:
    """Their width is that of a ring of 1 m; centers of mass at one height are drawn apart likewise."""
    for scene in (load_scene(words[0]), load_scene("fig3-I").with_values({"bodies.1.height": 0.2})):
        heights, sizes, factor = arrange_boxes(scene)
        assert (heights.tolist(), sizes.tolist(), factor) == ([0.0, 1.0], [[2.0, 2.0, 0.2]] * 2, 1.0)
    wide = load_scene("fig3-I").with_values({"isolator.ring": 3.0, "bodies.0.size": None})
    assert arrange_boxes(wide)[1][0, :2].tolist() == [6.0, 6.0]
    [height], [size], factor = arrange_boxes(scene.with_values({"bodies": [{"mass": 1.0}]}))
    assert (height, size.tolist(), factor) == (0.0, [2.0, 2.0, 0.2], 1.0)


def test_a_film_has_room_for_the_widest_box_the_farthest_support_and_the_nearest_boxes() -> None:
    sizes = ([1.0, 0.8, 0.2], [3.0, 1.0, 0.4], [1.0, 1.0, 0.4])
    bodies = [{"mass": 1.0, "height": height, "size": size} for height, size in zip((0.2, 1.0, 1.5), sizes)]
    bodies = [{**bodies[0], "offset": [0.1, -0.2]}, *({**body, "period": [1.0, 1.0]} for body in bodies[1:])]
    places = {"isolator.ring": None, "isolator.supports": [[4.0, 0.0], [-1.0, 1.0], [-1.0, -1.0]]}
    scene = load_scene("fig3-I").with_values({"bodies": bodies, **places})
    heights, drawn_sizes, factor = arrange_boxes(scene)
    assert (heights, factor, drawn_sizes[:, 2]) == (pytest.approx([0.0, 0.8, 1.3]), 1.0, pytest.approx([0.2] * 3))
    upside = scene.with_values({"bodies.2.height": 0.9})
    assert np.diff(arrange_boxes(upside)[0]) == pytest.approx([1.5, 1.5]), "no body below the one that carries it"
    position, turns = np.zeros((2, 2, 3, 3))
    position[1, 0], turns[1, 2] = [0.01, 0.0, -0.1], [1e-3, 1e-2, 0.0]
    motion: Any = SimpleNamespace(time=np.array([0.0, 0.1]), position=position, extra={"turns": turns})
    drawn = film_module.make_drawing(scene, motion, 1.0, 2)
    assert drawn.scales == "displacements x 1, contact paths x 500, tilt x 5, yaw x 10000"
    assert drawn.half_width == pytest.approx(1.08 * 4.0)
    above, aside = film_module.Figure().subplots(1, 2)
    film_module._TopView(above, drawn)
    film_module._SideView(aside, drawn, 1)
    assert not [patch for patch in above.patches if isinstance(patch, Circle)], "supports on no ring"
    poles = np.array([line.get_xydata() for line in aside.lines[0:6:2]])
    assert poles[:, 0, 0].tolist() == [0.0, 1.0, -1.0]
    assert poles[:, 1, 1] == pytest.approx([-0.1 - 0.1] * 3), "of the lowest platform"
    assert np.mean(aside.lines[6].get_xdata()) == pytest.approx(-0.2)


def test_the_film_shows_a_motion_from_three_sides(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two bodies that are 0.3 m apart, less than 0.35 of their width, displaced and turned in proportion."""
    places = {"bodies.0.offset": [0.1, -0.2], "bodies.1.offset": [-0.3, 0.15], "bodies.1.yaw": 0.6}
    scene = load_scene("fig3-I").with_values({**places, "bodies.1.height": 0.5, "bodies.1.size": [2.0, 1.0, 0.4]})
    share = np.array([0.0, 0.5, 1.0])[:, None, None]
    position = share * [[0.01, -0.02, 0.001], [0.03, 0.04, 0.002]]
    turns = share * [[1e-3, -2e-3, 4e-3], [2e-3, 1e-3, -3e-3]]
    motion: Any = SimpleNamespace(time=np.array([0.0, 0.1, 0.4]), position=position, extra={"turns": turns})
    shown, made, drawn_again, canvas_of = [], [], [], film_module.FigureCanvasAgg

    def canvas(figure: Any) -> Any:
        made.append(figure)
        monkeypatch.setattr(figure, "draw_artist", drawn_again.append)
        return canvas_of(figure)

    def gif(pictures: Iterator[Any], *rest: Any) -> bytes:
        assert made[0].texts[-1].get_text() == "t = 0.10 s", "the colors are those of the middle"
        for _ in pictures:
            above, *sides = made[0].axes
            masts = [np.array(side.lines[-1].get_data()) for side in sides]
            shown.append((len(above.lines[1].get_xdata()), made[0].texts[-1].get_text(), masts))
        return b""

    monkeypatch.setattr(film_module, "FigureCanvasAgg", canvas)
    monkeypatch.setattr(film_module, "_encode_gif", gif)
    draw_film(scene, motion, "spatial", FilmSettings(stretch=3.0, speed=0.5, rate=5), 3)
    [figure] = made
    moves = figure.findobj(lambda artist: artist.get_animated())
    assert set(drawn_again) == set(moves)
    assert len(drawn_again) == 4 * len(moves), "the typical picture and three frames"
    assert figure.get_suptitle() == (
        f"{escape_for_matplotlib(scene.title)}: spatial model of the engine\n"
        "displacements x 3, contact paths x 50, tilt x 20, yaw x 50, heights x 2.3"
    )
    labels = [(panel.get_title(), panel.get_xlabel(), panel.get_ylabel()) for panel in figure.axes]
    assert labels == [("from above", "x [m]", "y [m]"), ("along y", "x [m]", "z"), ("along x", "y [m]", "z")]
    names = {"platform", "body 2", "support", "path of the contact point", "swing of the center"}
    assert {text.get_text() for text in figure.legends[0].texts} == names
    assert len({text.get_window_extent().y0 for text in figure.legends[0].texts}) == 1, "in one row"
    drawn = film_module.make_drawing(scene, motion, 3.0, 3)
    top, highest = drawn.corners[:, 0, :, 2].min(), drawn.corners[..., 2].max()
    for panel, alpha in zip(figure.axes, (0.1, 0.35, 0.35)):
        assert [each.get_facecolor()[3] for each in panel.patches if each.get_label() in names] == [alpha] * 2
    for side in figure.axes[1:]:
        low = top - 0.15 * 2.0 * drawn.half_width
        assert side.get_ylim() == pytest.approx((low, highest + 0.05 * drawn.half_width))
        assert side.lines[0].get_ydata() == pytest.approx([low, top])
    assert [(drawn, clock) for drawn, clock, _ in shown] == [(1, "t = 0.00 s"), (2, "t = 0.10 s"), (3, "t = 0.20 s")]
    for part, (_, _, masts) in zip((0.0, 2.0 / 3.0, 1.0), shown):  # between samples in proportion
        heights = [part * 0.003, 0.7 + part * 0.006]
        np.testing.assert_allclose(masts[0], [[0.1 + part * 0.03, -0.3 + part * 0.09], heights])
        np.testing.assert_allclose(masts[1], [[-0.2 - part * 0.06, 0.15 + part * 0.12], heights])
    signs = np.array([*itertools.product((-0.5, 0.5), repeat=3)])
    corners = [  # by the engine's own matrix of its angles; a box is 0.4 of the distance of two boxes thick
        center + signs * size @ RotXYZ2RotationMatrix(angles).T
        for center, size, angles in (
            ([0.13, -0.26, 0.003], [2.0, 2.0, 0.2], [0.02, -0.04, 0.2]),
            ([-0.21, 0.27, 0.706], [2.0, 1.0, 0.28], [0.04, 0.02, 0.6 - 0.15]),
        )
    ]
    for panel, axes in zip(figure.axes, ([0, 1], [0, 2], [1, 2])):
        for polygon, box in zip([patch for patch in panel.patches if patch.get_label() in names], corners):
            apart = np.abs(polygon.get_xy()[:-1, None] - box[:, axes]).max(axis=2)
            assert len(apart) >= 4
            assert apart.min(axis=1).max() < 1e-12
    above, along_y, _ = figure.axes
    for side, places in zip(figure.axes[1:], scene.support_places.T):
        assert [line.get_xdata()[0] for line in side.lines[: 2 * len(places) : 2]] == pytest.approx(places), "poles"
    widest = 1.08 * max(np.abs(box[:, :2]).max() for box in corners)
    assert above.get_xlim() == above.get_ylim() == pytest.approx((-widest, widest))
    rings = [patch for patch in above.patches if isinstance(patch, Circle)]
    assert [ring.radius for ring in rings] == pytest.approx([1.0]), "that of the supports"
    np.testing.assert_allclose(np.array(above.lines[0].get_data()).T, scene.support_places)
    arms = np.column_stack([scene.support_places - [0.1, -0.2], np.full(4, -0.2)])  # from the center of mass
    moved = position[-1, 0] + arms @ (RotXYZ2RotationMatrix(turns[-1, 0]) - np.eye(3)).T
    paths = scene.support_places - 50.0 * 0.05 / scene.radius * moved[:, :2]  # contact points move against it
    np.testing.assert_allclose([line.get_xydata()[-1] for line in above.lines[1:5]], paths)
    np.testing.assert_allclose(above.lines[5].get_xydata(), paths)
    swing = np.array(along_y.lines[-2].get_data())
    rise = 3.0 * scene.radius * (1.0 - np.sqrt(1.0 - 0.25**2))
    np.testing.assert_allclose(swing[:, -1], [0.1 + 0.75 * scene.radius, rise])
