"""The compiled solver gives the same numbers on every processor, in every process and in threads."""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from numpy._core._multiarray_umath import __cpu_features__  # what this processor has, by NumPy's names

from reference.build_cache import build_folder
from reference.solver import chain, collocation

ROOT = Path(__file__).parents[2]
NAMES = ("NODES", "A", "A2", "AT_START", "MONOMIALS", "EIGENVALUES", "TO_CHANNELS", "FROM_CHANNELS")
NAMES_OF_CHAIN = ("ONES_IN_CHANNELS", "NODES_IN_CHANNELS", "THROUGH_REAL", "THROUGH_IMAGINARY")
# kernels of OpenBLAS, and what a processor must have to run them
KERNELS = {"Prescott": ("SSE3",), "Haswell": ("AVX2", "FMA3"), "SkylakeX": ("AVX512_SKX",)}
CONSTANTS = f"""
import sys
from reference.solver import chain, collocation
for module, names in ((collocation, {NAMES}), (chain, {NAMES_OF_CHAIN})):
    for name in names:
        sys.stdout.buffer.write(getattr(module, name).tobytes())
"""


def lacking(kernels: str) -> list[str]:
    """What kernels need and a processor does not have: they would end in an illegal instruction."""
    return [feature for feature in KERNELS[kernels] if not __cpu_features__.get(feature)]


@pytest.mark.parametrize("kernels", KERNELS)
def test_the_constants_do_not_depend_on_linear_algebra(kernels: str) -> None:
    if lacking(kernels):
        pytest.skip(f"kernels {kernels} need {', '.join(lacking(kernels))}, which this processor does not have")
    words = [sys.executable, "-c", CONSTANTS]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OPENBLAS_CORETYPE": kernels}
    other = subprocess.run(words, cwd=ROOT, env=environment, check=True, capture_output=True).stdout
    here = [getattr(collocation, name).tobytes() for name in NAMES]
    here += [getattr(chain, name).tobytes() for name in NAMES_OF_CHAIN]
    assert other == b"".join(here)


def test_the_constants_of_the_method_are_accurate_to_rounding() -> None:
    again = (collocation.FROM_CHANNELS * collocation.EIGENVALUES) @ collocation.TO_CHANNELS
    np.testing.assert_allclose(again.real, collocation.A, rtol=0.0, atol=2e-14)
    np.testing.assert_allclose((collocation.FROM_CHANNELS @ collocation.TO_CHANNELS).real, np.eye(7), atol=1e-13)
    np.testing.assert_allclose(collocation.A.sum(axis=1), collocation.NODES, rtol=0.0, atol=1e-15)
    powers = np.arange(1, 13)  # the quadrature of the last stage has order 13
    moments = (collocation.NODES[:, None] ** (powers - 1)).T @ collocation.A[-1]
    np.testing.assert_allclose(moments, 1.0 / powers, rtol=0.0, atol=1e-15)


def test_no_part_of_the_solver_may_reorder_sums() -> None:
    """Such freedom is used otherwise on another processor, and otherwise where a part is not inlined."""
    from reference.solver.run import runs

    assert not runs.targetoptions.get("fastmath")


def folder_of_builds(**environment: str) -> Path:
    """Where another process keeps what it compiles of the solver."""
    ask = "from reference.solver.run import runs; print(runs.stats.cache_path)"
    environment = {**os.environ, "PYTHONPATH": str(ROOT), **environment}
    run = subprocess.run([sys.executable, "-c", ask], cwd=ROOT, env=environment, check=True, capture_output=True)
    return Path(os.fsdecode(run.stdout.strip())).parent


def test_a_cache_folder_holds_a_build_per_version_of_the_source(tmp_path: Path) -> None:
    chosen = folder_of_builds(NUMBA_CACHE_DIR=str(tmp_path))
    assert chosen.parent == tmp_path
    build = build_folder(ROOT / "reference" / "solver")
    assert build is not None
    assert chosen.name == build.name


ASKED = """
import reference
result = reference.amplification(reference.load_scene("fig4-dry"), [(0.3, 1.1), (2.0, 0.7)], "small", tolerance=1e-4)
mu = result.mu.ravel().tolist()
"""


def answer(*_: object) -> list[float]:
    names: dict[str, list[float]] = {}
    exec(ASKED, names)
    return names["mu"]


def test_a_script_on_standard_input_and_threads_have_the_same_answer() -> None:
    """Without a guard for the main module."""
    words, environment = ASKED + "print(*mu)", {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-"], input=words, cwd=ROOT, env=environment, capture_output=True, text=True, check=True
    )
    expected = answer()
    assert [float(word) for word in done.stdout.split()] == expected
    with ThreadPoolExecutor(2) as pool:
        assert list(pool.map(answer, range(2))) == [expected] * 2
