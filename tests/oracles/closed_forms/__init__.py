"""Motions with a closed form, which both sides must reproduce: one case a file. None of them uses a solver."""
