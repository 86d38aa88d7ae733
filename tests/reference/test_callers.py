"""The reference is called from a script on standard input and from a thread, without a guard for its main module."""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

import reference

ROOT = Path(__file__).parents[2]
PHASES = [(0.3, 1.1), (2.0, 0.7)]
SCRIPT = f"""
import reference
result = reference.amplification(reference.load_scene("fig4-dry"), {PHASES}, "small", tolerance=1e-4)
print(*result.mu.ravel().tolist())
"""


def answer() -> np.ndarray:
    return reference.amplification(reference.load_scene("fig4-dry"), PHASES, "small", tolerance=1e-4).mu


def test_a_script_on_standard_input_has_the_same_answer() -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-"], input=SCRIPT, cwd=ROOT, env=environment, capture_output=True, text=True, check=True
    )
    assert [float(word) for word in done.stdout.split()] == answer().ravel().tolist()


def test_threads_have_the_answer_of_the_main_thread() -> None:
    with ThreadPoolExecutor(2) as pool:
        first, second = (pool.submit(answer) for _ in range(2))
    np.testing.assert_array_equal(first.result(), answer())
    np.testing.assert_array_equal(second.result(), answer())
