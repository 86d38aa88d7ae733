"""What answers the question of a user: one folder for each analysis beside the surfaces, shown in index.html."""
