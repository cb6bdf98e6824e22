#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/api.md, what burnish/burnish.h declares, from the comments of its headers: docs/api.py [--check].

With --check it writes nothing, and exits with 1 if the page is not as the headers have it."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
SOURCES = ROOT / "src/burnish"
PAGE = ROOT / "docs/api.md"
INCLUDE = re.compile(r"^#include <burnish/([^>]+)>", re.M)
INTRODUCTION = """\
# The public door

<!-- Made by docs/api.py from the comments of the headers: edit those, then `make api`. -->

`#include <burnish/burnish.h>` declares all of this page; each of its headers can be included alone. They need the
standard library of C++20 and nothing else. Everything is in namespace `burnish`. What is not here may change.
Conventions and symbols: [notation](notation.md).
"""


def end_of_braces(text, start):
    """The place after the brace that closes the one at start."""
    depth = 0
    for at in range(start, len(text)):
        depth += {"{": 1, "}": -1}.get(text[at], 0)
        if depth == 0:
            return at + 1
    raise ValueError(f"a brace is not closed: {text[start:start + 80]!r}")


def items_of(text):
    """The declarations of a header in order, as (comment, code, starts_paragraph), code with its bodies."""
    body = text[text.index("namespace burnish {") + len("namespace burnish {"):text.rindex("}  // namespace burnish")]
    at = 0
    while match := re.compile(r"\s*", re.M).match(body, at):
        starts_paragraph = match.group().count("\n") > 1
        at = match.end()
        comment = []
        while line := re.compile(r"[ \t]*//(/?)(.*)\n\s*").match(body, at):
            if line.group(1):
                comment.append(line.group(2).removeprefix(" "))
            at = line.end()
        if at >= len(body):
            return
        start = at
        # a declaration ends at a semicolon outside all brackets, a function's definition with its body
        depth, is_function = 0, False
        while True:
            here = body[at]
            if body.startswith("//", at):
                at = body.index("\n", at)
                continue
            if here == "(" and depth == 0:
                is_function = "=" not in body[start:at]
            if here == "{" and depth == 0 and is_function:
                at = end_of_braces(body, at)
                break
            depth += {"(": 1, "{": 1, ")": -1, "}": -1}.get(here, 0)
            at += 1
            if here == ";" and depth == 0:
                break
        rest = re.compile(r"[ \t]*///<[^\n]*(\n[ \t]+///<[^\n]*)*").match(body, at)
        code = body[start:at] + (rest.group() if rest else "")
        at = rest.end() if rest else at
        yield comment, code, starts_paragraph


def without_bodies(code):
    """Code with the bodies of functions, their initializer lists and what is private left out."""
    code = re.sub(r"\n* private:.*(?=\n};$)", "", code, flags=re.S)
    code = re.sub(r"[ \t]*// (NOLINT|clang-format)[^\n]*", "", code)
    kept, at, statement, depth = "", 0, 0, 0
    while at < len(code):
        if code.startswith("//", at):
            end = code.find("\n", at)
            end = len(code) if end < 0 else end
            kept += code[at:end]
            at = end
            statement = len(kept) if depth == 0 else statement
            continue
        here = code[at]
        if here == "{" and depth == 0 and "(" in (head := kept[statement:]) and not re.search(r"\w+ = ", head):
            # ") noexcept : a(b)": what initializes members goes with the body
            head = re.sub(r"\)([^():]*?)\s*(?<!:):(?!:).*$", r")\1", head, flags=re.S).rstrip()
            kept = kept[:statement] + head + ";"
            at = end_of_braces(code, at)
            statement = len(kept)
            continue
        depth += {"(": 1, ")": -1}.get(here, 0)
        kept += here
        at += 1
        if here in "{};" and depth == 0 or kept.endswith("public:"):
            statement = len(kept)
    return re.sub(r"\n\n\n+", "\n\n", re.sub(r"(?<= public:)\n(?=\n)", "", kept)).rstrip()


def prose(comment):
    """A comment as Markdown: what would be markup there is text."""
    text = re.sub(r"(\n(?:- |  )[^\n]*)\n(?=[^\s-])", r"\1\n\n", "\n".join(comment))  # a list's end
    parts = re.split(r"(`[^`]*`)", text)
    return "".join(part if part.startswith("`") else re.sub(r"([*<])", r"\\\1", part) for part in parts)


def section_of(header):
    """The page's part on one header."""
    text = (SOURCES / header).read_text(encoding="utf-8")
    blocks = []  # [comment, code]
    for comment, code, starts_paragraph in items_of(text):
        if code.startswith("static_assert") or re.fullmatch(r"(struct|class) \w+;", code):
            continue
        code = without_bodies(code)
        if not comment and blocks and not starts_paragraph:
            blocks[-1][1] += "\n" + code
        else:
            blocks.append([comment, code])
    parts = [f"## {header}"]
    for comment, code in blocks:
        parts.append(f"```cpp\n{code}\n```")
        if comment:
            parts.append(prose(comment))
    return "\n\n".join(parts) + "\n"


def installed_with(headers):
    """What the public headers include besides each other."""
    found, waiting = [], list(headers)
    while waiting:
        header = waiting.pop(0)
        if header not in found:
            found.append(header)
            waiting += INCLUDE.findall((SOURCES / header).read_text(encoding="utf-8"))
    return sorted(set(found) - set(headers))


def page():
    headers = INCLUDE.findall((SOURCES / "burnish.h").read_text(encoding="utf-8"))
    others = "".join(f"- `{header}`\n" for header in installed_with(headers))
    return "\n".join([INTRODUCTION, *(section_of(header) for header in headers),
                      f"## Installed with them\n\nTypes that the headers above are made of:\n\n{others}"])


def main():
    text = page()
    if "--check" not in sys.argv[1:]:
        PAGE.write_text(text, encoding="utf-8")
    elif not PAGE.exists() or PAGE.read_text(encoding="utf-8") != text:
        print("docs/api.md: not as the headers have it: run make api")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
