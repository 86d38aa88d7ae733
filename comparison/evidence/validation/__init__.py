"""Measured motions, by the equations and by the engine."""
