"""Conditioning of the amplification mu_i over the smallest speed that is resolved."""
