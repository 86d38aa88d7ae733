"""What is computed: scenes, the ladder of models, phases, tiles."""
