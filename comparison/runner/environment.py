"""What a computed number depends on in addition to the question: code and versions; and what a report says of them."""

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

PACKAGES = ("exudyn", "llvmlite", "numba", "numpy", "scipy")
OURS = ("reference", "multibody", "comparison")
USER_MODELS = "comparison.study.user_models"  # calls them; their source is in the settings
SHARED = ("reference.problem", "comparison.study.batches")  # what every model is asked through
SHOWN = ("exudyn", "numba", "numpy", "scipy", "xarray", "h5netcdf", "matplotlib")  # versions in a report
DRAWING = ("matplotlib", "pillow", "xarray")
ANSWERING = ("reference", "multibody", "comparison.study", "comparison.analyses", "comparison.wording")


def environment_fingerprint(model: str) -> dict[str, str]:
    """Versions of the packages that compute, and hashes of the source behind the function `model` ("package:name")."""
    module = model.split(":")[0]
    return _describe_environment(PACKAGES, (*SHARED, module if module == USER_MODELS else module.split(".")[0]))


def task_environment_fingerprint(module: str) -> dict[str, str]:
    """Return the fingerprint of what is computed in addition to the surfaces: it asks both sides and may draw."""
    return _describe_environment((*PACKAGES, *DRAWING), (*ANSWERING, module.rpartition(".")[0] or module))


def _describe_environment(packages: Iterable[str], sources: Iterable[str]) -> dict[str, str]:
    return {
        "python": platform.python_version(),
        "machine": platform.machine(),
        "exudyn module": os.environ.get("EXUDYN_MODULE", ""),
        **{name: _version_of(name) for name in packages},
        **{f"source of {name}": source_digest(name) for name in sources},
    }


def engine_fingerprint(module: str) -> dict[str, str]:
    """
    Return what the numbers of a user's engine depend on: hashes of source behind its module, versions of packages.
    """
    package = module.split(".")[0]
    spec = find_spec(package)
    # a namespace package has no source file
    names = {package if spec is not None and spec.origin is not None else module}
    file = find_spec(module)
    if file is not None and file.origin is not None and file.origin.endswith(".py"):
        names |= _packages_in_use(Path(file.origin).read_text(encoding="utf-8"))
    installed = _installed_packages()
    versions = {part: version(part) for name in names for part in installed.get(name.split(".")[0], ())}
    local = {name for name in names if name in OURS or name.split(".")[0] not in installed}
    return {
        **{name: versions[name] for name in sorted(versions)},
        **{f"source of {name}": source_digest(name) for name in sorted(local)},
    }


@cache
def _installed_packages() -> Mapping[str, list[str]]:
    """Return the distributions of every package that is installed: half a second of looking at their files."""
    return packages_distributions()


def _packages_in_use(source: str) -> set[str]:
    """The packages that a module imports anywhere in its text, without those of Python."""
    names = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names.add(node.module.split(".")[0])
    return names - set(sys.stdlib_module_names)


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
def _version_of(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "absent"


def describe_provenance() -> dict[str, str]:
    """Versions, machine and commit, in the order a report shows them."""
    return {
        "phase-resonance": __version__,
        "commit": _commit_of_checkout(),
        "python": platform.python_version(),
        **{name: version(name) for name in SHOWN},
        "exudyn module": import_module("multibody.models.engine").MODULE,
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        "processor": _processor_name(),
        "processors": str(os.cpu_count()),
    }


def _commit_of_checkout() -> str:
    """Commit of the checkout this package runs from; says so if it has changes, or if there is no checkout."""
    folder = Path(__file__).resolve().parents[2]
    try:
        if Path(ask_git(folder, "rev-parse", "--show-toplevel")).resolve() != folder:
            return "installed, not a checkout"
        changed = ask_git(folder, "status", "--porcelain", "--untracked-files=no")
        return ask_git(folder, "rev-parse", "HEAD") + (" with uncommitted changes" if changed else "")
    except (OSError, subprocess.CalledProcessError):
        return "installed, not a checkout"


def ask_git(folder: Path, *arguments: str) -> str:
    """Return what git says about a folder. Raises OSError or CalledProcessError."""
    done = subprocess.run(["git", "-C", str(folder), *arguments], capture_output=True, text=True, check=True)
    return done.stdout.strip()


def _processor_name() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()
