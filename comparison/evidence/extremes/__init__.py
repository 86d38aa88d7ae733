"""Every model at the extremes of every quantity."""
