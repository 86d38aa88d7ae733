"""Recorded motions as they were read: size, peaks, zero line, and what is hardly meant."""
