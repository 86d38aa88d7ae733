"""Runs of the command line with models of known answer."""

import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import pytest
from browsers import chromium
from fake_models import fake_hierarchy, known_motions
from known_analyses import analyses_are, known_others
from playwright.sync_api import Browser
from runs import Here, Run, quick_figure, quick_figures

from comparison.cli import user_models
from comparison.run import main
from comparison.study.models import Model
from comparison.surfaces.figures import pairs

try:
    import fcntl
except ImportError:  # on Windows every process makes its own
    fcntl = None  # type: ignore[assignment]


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with chromium() as browser:
        yield browser


@pytest.fixture
def command(tmp_path: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Callable[..., Run]:
    """The command line with fake models in threads of this process and quick figures; --out in an empty directory."""
    quick_figures(monkeypatch)
    monkeypatch.setattr(user_models, "Workers", Here)
    analyses_are(monkeypatch, motions=[])

    def run(
        *words: str, hierarchy: Sequence[Model] | None = None, executor: Callable[[int], Executor] = ThreadPoolExecutor
    ) -> Run:
        place = tmp_path / "report"
        given = [*words] if "--out" in words else [*words, "--out", str(place)]
        code = main(given, fake_hierarchy() if hierarchy is None else hierarchy, executor)
        out, err = capfd.readouterr()
        assert "could not be shown" not in err, "every part of the report is there"
        return Run(code, out, err, place)

    return run


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """
    The report of two scenes, one dry and one lubricated, on a 4 x 4 grid; the engine 1 % above the reference.

    The first process that needs it makes it for all.
    """
    base = tmp_path_factory.getbasetemp()
    place = (base.parent if "PYTEST_XDIST_WORKER" in os.environ and fcntl else base) / "finished" / "report"
    place.parent.mkdir(exist_ok=True)
    with open(place.parent.with_suffix(".lock"), "w") as stream:
        if fcntl:
            fcntl.flock(stream, fcntl.LOCK_EX)
        if not place.exists():
            _write_finished(place)
    return place


def _write_finished(place: Path) -> None:
    words = ["fig3-I", "fig4-viscous", "--grid", "4", "--jobs", "2", "--out", str(place)]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pairs, "draw_pair", quick_figure)  # what they show is tested elsewhere
        analyses_are(patch, motions=known_motions, **known_others())
        assert main(words, _spatial_named(fake_hierarchy()), ThreadPoolExecutor) == 0


def _spatial_named(hierarchy: Sequence[Model]) -> list[Model]:
    """The hierarchy with a spatial model that says so, as the page draws it as points on few phases."""
    named = {"model": "spatial"}
    return [replace(m, settings={**m.settings, **named}) if m.key == "spatial" else m for m in hierarchy]
