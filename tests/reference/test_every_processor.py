"""The compiled solver gives the same numbers on every processor, in every process and in threads."""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy._core._multiarray_umath import __cpu_features__  # what this processor has, by NumPy's names

from reference.solver import collocation
from reference.support.build_cache import build_folder

ROOT = Path(__file__).parents[2]
# kernels of OpenBLAS, and what a processor must have to run them: they would end in an illegal instruction
KERNELS = {"Prescott": ("SSE3",), "Haswell": ("AVX2", "FMA3"), "SkylakeX": ("AVX512_SKX",)}
CONSTANTS = """
from reference.solver import chain, collocation
names = "NODES A A2 AT_START MONOMIALS EIGENVALUES TO_CHANNELS FROM_CHANNELS".split()
result = [getattr(collocation, name).tobytes().hex() for name in names]
names = "ONES_IN_CHANNELS NODES_IN_CHANNELS CHANNEL_RESPONSES_REAL CHANNEL_RESPONSES_IMAGINARY".split()
result += [getattr(chain, name).tobytes().hex() for name in names]
"""
FACTORS = """
import reference
answer = reference.amplification(reference.load_scene("fig4-dry"), [(0.3, 1.1), (2.0, 0.7)], "small", tolerance=1e-4)
result = answer.mu.ravel().tolist()
"""


def elsewhere(code: str, **environment: str) -> str:
    """The result in another process that reads the code on standard input, without a guard for the main module."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), **environment}
    done = subprocess.run(
        [sys.executable, "-"],
        input=code + "print(result)",
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.strip()


def here(code: str) -> Any:
    names: dict[str, Any] = {}
    exec(code, names)
    return names["result"]


@pytest.mark.parametrize("kernels", KERNELS)
def test_the_constants_do_not_depend_on_linear_algebra(kernels: str) -> None:
    lacking = [feature for feature in KERNELS[kernels] if not __cpu_features__.get(feature)]
    if lacking:
        pytest.skip(f"kernels {kernels} need {', '.join(lacking)}, which this processor does not have")
    assert elsewhere(CONSTANTS, OPENBLAS_CORETYPE=kernels) == str(here(CONSTANTS))


def test_the_constants_of_the_method_are_accurate_to_rounding() -> None:
    again = (collocation.FROM_CHANNELS * collocation.EIGENVALUES) @ collocation.TO_CHANNELS
    np.testing.assert_allclose(again.real, collocation.A, rtol=0.0, atol=2e-14)
    np.testing.assert_allclose((collocation.FROM_CHANNELS @ collocation.TO_CHANNELS).real, np.eye(7), atol=1e-13)
    np.testing.assert_allclose(collocation.A.sum(axis=1), collocation.NODES, rtol=0.0, atol=1e-15)
    powers = np.arange(1, 13)  # the quadrature of the last stage has order 13
    moments = (collocation.NODES[:, None] ** (powers - 1)).T @ collocation.A[-1]
    np.testing.assert_allclose(moments, 1.0 / powers, rtol=0.0, atol=1e-15)


def test_a_cache_folder_holds_a_build_per_version_and_no_part_may_reorder_sums(tmp_path: Path) -> None:
    """Such freedom is used otherwise on another processor, and otherwise where a part is not inlined."""
    code = (
        "from reference.solver.run import integrate_runs\n"
        "result = integrate_runs.stats.cache_path, integrate_runs.targetoptions.get('fastmath')\n"
    )
    build = build_folder(ROOT / "reference" / "solver")
    assert build is not None
    place, fastmath = eval(elsewhere(code, NUMBA_CACHE_DIR=str(tmp_path)))
    assert (Path(place).parent, fastmath or None) == (tmp_path / build.name, None)


def test_a_script_on_standard_input_and_threads_have_the_same_answer() -> None:
    assert elsewhere(FACTORS) == str(here(FACTORS))
    with ThreadPoolExecutor(2) as pool:
        assert list(pool.map(here, 2 * [FACTORS])) == [here(FACTORS)] * 2
