"""Tables of the loads: reactions, drives, linkage, drop."""
