"""Pictures drawn by workers are those drawn at home, are stored, and one whose worker fails is drawn all the same."""

from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from fake_models import fake_hierarchy
from known_analyses import collected
from matplotlib.figure import Figure
from pypdf import PdfReader
from runs import quick_figures
from studies import planted_study, solved

from comparison.result_types import Array
from comparison.runner.cache import Cache
from comparison.runner.runner import Runner
from comparison.runner.task_results import TaskResults
from comparison.study.models import Model
from comparison.study.study import Study
from comparison.surfaces.body_comparison import BodyComparison
from comparison.surfaces.figures import pairs, paper
from comparison.surfaces.figures.pairs import _draw_difference_map, draw_map, draw_pair, find_height_limits
from comparison.surfaces.figures.paper import draw_paper_figure
from comparison.surfaces.figures.pictures import Pictures
from reference.problem import Scene, load_scene


class Broken(Executor):
    """Whose every task fails."""

    def submit(self, solve: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        failed: Future[Any] = Future()
        failed.set_exception(RuntimeError("no room"))
        return failed


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    quick_figures(monkeypatch)


def _solved(gap: float = 0.01) -> tuple[Study, xr.Dataset]:
    study = Study((load_scene("fig3-I"), load_scene("fig4-viscous")), 4, 1e-3, fake_hierarchy(gap=gap))
    return study, solved(study)


def test_what_no_worker_draws_is_drawn_at_home() -> None:
    study, surfaces = _solved()
    drawn = collected(Pictures(), study, surfaces)
    assert [*drawn] == [f"{scene}-{part}.png" for scene in ("fig3-I", "fig4-viscous")
                        for part in ("paper", "body1-total", "body2-total")]  # fmt: skip
    assert collected(Pictures(), study, surfaces, lambda jobs: Broken()) == drawn


def test_pictures_are_stored_and_belong_to_their_numbers(tmp_path: Path) -> None:
    def drawn_anew(gap: float) -> int:
        results, tasks = TaskResults(Cache(tmp_path)), Pictures().tasks(*_solved(gap))
        Runner(results, 1, ThreadPoolExecutor).run(tasks)
        return len(tasks) - results.parts["pictures"].stored

    first, again, others = map(drawn_anew, (0.01, 0.01, 0.02))
    assert (again, others) == (0, first)
    assert first > 0


def test_a_flat_surface_has_room_above_and_below() -> None:
    flat, nothing = np.full((2, 2), 2.0), np.full((2, 2), np.nan)
    assert find_height_limits([flat, nothing]) == pytest.approx((1.7, 2.3))
    assert (find_height_limits([flat, 3.0 * flat]), find_height_limits([nothing])) == ((2.0, 6.0), (0.0, 1.0))


def test_one_phase_pair_that_differs_is_seen_among_many_alike() -> None:
    study, surfaces = planted_study({})
    surfaces["mu"].loc[{"model": "resolved", "alpha1": np.pi, "alpha2": 0.0}] *= 1.3
    comparison = BodyComparison(study, surfaces, study.scenes[0], 1)
    figure = Figure()
    _draw_difference_map(figure, figure.add_axes((0, 0, 1, 1)), comparison.difference(comparison.effect_pairs[0]))
    assert figure.axes[0].collections[0].get_clim() == pytest.approx((-30.0, 30.0))


def test_a_map_has_alpha1_to_the_right_and_alpha2_upward() -> None:
    axes = Figure().add_subplot()
    phase = np.array([0.0, 0.5, 1.5]) * np.pi
    image = draw_map(axes, phase, np.arange(9.0).reshape(3, 3))
    rightward = [image.get_array()[2, column] for column in range(4)]
    assert rightward == [2.0, 5.0, 8.0, 2.0], "values at alpha2 = 3 pi / 2, and the first one again at 2 pi"
    assert image.get_coordinates()[0, :2, 0].tolist() == pytest.approx([-0.25 * np.pi, 0.25 * np.pi])


def test_a_figure_in_the_manner_of_the_paper_has_no_engine_of_the_user(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study, surfaces = planted_study({})
    mine = replace(study.hierarchy[5], key="mine", side="user", like="regularised")
    drawn: list[str] = []
    figures: list[Figure] = []

    def noted(data: xr.Dataset, scene: Scene, model: Model, body: int) -> tuple[Array, Array]:
        drawn.append(f"{model.key} {body}")
        return np.arange(3.0), np.ones((3, 3))

    monkeypatch.setattr(paper, "extend_surface_to_two_pi", noted)
    monkeypatch.setattr(Figure, "savefig", lambda figure, *rest, **options: figures.append(figure))
    with_mine = replace(study, hierarchy=(*study.hierarchy, mine))
    draw_paper_figure(tmp_path / "paper.png", with_mine, surfaces, study.scenes[0])
    assert drawn == [f"{key} {body}" for body in (1, 2) for key in ("small-resolved", "translational")]
    a, b, c, d = (axes.get_position().extents for axes in figures[0].axes)  # left, bottom, right, top
    assert max(a[2], c[2]) <= min(b[0], d[0]), "the engine is to the right of the equations"
    assert max(c[3], d[3]) <= min(a[1], b[1]), "body 2 is below body 1"
    assert 0.0 <= min(a[0], c[0]) < max(b[2], d[2]) <= 1.0
    assert 0.0 <= c[1] < 0.1 < 0.9 < a[3] <= 1.0


def test_fonts_of_a_figure_in_the_manner_of_the_paper_are_such_as_journals_take(tmp_path: Path) -> None:
    study, surfaces = _solved()
    draw_paper_figure(tmp_path / "paper.png", study, surfaces, study.scenes[0])
    (page,) = PdfReader(tmp_path / "paper.pdf").pages
    fonts = [font.get_object() for font in page["/Resources"]["/Font"].values()]
    assert {font["/Subtype"] for font in fonts} == {"/Type0"}, "TrueType: type 42"


@pytest.mark.parametrize("higher", ["first", "second"])
def test_both_surfaces_of_a_picture_have_a_scale_that_holds_both(
    higher: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    study = Study((load_scene("fig3-I"),), 4, 1e-3, fake_hierarchy())
    surfaces = solved(study)
    [scene], pair = study.scenes, study.pairs(study.scenes[0])[0]
    surfaces["mu"].loc[{"model": getattr(pair, higher).key}] *= 5.0
    shown: list[Any] = []
    monkeypatch.setattr(
        pairs, "_draw_surface", lambda axes, phases, height, low, high: shown.append((height, low, high))
    )
    draw_pair(tmp_path / "pair.png", surfaces, scene, 1, pair)
    (one, *limits), (other, *same) = shown
    assert limits == same
    assert limits[0] <= min(one.min(), other.min()) < max(one.max(), other.max()) <= limits[1]
