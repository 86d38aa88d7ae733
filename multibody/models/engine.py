"""Import of the engine without its type stubs, which lack `symbolic` and the `self` of solver methods (1.13)."""

from __future__ import annotations

import sys
import weakref
from importlib import import_module
from typing import Any

# Number of coordinates beyond which a sparse solver is faster than a dense one (a third of its time at 360: measured).
MAX_DENSE_COORDINATES = 40

# Number of coordinates of a rigid body: x, y, z of the center of mass and three rotations.
BODY_COORDINATES = 6

try:
    exudyn: Any = import_module("exudyn")
except ImportError as error:
    reason = " ".join(str(error).split())
    raise ImportError(
        f"the engine Exudyn cannot be loaded (on Debian and Ubuntu it needs the package libgl1): {reason}"
    ) from error
# Loaded variant of Exudyn's C++ module; the environment variable EXUDYN_MODULE=fast selects one without range checks.
MODULE = "fast" if "exudyn.exudynCPPfast" in sys.modules else "default"
items: Any = import_module("exudyn.itemInterface")  # Exudyn's classes of bodies, markers, loads and contacts
# makes a user function from a symbolic expression: Exudyn evaluates it without Python
symbolic_function: Any = import_module("exudyn.advancedUtilities").CreateSymbolicUserFunction


def reset_when_unused(owner: Any, container: Any) -> None:
    """Reset Exudyn's system container when `owner` is no longer used: until then its memory stays allocated."""
    weakref.finalize(owner, container.Reset).atexit = False
