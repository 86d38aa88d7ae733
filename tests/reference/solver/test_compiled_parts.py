"""Parts of a compiled function are built with it and nowhere else."""

import gc
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numba import njit
from numba.core.errors import TypingError
from numba.extending import overload

import reference
from reference.build_cache import cached_on_disk
from reference.solver.compiled.parts import compiled_part


def gc_is_on():
    """Stands for what a compiled function calls."""


@compiled_part()
def doubled(values, k):
    return 2.0 * values[k]


@compiled_part()
def summed(values):
    total = 0.0
    for k in range(values.shape[0]):
        total += doubled(values, k)
    return total


@njit
def entry(count):
    """Makes an array, which its parts read and which it keeps until it returns."""
    values = np.arange(count) * 1.0
    return summed(values) + values[count - 1]


def test_a_part_has_no_machine_code_and_counts_no_references() -> None:
    assert entry(5) == 2.0 * 10.0 + 4.0
    for part in (doubled, summed):
        (built,) = part.overloads.values()
        assert built.library.get_pointer_to_function(built.fndesc.mangled_name) == 0
        assert "NRT_incref" not in str(built.library._final_module)


def test_python_searches_for_garbage_again_after_compiling(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))

    @cached_on_disk(__file__)
    def sound(x):
        return x + 1.0, gc_is_on()

    @cached_on_disk(__file__)
    def unsound(x):
        return x + "1"

    seen = []

    @overload(gc_is_on)
    def _gc_is_on():
        seen.append(gc.isenabled())
        return lambda: True

    assert sound(1.0) == (2.0, True)
    assert seen
    assert not any(seen)
    assert gc.isenabled()
    with pytest.raises(TypingError):
        unsound(1.0)
    assert gc.isenabled()


UNKNOWN_NUMBA = """
import reference.solver.compiled.parts as parts
parts.NEWEST_KNOWN = 0, 0
import reference
print(reference.amplification(reference.load_scene("fig3-I"), [(0.3, 1.1)]).mu.tolist())
"""


@pytest.mark.long  # compiles the solver as numba compiles functions
def test_with_a_numba_that_is_not_known_the_numbers_are_the_same(tmp_path: Path) -> None:
    run = subprocess.run(
        [sys.executable, "-c", UNKNOWN_NUMBA],
        env={**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)},
        capture_output=True,
        text=True,
        check=True,
    )
    expected = reference.amplification(reference.load_scene("fig3-I"), [(0.3, 1.1)])
    assert run.stdout.strip() == str(expected.mu.tolist())
