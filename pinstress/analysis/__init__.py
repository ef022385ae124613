"""Who is solved when: plan, solve, results."""
