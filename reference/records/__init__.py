"""Recorded motions: files by format, suites of motions, and the samples that a scene holds."""
