"""One bar for a whole command, or plain lines where there is no terminal: what is done, and the time left."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

EVERY = 15.0  # s between plain lines
TRUSTED = 0.1  # share of the work, that the rough costs count beside the work done
PLAIN_WIDTH = 120  # columns of a table that goes to a file or a pipe


def wide_console() -> Console:
    """Standard output, as wide as the terminal or PLAIN_WIDTH columns; texts are no markup."""
    width = None if sys.stdout.isatty() else PLAIN_WIDTH
    return Console(highlight=False, markup=False, emoji=False, width=width)


class Display:
    """
    How far a command is.

    The time left is what is left of the work, times what the work so far took, with a tenth of all work as if it had
    taken its rough cost. The first piece of work does not count: it starts the workers.

    total: all work, rough s of processor time; jobs: workers.
    """

    def __init__(self, total: float, jobs: int) -> None:
        self.total, self._jobs, self.done = total, jobs, 0.0
        self.what, self.count = "", ""
        self.begin = time.monotonic()
        self._first: tuple[float, float] | None = None  # when the first piece was done, and how much was done then

    def advance(self, what: str, count: str, seconds: float) -> None:
        """Work of rough `seconds` is done: what, and how many of how many, in words."""
        self.what, self.count, self.done = what, count, self.done + seconds
        if self._first is None:
            self._first = time.monotonic(), self.done
        self.show()

    def skip(self, seconds: float) -> None:
        """Work of rough `seconds` need not be done."""
        self.total -= seconds

    @property
    def left(self) -> float:
        """Time left, s."""
        work, now = max(self.total - self.done, 0.0), time.monotonic()
        before, earlier = self._first or (now, self.done)
        rough = max(TRUSTED * self.total, 1.0)
        return work * (now - before + rough / self._jobs) / (self.done - earlier + rough)

    def show(self) -> None:
        """Show it."""


class Bar(Display):
    """On a terminal."""

    def __init__(self, bars: Progress, total: float, jobs: int) -> None:
        super().__init__(total, jobs)
        self._bars, self._task = bars, bars.add_task("", total=total, count="starting")

    def show(self) -> None:
        """Move the bar."""
        text = f"{self.what}: {self.count}, about {self.left:.0f} s left"
        self._bars.update(self._task, total=self.total, completed=self.done, count=text)


class Lines(Display):
    """Elsewhere: a line every EVERY seconds."""

    def __init__(self, console: Console, total: float, jobs: int) -> None:
        super().__init__(total, jobs)
        self._console, self._last = console, self.begin

    def show(self) -> None:
        """Print a line if the last one is old enough."""
        now = time.monotonic()
        if now - self._last >= EVERY:
            self._last = now
            line = f"{now - self.begin:6.0f} s  {self.what}: {self.count}, about {self.left:.0f} s left"
            self._console.print(line, style=None)


@contextmanager
def progress(console: Console, total: float, jobs: int) -> Iterator[Display]:
    """A display for as long as the block lasts; total: all work, rough s of processor time; jobs: workers."""
    if not console.is_terminal:
        yield Lines(console, total, jobs)
        return
    with Progress(BarColumn(), TextColumn("{task.fields[count]}", markup=False), console=console) as bars:
        yield Bar(bars, total, jobs)
