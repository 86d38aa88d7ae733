"""What a run of the command line leaves, and pictures in its report that take no time."""

from collections.abc import Callable
from concurrent.futures import Executor, Future
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from comparison.surfaces.figures import pairs, paper

SMALL = ["fig3-I", "--grid", "2"]
RUN: dict[str, Any] = {
    "began": "2026", "command": "run `a`", "wall_seconds": 1.0, "processor_seconds": 2.0, "tiles": 1,
    "tiles_stored_before": 0, "parts": {}, "jobs": 1, "provenance": {}, "level": 1, "levels": 1,
}  # fmt: skip


@dataclass(frozen=True)
class Run:
    """What one command left: exit code, output, and where the report went."""

    code: int
    out: str
    err: str
    report: Path


class Here:
    """In place of a worker process: calls are made in this one, without a limit."""

    def __init__(self, jobs: int) -> None: ...

    def start(self, call: Callable[[], Any], seconds: float | None = None) -> Future[Any]:
        done: Future[Any] = Future()
        done.set_result(call())
        return done

    def abandon(self) -> None: ...


def quick_figure(path: Path, *rest: object) -> None:
    """One dot."""
    Image.new("RGB", (1, 1)).save(path, "PNG")


def quick_figures(patch: pytest.MonkeyPatch) -> None:
    """Every picture of the surfaces is one dot."""
    patch.setattr(pairs, "draw_pair", quick_figure)
    patch.setattr(paper, "draw_paper_figure", quick_figure)


def no_executor(jobs: int) -> Executor:
    """Where every result is stored."""
    raise AssertionError("nothing should have been computed")
