"""Measured motions, by the equations and by the engine: `python -m comparison.validation`."""

from comparison.cli.start import start

if __name__ == "__main__":
    start("comparison.evidence.validation.command")
