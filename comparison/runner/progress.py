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

LINE_INTERVAL = 15.0  # s, shortest time between two lines of progress when output goes to a file or a pipe
ROUGH_COST_SHARE = 0.1  # share of all work that counts as done at its estimated cost in the speed for the time left
PLAIN_WIDTH = 120  # width in letters of output that goes to a file or a pipe
EXIT_SECONDS = 0.3  # s before the deadline at which work is stopped, because the process takes so long to end
MIN_TIMER = 1e-3  # s, shortest time to which the timer is set: 0 would switch it off


def make_wide_console() -> Console:
    """Return a console on standard output, as wide as the terminal, or PLAIN_WIDTH without one."""
    width = None if sys.stdout.isatty() else PLAIN_WIDTH
    return Console(highlight=False, markup=False, emoji=False, width=width)


class Display:
    """
    Progress of a command: work done, total work and time left; `show` is called whenever work is done.

    The time left follows from the speed so far, in which a tenth of all work counts as if done at its estimated cost.
    The first piece of work is left out of it, because it starts the workers.
    """

    def __init__(self, total: float, jobs: int, show: Callable[[Display], None] = lambda display: None) -> None:
        """
        Start timing.

        total: estimated processor time of all work, s. jobs: number of workers. show: called when work is done.
        """
        self.total, self._jobs, self._show, self.done = total, jobs, show, 0.0
        self._what = ""
        self.begin = time.monotonic()
        # Time at which the first piece of work was done, and estimated cost of the work done by then, s
        self._first: tuple[float, float] | None = None

    def advance(self, what: str, count: str, seconds: float) -> None:
        """
        Record finished work.

        what: name of its stage. count: how much of the stage is done, "n of m". seconds: its estimated processor time.
        """
        self.done += seconds
        if self._first is None:
            self._first = time.monotonic(), self.done
        self._what = f"{what}: {count}"
        self._show(self)

    def skip(self, seconds: float) -> None:
        """Subtract work that need not be done from the total; seconds: its estimated processor time."""
        self.total -= seconds

    def extend(self, seconds: float) -> None:
        """Add work to the total; seconds: its estimated processor time."""
        self.total += seconds

    @property
    def text(self) -> str:
        """Return in words the work done last, and the time left."""
        return f"{self._what}, about {self.seconds_left:.0f} s left"

    @property
    def seconds_left(self) -> float:
        """Return the estimated time until all work is done, s."""
        work, now = max(self.total - self.done, 0.0), time.monotonic()
        # wall time per second of work: that of the work done since the first piece, and of the tenth that is assumed
        before, earlier = self._first or (now, self.done)
        rough = max(ROUGH_COST_SHARE * self.total, 1.0)
        return work * (now - before + rough / self._jobs) / (self.done - earlier + rough)


@contextmanager
def show_progress(console: Console, total: float, jobs: int) -> Iterator[Display]:
    """Show progress during a block and yield its display; total: estimated s of processor time; jobs: workers."""
    if console.is_terminal:
        with Progress(BarColumn(), TextColumn("{task.fields[text]}", markup=False), console=console) as bars:
            bar = bars.add_task("", total=total, text="starting")
            yield Display(total, jobs, lambda now: bars.update(bar, total=now.total, completed=now.done, text=now.text))
        return
    last = time.monotonic()

    def line(display: Display) -> None:
        """Print the progress as a line of text, at most one in LINE_INTERVAL."""
        nonlocal last
        if (now := time.monotonic()) - last >= LINE_INTERVAL:
            last = now
            console.print(f"{now - display.begin:6.0f} s  {display.text}", style=None)

    yield Display(total, jobs, line)


class TimeUpError(BaseException):
    """Raised when the deadline has come; not an Exception, so that it is not taken for an error of a task."""


class Deadline:
    """Context manager that stops its block by raising TimeUpError shortly before a deadline, if there is one."""

    def __init__(self, begin: float, seconds: float | None) -> None:
        """Set the deadline `seconds` after `begin`, s of `time.monotonic()`; None for no deadline."""
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
        """Set the timer so that the block stops `seconds` earlier, which leaves that time for work after it."""
        if self._end is not None:
            signal.setitimer(signal.ITIMER_REAL, max(self._end - seconds - time.monotonic(), MIN_TIMER))


def _raise_time_up(number: int, frame: FrameType | None) -> NoReturn:
    """Raise TimeUpError; called by the system when the timer of the deadline ends."""
    raise TimeUpError
