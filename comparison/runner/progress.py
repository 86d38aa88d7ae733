"""One bar for a whole command, or plain lines where there is no terminal, with the time left; and its deadline."""

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

EVERY = 15.0  # s between plain lines
TRUSTED = 0.1  # share of the work, that the rough costs count against the work done
PLAIN_WIDTH = 120  # columns of a table that goes to a file or a pipe
EARLY = 0.3  # s: the process takes so long to end
SOON = 1e-3  # s


def wide_console() -> Console:
    """Standard output, as wide as the terminal or PLAIN_WIDTH columns; texts are no markup."""
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
        self.total, self._jobs, self._show, self.done = total, jobs, show, 0.0
        self._what = ""
        self.begin = time.monotonic()
        self._first: tuple[float, float] | None = None  # when the first piece was done, and how much was done then

    def advance(self, what: str, count: str, seconds: float) -> None:
        """Work of rough `seconds` is done: what, and how many of how many, in words."""
        self.done += seconds
        if self._first is None:
            self._first = time.monotonic(), self.done
        self._what = f"{what}: {count}"
        self._show(self)

    def skip(self, seconds: float) -> None:
        """Work of rough `seconds` need not be done."""
        self.total -= seconds

    def extend(self, seconds: float) -> None:
        """Work of rough `seconds` is added."""
        self.total += seconds

    @property
    def text(self) -> str:
        """Return what is done last, and the time left."""
        return f"{self._what}, about {self.seconds_left:.0f} s left"

    @property
    def seconds_left(self) -> float:
        """Time left, s."""
        work, now = max(self.total - self.done, 0.0), time.monotonic()
        before, earlier = self._first or (now, self.done)
        rough = max(TRUSTED * self.total, 1.0)
        return work * (now - before + rough / self._jobs) / (self.done - earlier + rough)


@contextmanager
def show_progress(console: Console, total: float, jobs: int) -> Iterator[Display]:
    """A display for as long as the block lasts; total: all work, rough s of processor time; jobs: workers."""
    if console.is_terminal:
        with Progress(BarColumn(), TextColumn("{task.fields[text]}", markup=False), console=console) as bars:
            bar = bars.add_task("", total=total, text="starting")
            yield Display(total, jobs, lambda now: bars.update(bar, total=now.total, completed=now.done, text=now.text))
        return
    last = time.monotonic()

    def line(display: Display) -> None:
        nonlocal last
        if (now := time.monotonic()) - last >= EVERY:
            last = now
            console.print(f"{now - display.begin:6.0f} s  {display.text}", style=None)

    yield Display(total, jobs, line)


class TimeUpError(BaseException):
    """The deadline has come. No Exception: what a task raises must not be taken for it."""


class Deadline:
    """Raises TimeUpError in the block `seconds`, if any, after `begin`, by `time.monotonic()`."""

    def __init__(self, begin: float, seconds: float | None) -> None:
        self._end = None if seconds is None else begin + seconds - EARLY

    def __enter__(self) -> Deadline:
        if self._end is not None:
            self._before = signal.signal(signal.SIGALRM, _raise_time_up)
            self.keep_free(0.0)
        return self

    def __exit__(self, *error: object) -> None:
        if self._end is not None:
            signal.setitimer(signal.ITIMER_REAL, 0.0)
            signal.signal(signal.SIGALRM, self._before)

    def keep_free(self, seconds: float) -> None:
        """From now on the time is up so much before the end, for what has to follow."""
        if self._end is not None:
            signal.setitimer(signal.ITIMER_REAL, max(self._end - seconds - time.monotonic(), SOON))


def _raise_time_up(number: int, frame: FrameType | None) -> NoReturn:
    raise TimeUpError
