"""Progress of a command: one bar, or plain lines without a terminal, with the time left; and its deadline."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import NoReturn

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

LINE_INTERVAL = 15.0  # s, shortest time between two progress lines in a file or a pipe
ROUGH_COST_SHARE = 0.1  # weight, as a share of all work, of costs estimated beforehand in the estimate of the time left
PLAIN_WIDTH = 120  # columns of a table that is written to a file or a pipe
EXIT_SECONDS = 0.3  # s that the process takes to end after the deadline
MIN_TIMER = 1e-3  # s, shortest timer: setitimer(0) would switch it off


def make_wide_console() -> Console:
    """Return a console on standard output, as wide as the terminal or PLAIN_WIDTH columns, without markup."""
    width = None if sys.stdout.isatty() else PLAIN_WIDTH
    return Console(highlight=False, markup=False, emoji=False, width=width)


class Display:
    """
    Progress of a command, shown by `show` whenever work is done.

    The time left is what is left of the work, times what the work so far took, with a tenth of all work as if it had
    taken its rough cost. The first piece of work does not count: it starts the workers.

    total: all work, rough s of processor time; jobs: workers.
    """

    def __init__(self, total: float, jobs: int, show: Callable[[Display], None] = lambda display: None) -> None:
        """Start the clock with no work done."""
        self.total, self._jobs, self._show, self.done = total, jobs, show, 0.0
        self._what = ""
        self.begin = time.monotonic()
        # Time at which the first piece of work was done, and the work done by then
        self._first: tuple[float, float] | None = None

    def advance(self, what: str, count: str, seconds: float) -> None:
        """Record that work of rough `seconds` is done: what, and how many of how many, in words."""
        self.done += seconds
        if self._first is None:
            self._first = time.monotonic(), self.done
        self._what = f"{what}: {count}"
        self._show(self)

    def skip(self, seconds: float) -> None:
        """Subtract work of rough `seconds` that need not be done."""
        self.total -= seconds

    def extend(self, seconds: float) -> None:
        """Add work of rough `seconds`."""
        self.total += seconds

    @property
    def text(self) -> str:
        """Return the work done last, and the time left."""
        return f"{self._what}, about {self.seconds_left:.0f} s left"

    @property
    def seconds_left(self) -> float:
        """Return the time left, s."""
        work, now = max(self.total - self.done, 0.0), time.monotonic()
        before, earlier = self._first or (now, self.done)
        rough = max(ROUGH_COST_SHARE * self.total, 1.0)
        return work * (now - before + rough / self._jobs) / (self.done - earlier + rough)


@contextmanager
def show_progress(console: Console, total: float, jobs: int) -> Iterator[Display]:
    """Yield a display for the duration of the block; total: all work, rough s of processor time; jobs: workers."""
    if console.is_terminal:
        with Progress(BarColumn(), TextColumn("{task.fields[text]}", markup=False), console=console) as bars:
            bar = bars.add_task("", total=total, text="starting")
            yield Display(total, jobs, lambda now: bars.update(bar, total=now.total, completed=now.done, text=now.text))
        return
    last = time.monotonic()

    def line(display: Display) -> None:
        """Print the progress as a plain line, at most every LINE_INTERVAL."""
        nonlocal last
        if (now := time.monotonic()) - last >= LINE_INTERVAL:
            last = now
            console.print(f"{now - display.begin:6.0f} s  {display.text}", style=None)

    yield Display(total, jobs, line)


class TimeUpError(BaseException):
    """Signal that the deadline has come; no Exception, so that it is not taken for an error of a task."""


class Deadline:
    """Context that stops its block by TimeUpError shortly before `begin + seconds` (`time.monotonic()`), or never."""

    def __init__(self, begin: float, seconds: float | None) -> None:
        """Set the end of the block; seconds: None for no deadline."""
        self._end = None if seconds is None else begin + seconds - EXIT_SECONDS

    def __enter__(self) -> Deadline:
        """Start the timer that raises TimeUpError in the block."""
        if self._end is not None:
            self._before = signal.signal(signal.SIGALRM, _raise_time_up)
            self.keep_free(0.0)
        return self

    def __exit__(self, *error: object) -> None:
        """Stop the timer and restore the earlier handler of its signal."""
        if self._end is not None:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            signal.signal(signal.SIGALRM, self._before)

    def keep_free(self, seconds: float) -> None:
        """Stop the block `seconds` before the end from now on, for work that has to follow."""
        if self._end is not None:
            signal.setitimer(signal.ITIMER_REAL, max(self._end - seconds - time.monotonic(), MIN_TIMER))


def _raise_time_up(number: int, frame: FrameType | None) -> NoReturn:
    """Raise TimeUpError; handler of the timer's signal."""
    raise TimeUpError
