"""What is said next to results: warnings, what is left out, and why."""
