"""Sphinx settings; "make docs" builds into build/docs."""

from importlib.metadata import version as installed

project = "pinstress"
version = release = installed("pinstress")
extensions = ["myst_parser", "sphinx.ext.mathjax"]
myst_enable_extensions = ["amsmath", "dollarmath"]
myst_heading_anchors = 3
exclude_patterns = ["measured"]  # tables that pages include
html_copy_source = False
html_show_copyright = False
