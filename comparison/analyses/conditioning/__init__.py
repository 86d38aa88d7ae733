"""Conditioning of mu_i over the smallest speed that is resolved."""
