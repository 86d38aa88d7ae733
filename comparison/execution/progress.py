"""What the terminal shows while the workers compute: a bar per stage with the time left, or plain lines."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Protocol

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from comparison.execution.deadline import Deadline

EVERY = 15.0  # s between plain lines
PLAIN_WIDTH = 120  # columns of a table that goes to a file or a pipe


def wide_console() -> Console:
    """
    Standard output: as wide as the terminal, or PLAIN_WIDTH columns where there is none.

    Every text is printed as it is: brackets and colons in names and titles are no markup.
    """
    width = None if sys.stdout.isatty() else PLAIN_WIDTH
    return Console(highlight=False, markup=False, emoji=False, width=width)


def description() -> TextColumn:
    """The name of a bar as it is; a bar's own default would read brackets in it as markup."""
    return TextColumn("{task.description}", markup=False)


@dataclass(frozen=True)
class Stage:
    """A part of the work."""

    points: int
    seconds: float  # compute time predicted for the points that are computed
    before: int = 0  # points that need no computing: an earlier run stored them


class Display(Protocol):
    """Told of every finished piece of work and its predicted compute time, s."""

    def advance(self, stage: str, points: int, seconds: float) -> None:
        """Show that points of a stage are done, which were predicted to take so many s."""


@contextmanager
def progress(
    console: Console, stages: Mapping[str, Stage], jobs: int, deadline: Deadline | None = None
) -> Iterator[Display]:
    """
    Show what is done and left: live bars on a terminal, plain lines elsewhere.

    Parameters
    ----------
    console : Console
    stages : mapping of str to Stage
        The parts of the work by name.
    jobs : int
        Number of workers.
    deadline : Deadline, optional
        What is not done then is left out.

    Yields
    ------
    Display
        To be told of every finished piece of work.
    """
    if not console.is_terminal:
        yield Lines(console, stages, jobs, deadline)
        return
    columns = description(), BarColumn(), TextColumn("{task.fields[count]}", markup=False), TimeRemainingColumn()
    with Progress(*columns, console=console) as bars:
        yield Bars(bars, stages, math.inf if deadline is None else deadline.left * jobs)


class Bars:
    """One bar per stage; one for the whole, in which a point weighs what it is predicted to cost."""

    def __init__(self, bars: Progress, stages: Mapping[str, Stage], most: float) -> None:
        self._bars, self._stages = bars, stages
        self._done = {name: stage.before for name, stage in stages.items()}
        width = max(map(len, (*stages, "all")))
        self._tasks = {
            name: bars.add_task(
                name.ljust(width),
                total=stage.points,
                completed=stage.before,
                start=False,
                count=f"{stage.before}/{stage.points}",
            )
            for name, stage in stages.items()
        }
        self._whole = bars.add_task("all".ljust(width), total=min(most, _seconds(stages)), count="")

    def advance(self, stage: str, points: int, seconds: float) -> None:
        """Move the bars of the stage and of the whole."""
        task, whole = self._tasks[stage], self._stages[stage]
        if self._done[stage] == whole.before:
            self._bars.start_task(task)
        self._done[stage] += points
        self._bars.update(task, advance=points, count=f"{self._done[stage]}/{whole.points}")
        self._bars.update(self._whole, advance=seconds)


class Lines:
    """A line when a stage ends, and every EVERY seconds between; the time left from the speed so far."""

    def __init__(
        self, console: Console, stages: Mapping[str, Stage], jobs: int, deadline: Deadline | None = None
    ) -> None:
        self._console, self._stages, self._jobs, self._deadline = console, stages, jobs, deadline
        self._done = {name: stage.before for name, stage in stages.items()}
        self._total = _seconds(stages)
        self._spent = 0.0  # predicted compute time of what is done, s
        self._begin = self._last = time.monotonic()

    def advance(self, stage: str, points: int, seconds: float) -> None:
        """Print a line if the last one is old enough."""
        self._done[stage] += points
        self._spent += seconds
        now = time.monotonic()
        if self._done[stage] < self._stages[stage].points and now - self._last < EVERY:
            return
        self._last = now
        count = f"{self._done[stage]} of {self._stages[stage].points} points"
        self._console.print(f"{now - self._begin:6.0f} s  {stage}: {count}, {self._left(now):.0f} s left", style=None)

    def _left(self, now: float) -> float:
        """Predicted time left, corrected by how the prediction has fared so far."""
        left = max(self._total - self._spent, 0.0)
        predicted = left * (now - self._begin) / self._spent if self._spent > 0.0 else self._total / self._jobs
        return predicted if self._deadline is None else max(0.0, min(predicted, self._deadline.left))


def _seconds(stages: Mapping[str, Stage]) -> float:
    """Compute time predicted for everything, s."""
    return sum(stage.seconds for stage in stages.values())
