"""Demands over all phases."""
