"""Numbers published elsewhere, by the equations and by the engine: `python -m comparison.benchmarks`."""

from comparison.cli.start import start

if __name__ == "__main__":
    start("comparison.evidence.benchmarks.command")
