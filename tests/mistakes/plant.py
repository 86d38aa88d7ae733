"""
Plant the mistakes of the register, one at a time, and run the tests that should see each.

python tests/mistakes/plant.py [PACKAGE ...] [--only N ...] [--short] [--jobs J]; N counts those of a package from 1.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from queue import SimpleQueue

from register import PACKAGES, ROOT, Mistake, mistakes_in

LONGEST = 1200  # s
LEFT_OUT = shutil.ignore_patterns(".git", ".venv*", ".nox", ".*_cache", ".hypothesis", "__pycache__", "build")
PASSED, FAILED, NO_TESTS, HANGING = 0, 1, 5, -1  # exit codes of pytest, and none
LONG = "killed by a long test"
GOOD = {"killed", LONG, "equivalent"}


def run_tests(copy: Path, tests: tuple[str, ...], marked: str) -> int:
    """Run tests in a copy of the tree, which has builds of its own, and return pytest's exit code."""
    words = ["-x", "-q", "-p", "no:cacheprovider", "--benchmark-disable", "-m", marked, *tests]
    environment = {**os.environ, "PYTHONPATH": str(copy), "NUMBA_CACHE_DIR": str(copy.parent / "builds")}
    with open(copy.parent / "output", "w") as output, suppress(subprocess.TimeoutExpired):
        told = {"stdout": output, "stderr": output, "timeout": LONGEST}
        return subprocess.run([sys.executable, "-m", "pytest", *words], cwd=copy, env=environment, **told).returncode
    return HANGING


def judge(copy: Path, mistake: Mistake, short: bool) -> str:
    """Run the short tests that should see the mistake, and the long ones if none of these does."""
    code = run_tests(copy, mistake.seen_by, "not long")
    if code in (PASSED, NO_TESTS) and not short:
        code = run_tests(copy, mistake.seen_by, "long")
        return LONG if code == FAILED else "survived"
    if code in (FAILED, HANGING):
        return "killed"
    return "survived" if code in (PASSED, NO_TESTS) else f"pytest ends with {code}"


def plant(copy: Path, mistake: Mistake, short: bool) -> str:
    """Judge a mistake in a copy, and restore the file with its times, which tell whether a build is still good."""
    if mistake.equivalent:
        return "equivalent"
    path = copy / mistake.file
    text, times = path.read_text(encoding="utf-8"), path.stat()
    path.write_text(text.replace(mistake.right, mistake.wrong), encoding="utf-8")
    try:
        verdict = judge(copy, mistake, short)
    finally:
        path.write_text(text, encoding="utf-8")
        os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
    if verdict == LONG and run_tests(copy, mistake.seen_by, "long") != PASSED:
        return "its long tests fail without a mistake"
    return verdict


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("packages", nargs="*", metavar="PACKAGE", choices=[*PACKAGES, []], default=[])
    parser.add_argument("--only", nargs="+", type=int, metavar="N")
    parser.add_argument("--short", action="store_true", help="leave out long tests")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    asked = parser.parse_args()
    chosen = [
        (f"{package} {number}", mistake)
        for package in asked.packages or PACKAGES
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
                verdict = plant(copy, mistake, asked.short)
            finally:
                free.put(copy)
            print(f"{name}: {verdict}: {mistake.file}: {mistake.breaks} {mistake.equivalent}".rstrip(), flush=True)
            return verdict

        tests = tuple(dict.fromkeys(test for _, mistake in chosen for test in mistake.seen_by))
        copy = free.get()
        if tests and run_tests(copy, tests, "not long") not in (PASSED, NO_TESTS):
            print((copy.parent / "output").read_text(), "These tests fail without a mistake.", sep="\n")
            return 1
        free.put(copy)
        verdicts = Counter(pool.map(lambda pair: verdict_of(*pair), chosen))
    print(", ".join(f"{count} {verdict}" for verdict, count in verdicts.most_common()))
    return int(not set(verdicts) <= GOOD)


if __name__ == "__main__":
    sys.exit(main())
