"""Environment on which a computed number depends besides its question (code, versions), and its words for a report."""

import ast
import hashlib
import os
import platform
import subprocess
import sys
from collections.abc import Iterable, Mapping
from functools import cache
from importlib import import_module
from importlib.metadata import PackageNotFoundError, packages_distributions, version
from importlib.util import find_spec
from pathlib import Path

from reference.support.version import __version__

COMPUTING_PACKAGES = ("exudyn", "llvmlite", "numba", "numpy", "scipy")  # With another version, results are made anew.
OWN_PACKAGES = ("reference", "multibody", "comparison")  # packages of this project
# Module that calls users' engines: only its own source is hashed, as the engines' settings hold hashes of theirs
USER_MODELS = "comparison.study.user_models"
SHARED_MODULES = ("reference.problem", "comparison.study.batches")  # modules through which every model is called
# Packages whose versions a report states
REPORTED_PACKAGES = ("exudyn", "numba", "numpy", "scipy", "xarray", "h5netcdf", "matplotlib")
# Stored results of analyses, which may hold figures, are also made anew if one of these packages has another version
DRAWING_PACKAGES = ("matplotlib", "pillow", "xarray")
# Modules whose source code a stored result of an analysis depends on: if it changes, the result is computed again
ANSWERING_MODULES = ("reference", "multibody", "comparison.study", "comparison.analyses", "comparison.wording")


def fingerprint_environment(model: str) -> dict[str, str]:
    """Return all that results of a model's function ("package:name") depend on: package versions, source hashes."""
    module = model.split(":")[0]
    return _describe_environment(
        COMPUTING_PACKAGES, (*SHARED_MODULES, module if module == USER_MODELS else module.split(".")[0])
    )


def fingerprint_task_environment(module: str) -> dict[str, str]:
    """Return all that the result of a task of this module depends on: package versions, and hashes of source code."""
    return _describe_environment(
        (*COMPUTING_PACKAGES, *DRAWING_PACKAGES), (*ANSWERING_MODULES, module.rpartition(".")[0] or module)
    )


def _describe_environment(packages: Iterable[str], sources: Iterable[str]) -> dict[str, str]:
    """Return versions of Python, machine and packages, and hashes of the modules' source code, by name."""
    return {
        "python": platform.python_version(),
        "machine": platform.machine(),
        "exudyn module": os.environ.get("EXUDYN_MODULE", ""),
        **{name: _read_version(name) for name in packages},
        **{f"source of {name}": hash_source(name) for name in sources},
    }


def fingerprint_engine(module: str) -> dict[str, str]:
    """
    Return what the results of a user's engine depend on: hashes of its source code, versions of packages it imports.
    """
    package = module.split(".")[0]
    spec = find_spec(package)
    # A namespace package (a folder without __init__.py) has no source file: take the module alone.
    names = {package if spec is not None and spec.origin is not None else module}
    file = find_spec(module)
    if file is not None and file.origin is not None and file.origin.endswith(".py"):
        names |= _list_imported_packages(Path(file.origin).read_text(encoding="utf-8"))
    installed = _list_installed_packages()
    versions = {part: version(part) for name in names for part in installed.get(name.split(".")[0], ())}
    local = {name for name in names if name in OWN_PACKAGES or name.split(".")[0] not in installed}
    return {
        **{name: versions[name] for name in sorted(versions)},
        **{f"source of {name}": hash_source(name) for name in sorted(local)},
    }


@cache
def _list_installed_packages() -> Mapping[str, list[str]]:
    """Return by import name the distributions (names for pip) that provide it; this takes half a second."""
    return packages_distributions()


def _list_imported_packages(source: str) -> set[str]:
    """Return the names of packages that a module's source code imports, without Python's standard library."""
    names = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names.add(node.module.split(".")[0])
    return names - set(sys.stdlib_module_names)


@cache
def hash_source(name: str) -> str:
    """Return a hash of the source code of a module or package; "absent" if it is not installed."""
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
def _read_version(name: str) -> str:
    """Return the version of an installed package; "absent" if it is not installed."""
    try:
        return version(name)
    except PackageNotFoundError:
        return "absent"


def describe_provenance() -> dict[str, str]:
    """Return versions, machine and git commit, as the report lists them."""
    return {
        "phase-resonance": __version__,
        "commit": _read_commit(),
        "python": platform.python_version(),
        **{name: version(name) for name in REPORTED_PACKAGES},
        "exudyn module": import_module("multibody.models.engine").MODULE,
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        "processor": _read_processor_name(),
        "processors": str(os.cpu_count()),
    }


def _read_commit() -> str:
    """Return the git commit of this package, also whether files were changed since; or that it is no git checkout."""
    folder = Path(__file__).resolve().parents[2]
    try:
        if Path(ask_git(folder, "rev-parse", "--show-toplevel")).resolve() != folder:
            return "installed, not a checkout"
        changed = ask_git(folder, "status", "--porcelain", "--untracked-files=no")
        return ask_git(folder, "rev-parse", "HEAD") + (" with uncommitted changes" if changed else "")
    except (OSError, subprocess.CalledProcessError):
        return "installed, not a checkout"


def ask_git(folder: Path, *arguments: str) -> str:
    """Return what a git command with these arguments prints in a folder. Raises OSError or CalledProcessError."""
    done = subprocess.run(["git", "-C", str(folder), *arguments], capture_output=True, text=True, check=True)
    return done.stdout.strip()


def _read_processor_name() -> str:
    """Return the name of the processor, or the machine type, such as x86_64, if the system does not tell it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()
