"""The paper's claims, checked on surfaces under readings of what the paper leaves open."""
