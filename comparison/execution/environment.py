"""What a computed number depends on besides the question: code and versions, as text that is hashed or compared."""

from __future__ import annotations

import hashlib
import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from pathlib import Path

PACKAGES = ("exudyn", "llvmlite", "numba", "numpy", "scipy")
SHARED = ("reference.problem", "comparison.study.batches")  # what every model is asked through
DRAWING = ("matplotlib", "pillow", "xarray")
ANSWERING = ("reference", "multibody", "comparison.study", "comparison.analysis", "comparison.wording")


def environment_fingerprint(model: str) -> dict[str, str]:
    """Versions of the packages that compute, and hashes of the source behind the function `model` ("package:name")."""
    sources = dict.fromkeys((*SHARED, model.split(":")[0].split(".")[0]))
    return {
        "python": platform.python_version(),
        "machine": platform.machine(),
        **{name: _version(name) for name in PACKAGES},
        **{f"source of {name}": source_digest(name) for name in sources},
    }


def task_environment_fingerprint(module: str) -> dict[str, str]:
    """The same for what the module computes beside the surfaces: it asks both sides and may draw."""
    sources = (*ANSWERING, module.rpartition(".")[0] or module)
    return {
        "python": platform.python_version(),
        "machine": platform.machine(),
        **{name: _version(name) for name in (*PACKAGES, *DRAWING)},
        **{f"source of {name}": source_digest(name) for name in sources},
    }


@cache
def source_digest(name: str) -> str:
    """Hash of the Python files of a module or package, with their places in it; "absent" if there is none."""
    spec = find_spec(name)
    if spec is None or spec.origin is None:
        return "absent"
    origin = Path(spec.origin)
    folder = origin.parent
    files = sorted(folder.rglob("*.py")) if spec.submodule_search_locations else [origin]
    digest = hashlib.sha256()
    for file in files:
        text = file.read_bytes()
        digest.update(f"{file.relative_to(folder).as_posix()} {len(text)}\n".encode() + text)
    return digest.hexdigest()[:16]


@cache
def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "absent"
