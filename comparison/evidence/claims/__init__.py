"""The paper's statements about its figures in both readings of (5.1)."""
