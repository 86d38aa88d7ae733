"""Largest values over all phases."""
