#!/usr/bin/python3
"""Makes Doxygen read what is written for people: doxygen runs `filter.py FILE` and takes what it prints.

Markdown (which must also read well where it lies, and on a forge):
  * headings get the labels that links refer to: page_<name>, page_<name>_<heading>
  * links to pages of the guide become references; links to other files of the project become plain text
  * a line that is a link to a program becomes its text
  * $...$ and $$...$$ become formulas
  * the list of index.md becomes the table of contents
Markdown and comments of headers: a "<" that starts no HTML is taken literally.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TABLE_OF_CONTENTS = ROOT / "docs/index.md"
CODE_SPAN = re.compile(r"(`+[^`]+?`+)")
LINK = re.compile(r"(!?)\[([^\]]+)\]\(([^)\s]+)\)")
HTML = r"/?(?:a|b|br|code|div|em|img|p|small|sub|sup|td|th|tr|table)\b[^<>]*/?>"


def slug(text):
    return re.sub(r"[^a-z0-9]+", "_", text.lower()).strip("_")


def anchor(text):
    """The label of a heading, and of what links to it: as forges make anchors, which Doxygen does not take with "-"."""
    return re.sub(r"[\s-]", "_", re.sub(r"[^\w\s-]", "", text.lower()).strip())


def page_label(file):
    """The label of a page of the guide, or None: the pages are docs/*.md and the README of folders."""
    file = file.resolve()
    if file.is_dir():
        file = file / "README.md"
    if file.suffix != ".md" or not file.is_file() or not file.is_relative_to(ROOT):
        return None
    if file == TABLE_OF_CONTENTS:
        return "index"
    name = file.relative_to(ROOT).with_suffix("")
    name = name.parent if name.name == "README" else name
    return f"page_{slug(str(name).removeprefix('docs/')) or 'readme'}"


def reference(file, match):
    """What a link of that file becomes."""
    image, text, target = match.groups()
    if re.match(r"[a-z]+:", target):
        return match.group(0)
    if image:  # Doxygen puts all pictures into one folder, where equal names collide; scripts/docs keeps their paths
        path = (file.parent / target).resolve().relative_to(ROOT)
        return f'<img src="{path}" alt="{text}"/>'
    path, _, heading = target.partition("#")
    label = page_label(file.parent / path if path else file)
    if label is None:
        return text
    if heading:
        label += f"_{anchor(heading)}"
    if file == TABLE_OF_CONTENTS and not heading:
        return f'\\subpage {label} "{text}"'
    return f"[{text}](@ref {label})"


def escape(text):
    return re.sub(rf"<(?!{HTML}|https?:|!--|--)", "&lt;", text)


def prose(file, text):
    """A piece of Markdown outside code."""
    text = re.sub(r"^\[[^\]]+\]\([^)]*?(\w+\.cpp)\)$", r"\\include \1", text, flags=re.M)
    text = re.sub(r"\$\$(.+?)\$\$", r"\\f[\1\\f]", text, flags=re.S)
    text = re.sub(r"(?<![\\$])\$([^$]+?)\$(?!\$)", r"\\f$\1\\f$", text, flags=re.S)
    return LINK.sub(lambda match: reference(file, match), escape(text))


def blocks(text):
    """Yields (is code, lines): fenced and indented code, and what stands between."""
    code, lines, fence = False, [], False
    blank = True
    for line in text.splitlines(keepends=True):
        if line.startswith("```"):
            is_code, fence = True, not fence
        else:
            is_code = fence or (line.startswith("    ") and (code or blank)) or (code and not line.strip())
        if is_code != code:
            yield code, "".join(lines)
            lines = []
        code = is_code
        blank = not line.strip()
        lines.append(line)
    yield code, "".join(lines)


def heading(label, match, seen):
    marks, text = match.groups()
    name = label if marks == "#" else f"{label}_{anchor(text)}"
    if name in seen:
        raise SystemExit(f"filter: two headings {name}")
    seen.add(name)
    return match.group(0) if name == "index" else f"{marks} {text} {{#{name}}}"


def markdown(file):
    label, seen = page_label(file), set()
    for is_code, text in blocks(file.read_text()):
        if not is_code:
            # Links may hold code, so code spans are hidden in their texts and put back at the end.
            spans = []
            text = CODE_SPAN.sub(lambda match: spans.append(match.group(0)) or f"\x01{len(spans) - 1}\x02", text)
            restore = lambda text: re.sub("\x01(\\d+)\x02", lambda match: spans[int(match.group(1))], text)
            text = re.sub(r"^(#+) (.+)$", lambda match: heading(label, re.match(r"(#+) (.+)", restore(match.group(0))), seen),
                          text, flags=re.M)
            text = restore(prose(file, text))
        yield text


def header(file):
    for line in file.read_text().splitlines(keepends=True):
        code, mark, comment = re.match(r"(.*?)(///<?|$)(.*)", line, flags=re.S).groups()
        parts = CODE_SPAN.split(comment)
        yield code + mark + "".join(part if i % 2 else escape(part) for i, part in enumerate(parts))


def main():
    file = Path(sys.argv[1]).resolve()
    sys.stdout.writelines(markdown(file) if file.suffix == ".md" else header(file))


if __name__ == "__main__":
    main()
