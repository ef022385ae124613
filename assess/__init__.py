"""Assessment: the margins that an engineer signs, from the stress of a pin.

The package has hand checks and code clauses of strength, fatigue, limit loads, derivatives of a
maximum, and second opinions by other programs. Units are SI. It imports `fea`, `geometry` and
`pinbase`.
"""
