"""Scenes in which one value runs."""
