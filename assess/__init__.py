"""Assessment of pins and lugs, which gives the margins that an engineer signs.

The package has hand checks and code clauses of strength, fatigue, limit loads, derivatives of a
maximum, and second opinions by other programs. Units are SI. It imports `fea`, `geometry` and
`pinbase`.
"""
