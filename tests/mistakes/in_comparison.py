"""Mistakes in `comparison`."""

from register import Mistake

MISTAKES: tuple[Mistake, ...] = ()
