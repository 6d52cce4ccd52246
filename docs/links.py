#!/usr/bin/python3
"""Checks that what the pages of a directory link to exists.

    links.py DIRECTORY             links between files, with their anchors, of all HTML below the directory
    links.py --sources DIRECTORY   relative links of all Markdown files and notebooks of the project there

Links to other hosts are not followed.
"""

import json
import re
import sys
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

DOXYGEN_FORGETS = {"nested-classes"}  # anchors that Doxygen links to but does not set
SKIPPED = {"build", "mathjax", "node_modules", "out"}
LINK_ATTRIBUTES = {"a": "href", "img": "src", "link": "href", "script": "src"}


class Page(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.links, self.anchors = [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.anchors |= {attributes[name] for name in ("id", "name") if attributes.get(name)}
        if attributes.get(LINK_ATTRIBUTES.get(tag)):
            self.links.append(attributes[LINK_ATTRIBUTES[tag]])


@cache
def page(file):
    return Page(file.read_text(errors="replace"))


def broken_links(file):
    """Yields the links of an HTML page that lead nowhere."""
    for link in page(file).links:
        parts = urlsplit(link)
        if parts.netloc or parts.scheme in ("http", "https", "javascript", "mailto", "data"):
            continue
        target = file.parent / unquote(parts.path) if parts.path else file
        anchor = unquote(parts.fragment)
        if not target.exists():
            yield link
        elif anchor and target.suffix == ".html" and anchor not in page(target).anchors | DOXYGEN_FORGETS:
            yield link


def markdown(file):
    """The text of a Markdown file without its code, or of a notebook."""
    if file.suffix == ".ipynb":
        cells = json.loads(file.read_text())["cells"]
        return "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "markdown")
    return re.sub(r"^```.*?^```", "", file.read_text(), flags=re.S | re.M)


def broken_markdown_links(file):
    """Yields the relative links of a Markdown file or notebook to files that do not exist."""
    for target in re.findall(r"\]\(([^)\s]+)\)", markdown(file)):
        path = target.partition("#")[0]
        if path and not re.match(r"[a-z]+:", path) and not (file.parent / path).exists():
            yield target


def main():
    *sources, directory = sys.argv[1:]
    directory = Path(directory)
    suffixes, check = ({".md", ".ipynb"}, broken_markdown_links) if sources else ({".html"}, broken_links)
    files = [file for file in directory.rglob("*") if file.suffix in suffixes and not SKIPPED & set(file.relative_to(directory).parts)]
    found = [(file, link) for file in sorted(files) for link in check(file)]
    for file, link in found:
        print(f"links: {file}: {link} leads nowhere", file=sys.stderr)
    if not files:
        raise SystemExit(f"links: there is nothing in {directory}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
