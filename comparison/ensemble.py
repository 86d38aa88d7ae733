"""Demands under a suite of motions at many intensities: `python -m comparison.ensemble SCENE --suite SUITE`."""

from comparison.cli.start import start

if __name__ == "__main__":
    start("comparison.analyses.ensemble.command")
