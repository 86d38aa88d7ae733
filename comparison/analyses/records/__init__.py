"""Recorded ground motions as they were read: length, peaks, zero line, and warnings of implausible values."""
