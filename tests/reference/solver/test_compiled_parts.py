"""What the solver does with numba beyond its documentation: nothing is left behind, and nothing depends on it."""

import gc
import os
import subprocess
import sys
from pathlib import Path

import pytest
from numba import types
from numba.core.errors import TypingError
from numba.core.runtime import _nrt_python, rtsys

import reference
from reference.solver.compiled.by_reference import ByReference
from reference.support.build_cache import cache_on_disk


def test_python_searches_for_garbage_again_after_compiling(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))

    @cache_on_disk(__file__)
    def sound(x):
        return x + 1.0

    @cache_on_disk(__file__)
    def unsound(x):
        return x + "1"

    assert sound(1.0) == 2.0
    assert gc.isenabled()
    with pytest.raises(TypingError):
        unsound(1.0)
    assert gc.isenabled()


def test_compiled_functions_are_named_by_the_fields_that_a_structure_lacks() -> None:
    """Functions of one name are one function, whose code is that of the first that is compiled."""

    class Kind(ByReference):
        """A structure of which some lack a field."""

    number = types.float64
    kinds = [[("a", first), ("b", second)] for first in (number, types.none) for second in (number, types.none)]
    assert len({Kind(fields).mangling_args for fields in kinds}) == 4
    assert Kind(kinds[1]).mangling_args == Kind([("a", types.int64), ("b", types.none)]).mangling_args


def test_a_call_returns_the_memory_that_it_took() -> None:
    """Compiled functions pass structures by reference that hold arrays."""
    scene = reference.load_scene("fig3-I").with_values({"duration": 1.0})
    reference.amplification(scene, [(0.3, 1.1)])
    _nrt_python.memsys_enable_stats()
    before = rtsys.get_allocation_stats()
    for _ in range(5):
        reference.amplification(scene, [(0.3, 1.1)])
    after = rtsys.get_allocation_stats()
    _nrt_python.memsys_disable_stats()
    assert after.alloc - before.alloc == after.free - before.free > 0


UNKNOWN_NUMBA = """
import reference.solver.compiled.parts as parts
parts.NEWEST_KNOWN = 0, 0
import reference
print(reference.amplification(reference.load_scene("fig3-I"), [(0.3, 1.1)]).mu.tolist())
"""


@pytest.mark.long  # compiles the solver as numba compiles functions
def test_with_a_numba_that_is_not_known_the_numbers_are_the_same(tmp_path: Path) -> None:
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    run = subprocess.run(
        [sys.executable, "-c", UNKNOWN_NUMBA], env=environment, capture_output=True, text=True, check=True
    )
    expected = reference.amplification(reference.load_scene("fig3-I"), [(0.3, 1.1)])
    assert run.stdout.strip() == str(expected.mu.tolist())
