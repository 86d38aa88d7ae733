"""Motions at a few chosen phase pairs, stored for the report."""
