"""The paper's statements about its figures, checked on surfaces in the two readings of (5.1)."""
