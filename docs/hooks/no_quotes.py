"""A line that begins with ``>`` is a comparison, no quotation: docstrings say ``>= 0, V``."""

from __future__ import annotations

from markdown import Extension, Markdown
from mkdocs.config.defaults import MkDocsConfig


class NoQuotes(Extension):
    """Leave quotations out of Markdown."""

    def extendMarkdown(self, md: Markdown) -> None:
        """Take the rule out."""
        md.parser.blockprocessors.deregister("quote")


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Add it, for pages and docstrings alike."""
    config.markdown_extensions.append(NoQuotes())
    return config
