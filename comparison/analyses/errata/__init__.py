"""Effect of the errata of the paper."""
