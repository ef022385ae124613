"""What is asked: a study file, read, validated and questioned."""
