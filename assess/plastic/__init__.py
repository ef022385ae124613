"""The load at which a pin collapses plastically, and its permanent set."""
