"""
A recording of the README's command: when its lines, its pages and its end come.

`python tests/benchmarks/first_command.py [OPTIONS OF comparison.run]` records it with every cache empty, compiled code
included, and once more with everything stored.
"""

import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

PROJECT = Path(__file__).parents[2]
EVERY = 0.05  # s


@dataclass
class Recording:
    """Of one run: its exit code, how long it took, s, and its pages, each with its time, s, and its summary.json."""

    code: int = 0
    seconds: float = 0.0
    pages: list[tuple[float, dict[str, Any]]] = field(default_factory=list)


def recorded(folder: Path, *options: str, compiled: bool = False) -> Recording:
    """Run the command with its report in `folder`, and print each event; compiled: with the user's compiled code."""
    summary, run, begin = folder / "report" / "summary.json", Recording(), time.monotonic()
    apart = {} if compiled else {"XDG_CACHE_HOME": str(folder / "cache"), "NUMBA_CACHE_DIR": str(folder / "numba")}
    environment = {**os.environ, **apart, "PYTHONUNBUFFERED": "1", "PYTHONPATH": str(PROJECT)}
    command = [sys.executable, "-m", "comparison.run", "--out", str(folder / "report"), *options]
    process = subprocess.Popen(command, cwd=folder, env=environment, stdout=subprocess.PIPE, text=True)

    def event(text: str) -> float:
        seconds = time.monotonic() - begin
        print(f"{seconds:7.1f} s  {text}", flush=True)
        return seconds

    def print_lines() -> None:
        assert process.stdout is not None
        with process.stdout:
            for line in process.stdout:
                event(line.rstrip())

    def written() -> str:
        with suppress(FileNotFoundError):  # before the first report, and while one takes the place of another
            return summary.read_text("utf-8")
        return last

    last, goes_on = "", True
    last, printer = written(), threading.Thread(target=print_lines)
    printer.start()
    while goes_on:
        goes_on = process.poll() is None
        if (now := written()) != last:
            last = now
            run.pages.append((event(f"PAGE {len(run.pages) + 1}"), json.loads(now)))
        time.sleep(EVERY)
    printer.join()
    run.code, run.seconds = process.wait(), event(f"END, load {os.getloadavg()[0]:.1f}")
    return run


def print_costs(run: Recording) -> None:
    """Print the processor time of a run by model and stage."""
    _, results = run.pages[-1]
    seconds: Counter[str] = Counter()
    for scene in results["scenes"]:
        for key, model in scene["models"].items():
            seconds[f"model {key}"] += model["cost"]
    seconds.update({stage: part["seconds"] for stage, part in results["run"]["parts"].items()})
    print(f"processor time {results['run']['processor_seconds']:.0f} s, of which")
    for name, spent in seconds.most_common():
        print(f"{spent:9.1f} s  {name}")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as place:
        for title in ("empty caches", "everything stored"):
            print(f"-- {title}")
            print_costs(recorded(Path(place), *sys.argv[1:]))
