"""The instant at which a run must be over."""

from __future__ import annotations

import signal
import time
from types import FrameType
from typing import NoReturn

EARLY = 0.3  # s: the process takes so long to end
SOON = 1e-3  # s


class TimeUpError(BaseException):
    """The deadline has come. No Exception: what a task raises must not be taken for it."""


class Deadline:
    """Raises TimeUpError in the block `seconds`, if any, after `begin`, by `time.monotonic()`."""

    def __init__(self, begin: float, seconds: float | None) -> None:
        self._end = None if seconds is None else begin + seconds - EARLY

    def __enter__(self) -> Deadline:
        if self._end is not None:
            self._before = signal.signal(signal.SIGALRM, _up)
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


def _up(number: int, frame: FrameType | None) -> NoReturn:
    raise TimeUpError
