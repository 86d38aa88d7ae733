"""
Plant the mistakes of the register, one at a time, and run the tests that should see each.

python tests/mistakes/plant.py [PACKAGE ...] [--only N ...] [--jobs J]; N counts the mistakes of a package from 1.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import SimpleQueue

from register import PACKAGES, ROOT, Mistake, mistakes_in

LONGEST = 1200  # s: a mistake that makes a test hang is seen
LEFT_OUT = shutil.ignore_patterns(".git", ".venv*", ".nox", ".*_cache", ".hypothesis", "__pycache__", "build")
PASSED, FAILED, NO_TESTS = 0, 1, 5  # exit codes of pytest
GOOD = {"killed", "killed by a long test", "equivalent"}


def run_tests(copy: Path, tests: tuple[str, ...], marked: str) -> int:
    """Run tests in a copy of the tree, which has builds of its own, and return pytest's exit code."""
    words = ["-x", "-q", "-p", "no:cacheprovider", "--benchmark-disable", "-m", marked, *tests]
    environment = {**os.environ, "PYTHONPATH": str(copy), "NUMBA_CACHE_DIR": str(copy.parent / "builds")}
    command = [sys.executable, "-m", "pytest", *words]
    with open(copy.parent / "output", "w") as output:
        try:
            done = subprocess.run(
                command, cwd=copy, env=environment, stdout=output, stderr=output, timeout=LONGEST, check=False
            )
        except subprocess.TimeoutExpired:
            return FAILED
    return done.returncode


def judge(copy: Path, mistake: Mistake) -> str:
    """Run the short tests that should see the mistake, and the long ones if none of these does."""
    for marked, verdict in (("not long", "killed"), ("long", "killed by a long test")):
        code = run_tests(copy, mistake.seen_by, marked)
        if code == FAILED:
            return verdict
        if code not in (PASSED, NO_TESTS):
            return f"pytest ends with {code}"
    return "survived"


def plant(copy: Path, mistake: Mistake) -> str:
    """Judge a mistake in a copy, and restore the file with its times, which tell whether a build is still good."""
    if mistake.equivalent:
        return "equivalent"
    path = copy / mistake.file
    text, times = path.read_text(encoding="utf-8"), path.stat()
    if text.count(mistake.right) != 1:
        return f"stands there {text.count(mistake.right)} times"
    path.write_text(text.replace(mistake.right, mistake.wrong), encoding="utf-8")
    try:
        return judge(copy, mistake)
    finally:
        path.write_text(text, encoding="utf-8")
        os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("packages", nargs="*", metavar="PACKAGE", choices=[*PACKAGES, []], default=list(PACKAGES))
    parser.add_argument("--only", nargs="+", type=int, metavar="N")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    asked = parser.parse_args()
    chosen = [
        (f"{package} {number}", mistake)
        for package in asked.packages
        for number, mistake in enumerate(mistakes_in(package), 1)
        if not asked.only or number in asked.only
    ]
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(asked.jobs) as pool:
        free: SimpleQueue[Path] = SimpleQueue()
        for job in range(asked.jobs):
            copy = Path(folder) / str(job) / "tree"
            shutil.copytree(ROOT, copy, ignore=LEFT_OUT)
            free.put(copy)

        def verdict_of(name: str, mistake: Mistake) -> str:
            copy = free.get()
            try:
                verdict = plant(copy, mistake)
            finally:
                free.put(copy)
            print(f"{name}: {verdict}: {mistake.file}: {mistake.breaks} {mistake.equivalent}".rstrip(), flush=True)
            return verdict

        tests = tuple(dict.fromkeys(test for _, mistake in chosen for test in mistake.seen_by))
        copy = free.get()
        if tests and run_tests(copy, tests, "long or not long") not in (PASSED, NO_TESTS):
            print((copy.parent / "output").read_text(), "These tests fail without a mistake.", sep="\n")
            return 1
        free.put(copy)
        verdicts = Counter(pool.map(lambda pair: verdict_of(*pair), chosen))
    print(", ".join(f"{count} {verdict}" for verdict, count in verdicts.most_common()))
    return int(not set(verdicts) <= GOOD)


if __name__ == "__main__":
    sys.exit(main())
