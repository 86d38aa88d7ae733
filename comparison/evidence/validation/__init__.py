"""Measured motions beside what both sides compute."""
