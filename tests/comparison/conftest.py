"""Runs of the command line with models of known answer."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import pytest
from fake_models import fake_ladder

from comparison.ladder import Rung
from comparison.run import main


@dataclass(frozen=True)
class Run:
    """What one command left: exit code, output, and where the report went."""

    code: int
    out: str
    err: str
    report: Path


@pytest.fixture
def command(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> Callable[..., Run]:
    """The command line with fake models in threads of this process, in an empty directory unless --out is given."""

    def run(*words: str, ladder: Sequence[Rung] | None = None, executor: Callable[[int], Executor] | None = None) -> Run:
        report = tmp_path / "report"
        given = [*words] if "--out" in words else [*words, "--out", str(report)]
        code = main(given, fake_ladder() if ladder is None else ladder, executor or ThreadPoolExecutor)
        return Run(code, *capfd.readouterr(), report)

    return run


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report of two scenes, one dry and one lubricated, on a 4 x 4 grid; the engine 1 % above the reference."""
    report = tmp_path_factory.mktemp("finished") / "report"
    words = ["fig3-I", "fig4-viscous", "--grid", "4", "--jobs", "2", "--out", str(report)]
    assert main(words, fake_ladder(), ThreadPoolExecutor) == 0
    return report
