"""Demands on buildings under a suite of recorded motions, each at several scale factors."""
