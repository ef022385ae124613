"""Tables of strength: safety factors, margins, fatigue, changes."""
