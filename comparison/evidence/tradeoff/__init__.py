"""Speed for accuracy: what every model and every numerical parameter gives for its time, measured."""
