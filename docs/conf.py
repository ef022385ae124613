"""Sphinx settings; "make docs" builds into build/docs."""

import sys
from importlib.metadata import version as installed
from pathlib import Path

# The documentation is of this checkout, wherever the installed packages come from.
sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parent.parent)]

project = "pinstress"
version = release = installed("pinstress")
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "captions",
    "columns",
    "mathml",
    "modules",
    "study_reference",
]
myst_enable_extensions = ["amsmath", "dollarmath"]
myst_heading_anchors = 3
exclude_patterns = ["measured"]  # tables that pages include

# "make docs" is nitpicky about our pages; types of other packages have no page here.
nitpick_ignore_regex = [("py:.*", ".*")]
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
toc_object_entries = False
add_module_names = False

html_math_renderer = "mathml"
html_title = "pinstress"
html_static_path = ["static"]
html_css_files = ["tables.css"]
html_js_files = ["reachable.js"]
html_theme = "furo"
html_theme_options = {
    "navigation_with_keys": True,
    "light_css_variables": {"font-stack": "system-ui, sans-serif"},
    "dark_css_variables": {"font-stack": "system-ui, sans-serif"},
}
html_copy_source = False
html_show_copyright = False
