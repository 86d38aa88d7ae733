"""How it is computed: on any executor, stored, resumed, nothing lost."""
