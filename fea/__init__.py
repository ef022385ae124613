"""The finite element analysis of a pin: its maximum von Mises stress, with error and verdict.

All units are SI. Of the project's packages it imports only `geometry` and `pinbase`. The entry
point is `fea.solve.solve.solve_pin`. Nothing is imported here, since scikit-fem takes long to
import.
"""
