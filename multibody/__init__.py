"""The same question put to a multibody engine: rigid bodies, springs, and a compliant contact with friction."""

from multibody.motion import trajectory
from multibody.refusal import refusal
from multibody.surface import amplification

__all__ = ["amplification", "refusal", "trajectory"]
