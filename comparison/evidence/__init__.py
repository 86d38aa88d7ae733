"""What judges the tool and the paper: one folder for each piece of evidence, shown in verification.html."""
