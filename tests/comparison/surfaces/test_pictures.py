"""Pictures drawn by workers are those drawn at home, are stored, and one whose worker fails is drawn all the same."""

from collections.abc import Callable
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from fake_models import fake_hierarchy
from known_analyses import collected
from pypdf import PdfReader
from runs import quick_figures
from studies import solved

from comparison.runner.cache import Cache
from comparison.runner.runner import Runner
from comparison.runner.task_results import TaskResults
from comparison.study.study import Study
from comparison.surfaces.figures.pairs import find_height_limits
from comparison.surfaces.figures.paper import draw_paper_figure
from comparison.surfaces.figures.pictures import Pictures
from reference.problem import load_scene


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


def test_fonts_of_a_figure_in_the_manner_of_the_paper_are_such_as_journals_take(tmp_path: Path) -> None:
    study, surfaces = _solved()
    draw_paper_figure(tmp_path / "paper.png", study, surfaces, study.scenes[0])
    (page,) = PdfReader(tmp_path / "paper.pdf").pages
    fonts = [font.get_object() for font in page["/Resources"]["/Font"].values()]
    assert {font["/Subtype"] for font in fonts} == {"/Type0"}, "TrueType: type 42"
