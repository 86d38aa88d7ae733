"""What is said when a run ends before its report: what is kept, and the command that goes on from there."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Sequence

from comparison.execution.cache import Cache
from comparison.execution.keys import ANALYSIS, BATCH
from comparison.study.study import Study


def invocation(command: str) -> list[str]:
    """The words that start a command: those of the console script where it was started by that."""
    script = ["phase-resonance", command]
    return script if sys.argv[0] == " ".join(script) else ["python", "-m", f"comparison.{command}"]


def command_line(words: Sequence[str], command: str = "run") -> str:
    """The command as it is typed."""
    return shlex.join([*invocation(command), *words])


def resume_hint(cache: Cache, study: Study, words: Sequence[str]) -> str:
    """How much is kept where, and the command for the rest: the same one, without what would throw it away."""
    rest = [word for word in words if word != "--fresh"]
    others = f" and {cache.kept[ANALYSIS]} analyses" if cache.kept[ANALYSIS] else ""
    kept = f"{cache.kept[BATCH]} of {len(study.batches())} batches{others} are kept in {str(cache.folder)!r}"
    return f"{kept}; go on with: {command_line(rest)}"


def without_scheduler(words: Sequence[str]) -> list[str]:
    """The words of the command without the cluster: the same numbers from the processes of this machine."""
    rest, words = [], list(words)
    while words:
        word = words.pop(0)
        if word == "--scheduler":
            words = words[1:]
        elif not word.startswith("--scheduler="):
            rest.append(word)
    return rest
