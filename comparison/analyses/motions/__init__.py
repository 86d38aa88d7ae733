"""Motions at chosen phase pairs."""
