"""Settings of the site. `make docs` builds it with Sphinx into ``build/site``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

sys.path.insert(0, str(Path(__file__).parent))

import gallery

import firm_hdl

if TYPE_CHECKING:
    from sphinx.application import Sphinx

project = "firm-hdl"
author = "The firm-hdl developers"
version = release = firm_hdl.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_argparse_cli",
    "sphinx_copybutton",
]
exclude_patterns = ["packages", "nodes", "figures"]

# Blocks without a language are pictures and output.
highlight_language = "none"

html_theme = "furo"
html_title = f"firm-hdl {release}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_copyright = False
html_theme_options = {"navigation_with_keys": True}

# Every link inside the site has to lead to something: `make docs` takes warnings for errors.
nitpicky = True
# But names of Python: the page of the API has what programs import, and the docstrings there also
# name classes of other modules and of other projects.
nitpick_ignore_regex = [("py:.*", ".*")]
# `bytes` is a type, and an attribute of two classes.
suppress_warnings = ["ref.python"]
# Headings have the same anchors as on GitHub and GitLab.
myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence", "deflist"]
# `make linkcheck`: pages that answer to browsers only, and places on a user's own machine.
linkcheck_ignore = [r"https?://(localhost|127\.0\.0\.1|192\.168\.).*"]
linkcheck_anchors = False

smartquotes_action = "De"  # Quotes stay as they are, for code that stands in prose.
# In docstrings, `name` is code.
default_role = "literal"
autodoc_member_order = "bysource"
autodoc_typehints = "none"
# What classes of Amaranth have is documented there.
autodoc_inherit_docstrings = False
napoleon_custom_sections = [("Members", "params_style")]
napoleon_use_ivar = True
napoleon_use_rtype = False

copybutton_prompt_text = "$ "
copybutton_only_copy_prompt_lines = True

pygments_style = "default"
pygments_dark_style = "github-dark"


def setup(app: Sphinx) -> None:
    """Draw the pictures of the gallery before the pages are read."""
    app.connect("builder-inited", lambda app: gallery.write(Path(app.srcdir) / "reference"))
