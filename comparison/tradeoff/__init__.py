"""The commands `python -m comparison.tradeoff` and `python -m comparison.tradeoff.record`."""
