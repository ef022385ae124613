"""The ladder of meshes: which model, how fine, what verdict."""
