"""What is said when a run ends before its report: what is kept, and the command that goes on from there."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Collection, Sequence

from comparison.runner.cache import Cache
from comparison.runner.task import BATCH, RESULT


def invocation(command: str) -> list[str]:
    """The words that start a command: those of the console script where it was started by that."""
    script = ["phase-resonance", command]
    return script if sys.argv[0] == " ".join(script) else ["python", "-m", f"comparison.{command}"]


def command_line(words: Sequence[str], command: str = "run") -> str:
    """A command as it is typed: its name, and the words after it."""
    return shlex.join([*invocation(command), *words])


def changed(
    words: Sequence[str], added: Sequence[str] = (), flags: Collection[str] = (), options: Collection[str] = ()
) -> list[str]:
    """
    The words of a command line with other options. What stands behind "--" is no option and stays.

    flags, options: names to leave out, of options without a value and with one.

    Examples
    --------
    >>> changed(["--grid", "4", "--fresh", "--", "-a.toml"], ["--plan"], flags=["--fresh"], options=["--grid"])
    ['--plan', '--', '-a.toml']
    """
    end = words.index("--") if "--" in words else len(words)
    kept, before = [], list(words[:end])
    while before:
        word = before.pop(0)
        if word in options:
            before = before[1:]
        elif word not in flags and word.partition("=")[0] not in options:
            kept.append(word)
    return [*kept, *added, *words[end:]]


def resume_hint(cache: Cache, words: Sequence[str], command: str = "run", batches: int | None = None) -> str:
    """How much is kept where, and the command for the rest; batches: number of those of a study."""
    rest = changed(words, flags=["--fresh"])
    tasks = cache.kept[RESULT]
    if batches is None:
        kept = f"{tasks} results are"
    else:
        kept = f"{cache.kept[BATCH]} of {batches} batches{f' and {tasks} analyses' if tasks else ''} are"
    return f"{kept} kept in {str(cache.folder)!r}; go on with: {command_line(rest, command)}"
