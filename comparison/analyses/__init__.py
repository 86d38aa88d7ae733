"""What answers the question of a user: one folder for each analysis other than the surfaces, shown in index.html."""
