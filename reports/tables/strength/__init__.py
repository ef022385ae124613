"""Tables of strength: safety factors, margins, fatigue, what to change."""
