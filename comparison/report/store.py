"""Where the report goes: written aside, put in place only when complete, never over what is not a report."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from fnmatch import fnmatchcase
from pathlib import Path

from comparison.extremes.matrix import FILE as EXTREMES
from comparison.extremes.matrix import read as stored_extremes
from comparison.report.aside import NEW, OLD, aside
from comparison.report.summary import SCHEMA
from comparison.tradeoff.trade import FILE as TRADES
from comparison.tradeoff.trade import read as stored_trades
from reference.problem import SceneError

PARTS = {"index.html", "surfaces.nc", "summary.json", "summary.md", "junit.xml", "figures"}
# what other commands leave there: the next report takes it up, and keeps it
BESIDE = (EXTREMES, "extremes.png", TRADES, "*-tradeoff.png", "*-tradeoff.pdf", "*-tradeoff.nc")


def refuse_foreign(out: Path) -> None:
    """Raise SceneError, one line, if a report cannot be put at `out` or would destroy something else there."""

    def refusal(rule: str) -> SceneError:
        return SceneError("command line", "--out", str(out), rule)

    place = out.resolve()
    if place.exists():
        if not place.is_dir():
            raise refusal("is a file: give the directory the report goes to")
        if Path.cwd().resolve().is_relative_to(place):
            raise refusal("is the directory you work in: give one inside it")
        present = {entry.name for entry in place.iterdir()}
        strangers = sorted(name for name in present if not _beside(name))
        if strangers and not _is_report(place):
            raise refusal("exists and is not a report of this study: give another directory, or empty this one")
        if lost := [name for name in strangers if name not in PARTS]:
            raise refusal(f"the report there also holds {lost[0]!r}, which would be lost: move it away")
        try:
            stored_extremes(place)
            stored_trades(place)
        except ValueError as fault:
            raise refusal(f"the report cannot take up {fault}") from None
    try:
        tempfile.TemporaryDirectory(dir=_existing_ancestor(place.parent), prefix=f".{place.name}-").cleanup()
    except OSError as fault:
        raise refusal(f"cannot be written: {fault.strerror}") from None


@contextmanager
def replaced_when_complete(out: Path) -> Iterator[Path]:
    """
    A new directory beside `out` to write into; it takes the place of `out` if the block ends without exception.

    What other commands left in `out` is in it already.
    """
    place = out.resolve()
    made = _make_parents(place.parent)
    try:
        with aside(place) as folder:
            new = folder / NEW
            new.mkdir()
            for entry in place.iterdir() if place.exists() else ():
                if _beside(entry.name):
                    shutil.copy2(entry, new)
            yield new
            _swap(new, place, folder / OLD)
    except BaseException:
        with suppress(OSError):
            for parent in made:
                parent.rmdir()
        raise


def _swap(new: Path, place: Path, old: Path) -> None:
    try:
        if place.exists():
            os.rename(place, old)
        os.rename(new, place)
    except BaseException:
        if old.exists() and not place.exists():
            os.rename(old, place)
        raise


def _beside(name: str) -> bool:
    """Whether another command left a file of this name."""
    return any(fnmatchcase(name, pattern) for pattern in BESIDE)


def _is_report(place: Path) -> bool:
    try:
        summary = json.loads((place / "summary.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    return isinstance(summary, dict) and summary.get("schema") == SCHEMA


def _existing_ancestor(folder: Path) -> Path:
    return next(parent for parent in (folder, *folder.parents) if parent.exists())


def _make_parents(folder: Path) -> list[Path]:
    """Create what is missing of `folder`; the directories made, deepest first."""
    missing = [parent for parent in (folder, *folder.parents) if not parent.exists()]
    for parent in reversed(missing):
        parent.mkdir()
    return missing
