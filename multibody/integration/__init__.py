"""Runs of an assembled model: adaptive steps, levels of accuracy, peaks, error estimates and the work limit."""
