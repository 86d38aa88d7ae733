"""
The same question put to a multibody engine: rigid bodies, springs, and a compliant contact with friction.

The engine is loaded on first use, so that a command can be stopped while it loads.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from multibody.integration.work_limit import refusal
    from multibody.motion import trajectory
    from multibody.surface import amplification

ENGINE = {
    "amplification": "multibody.surface",
    "refusal": "multibody.integration.work_limit",
    "trajectory": "multibody.motion",
}

__all__ = ["amplification", "refusal", "trajectory"]


def __getattr__(name: str) -> Any:
    if name in ENGINE:
        return getattr(import_module(ENGINE[name]), name)
    raise AttributeError(f"module 'multibody' has no attribute '{name}'")
