"""Mistakes in `multibody`."""

from register import Mistake

MISTAKES: tuple[Mistake, ...] = ()
