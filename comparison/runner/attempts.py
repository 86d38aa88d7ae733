"""
The one place where an error of a part costs that part alone: a section, a picture, a table, one file of several.

A command computes, then writes tables and JSON, then draws. What raises outside the results becomes one line, and the
exit code is as without it.
"""

import errno
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TypeVar

from comparison.runner.output import on_stderr, publish_files
from comparison.wording import exception_line
from reference.support.command import OutputError

# errors of a place that takes nothing more: they concern every file that follows, and end the command with code 3
PLACE_IS_FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EIO}
LONGEST = 300  # letters of a line

T = TypeVar("T")


def attempt(what: str, act: Callable[[], T], say: Callable[[str], object] = on_stderr) -> T | None:
    """Return what `act` returns; where it raises return None, and `say` that `what` could not be shown, and why."""
    try:
        return act()
    except OutputError:
        raise
    except Exception as error:
        if isinstance(error, OSError) and error.errno in PLACE_IS_FULL:
            raise
        say(f"{what} could not be shown: {exception_line(error)[:LONGEST]}")
        return None


def publish_made(folder: Path, name: str, make: Callable[[], bytes], command: str) -> list[Path]:
    """Publish the file of a command that `make` returns; where that raises say so, and leave it out."""
    content = attempt(name, make)
    return [] if content is None else publish_files(folder, {name: content}, command)


class LostParts:
    """
    Parts of a whole that could not be made.

    lines: one for each, said on standard error, once. last: the line of the part that failed last.
    """

    def __init__(self, lines: Iterable[str] = ()) -> None:
        self.lines, self.last = [*lines], ""

    def attempt(self, what: str, act: Callable[[], T]) -> T | None:
        """Return what `act` returns; where it raises note the part and return None."""
        return attempt(what, act, self.note)

    def note(self, line: str) -> None:
        """Add the line of a part."""
        self.last = line
        if line not in self.lines:
            self.lines.append(line)
            on_stderr(line)
