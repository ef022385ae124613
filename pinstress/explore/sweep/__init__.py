"""Studies of many designs: a study with other numbers, sampled, solved and written as one table."""
