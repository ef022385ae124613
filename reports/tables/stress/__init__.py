"""Tables of stress: contact with lugs, singularities, CalculiX."""
