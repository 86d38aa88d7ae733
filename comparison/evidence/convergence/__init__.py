"""What the steps between models tend to."""
