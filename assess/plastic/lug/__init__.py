"""The limit load of a lug in plane strain, and its ultimate load."""
