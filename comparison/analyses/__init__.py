"""What the results say: differences between models, their causes, and further tests beside the surfaces."""
