#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the Markdown files of this repository: tests/docs/check.py [FILE...], all of them without arguments.

- Prose, also that of templates (.md.in), is wrapped at 120 columns; tables, code and lines without a space before
  column 120 are free.
- Links lead to files of the tree, anchors to headings.
- A page of docs/guide has at most 120 lines, one of docs/notes at most 85, which is two screens.
- Sentences of docs/guide have at most 30 words, and half of a page's at most 16.
- Neither docs/guide nor docs/notes uses a word of comments.PRIVATE_WORDS, which are not the field's.
- tests/docs/questions.md has five questions for each page of docs/guide, and the words there that answer them.
- No page has a dagger: a figure that no command prints is left out.
- Every picture of docs/figures stands in a page.

Prints what is wrong as FILE:LINE: MESSAGE and exits with 1 if anything is."""
import functools
import pathlib
import re
import statistics
import subprocess
import sys
import urllib.parse

import comments

ROOT = pathlib.Path(__file__).resolve().parents[2]
COLUMNS = 120
SENTENCE_WORDS, MEDIAN_WORDS = 30, 16
QUESTIONS = ROOT / "tests/docs/questions.md"
QUESTIONS_A_PAGE = 5
MOST_LINES = {"docs/guide/": 120, "docs/notes/": 85}
LINK = re.compile(r"\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)|^\s*\[[^\]]+\]:\s+(\S+)|(?:src|href)=\"([^\"]+)\"")


def documents():
    """Every Markdown file and template that git knows or would know."""
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", "*.md", "*.md.in"], cwd=ROOT, check=True,
                            capture_output=True, text=True).stdout.split("\n")
    return sorted(path for name in set(listed) if name and (path := ROOT / name).exists())


def lines_of(path):
    """(number, text, is_code) of every line. Code is fenced, or indented by four after an empty line."""
    fence, indented, last_empty, in_list = None, False, True, False
    for number, text in enumerate(path.read_text(encoding="utf-8").split("\n"), 1):
        mark = re.match(r"\s*(```+|~~~+)", text)
        if fence:
            yield number, text, True
            if mark and mark.group(1).startswith(fence):
                fence = None
            continue
        if mark:
            fence = mark.group(1)
            yield number, text, True
            continue
        if not text.strip():
            last_empty = True
            yield number, text, indented
            continue
        in_list = bool(re.match(r"\s*([-*+]|\d+\.)\s", text)) or (in_list and text.startswith(" "))
        indented = text.startswith("    ") and (indented or last_empty) and not in_list
        last_empty = False
        yield number, text, indented


@functools.cache
def anchors(path):
    """Names of a page's headings, as GitHub makes them."""
    found, seen = set(), {}
    for _, text, code in lines_of(path):
        heading = re.match(r"#{1,6}\s+(.*?)\s*#*$", text)
        if code or not heading:
            continue
        title = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading.group(1))
        name = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
        count = seen[name] = seen.get(name, -1) + 1
        found.add(f"{name}-{count}" if count else name)
    return found


def check_link(path, target):
    """What is wrong with a link of a page, or nothing."""
    if re.match(r"[a-z][a-z0-9+.-]*:", target):
        return None
    name, _, anchor = urllib.parse.unquote(target).partition("#")
    aim = (path.parent / name).resolve() if name else path
    if not aim.is_relative_to(ROOT):
        return f"{target} leads out of the repository"
    if not aim.exists():
        return f"{target} does not exist"
    if anchor and aim.suffix == ".md" and anchor not in anchors(aim):
        return f"{target}: no such heading"
    return None


def check(path):
    """(line, message) of everything wrong in a page."""
    name = path.relative_to(ROOT).as_posix()
    count = 0
    for number, text, code in lines_of(path):
        count = number if text else count
        if code:
            continue
        if len(text) > COLUMNS and not text.lstrip().startswith("|") and " " in text.strip()[:COLUMNS]:
            yield number, f"{len(text)} columns, at most {COLUMNS}"
        if path.suffix == ".in":  # its links are those of the page it becomes
            continue
        for link in LINK.finditer(re.sub(r"`[^`]*`", "", text)):
            if wrong := check_link(path, next(target for target in link.groups() if target)):
                yield number, wrong
        if "†" in re.sub(r"`[^`]*`", "", text):
            yield number, "a dagger; leave out a figure that no command prints"
        if name.startswith(tuple(MOST_LINES)) and (word := comments.PRIVATE_WORDS.search(text)):
            yield number, f"'{word.group(0)}' is not the field's word"
    for folder, most in MOST_LINES.items():
        if name.startswith(folder) and count > most:
            yield count, f"{count} lines, a page of {folder} has at most {most}"
    if name.startswith("docs/guide/"):
        yield from check_sentences(path)


def sentences(path):
    """(line, words) of each sentence that stands in a paragraph or item; code counts as a word."""
    first, text = 0, []

    def split():
        joined = re.sub(r"`[^`]*`", "code", " ".join(text))
        joined = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", joined)
        for sentence in re.split(r"(?<=[.!?])[\"*)]*\s+(?=[\w\"(*\[])", joined):
            words = [word for word in sentence.split() if re.search(r"\w", word)]
            if words:
                yield first, len(words)
    for number, line, code in lines_of(path):
        line = line.strip()
        item = re.match(r"([-*+]|\d+\.)\s+", line)
        aside = code or not line or line.startswith(("|", "#", "![", "<!--"))
        if aside or item:
            yield from split()
            text = []
        if not aside:
            first = first if text else number
            text.append(line[item.end():] if item else line)
    yield from split()


def check_sentences(path):
    """(line, message) of sentences that are too long."""
    found = list(sentences(path))
    for number, words in found:
        if words > SENTENCE_WORDS:
            yield number, f"a sentence of {words} words, at most {SENTENCE_WORDS}"
    median = statistics.median(words for _, words in found)
    if median > MEDIAN_WORDS:
        yield 1, f"half of the sentences have {median:g} words or more, at most {MEDIAN_WORDS}"


def check_questions():
    """(line, message) of what is wrong in QUESTIONS: items "- Question? _answer_" below "## PAGE" of the guide. The
    answer stands in the page, so that the page alone answers it."""
    asked, text = {}, ""
    for number, line, _ in lines_of(QUESTIONS):
        if line.startswith("## "):
            page = ROOT / "docs/guide" / line.removeprefix("## ")
            text = " ".join(page.read_text(encoding="utf-8").split()) if page.exists() else ""
            asked[page.name] = 0
        elif item := re.match(r"- .+\? _(.+)_$", line):
            asked[page.name] += 1
            if item.group(1) not in text:
                yield number, f"{page.name} does not say '{item.group(1)}'"
        elif line.startswith("- "):
            yield number, "expected '- Question? _answer_'"
    for page in sorted((ROOT / "docs/guide").glob("*.md")):
        if asked.get(page.name, 0) < QUESTIONS_A_PAGE:
            yield 1, f"{page.name}: {asked.get(page.name, 0)} questions, at least {QUESTIONS_A_PAGE}"


def unseen_figures(pages):
    """Pictures that no page shows."""
    text = "".join(page.read_text(encoding="utf-8") for page in pages)
    return [figure for figure in sorted(ROOT.glob("docs/figures/*")) if f"/{figure.name})" not in text]


def main():
    pages = [pathlib.Path(name).resolve() for name in sys.argv[1:]] or documents()
    wrong = [f"{path.relative_to(ROOT)}:{number}: {message}" for path in pages for number, message in check(path)]
    if not sys.argv[1:]:
        wrong += [f"{QUESTIONS.relative_to(ROOT)}:{number}: {message}" for number, message in check_questions()]
        wrong += [f"{figure.relative_to(ROOT)}: stands in no page" for figure in unseen_figures(pages)]
    print("\n".join(wrong) if wrong else f"{len(pages)} documents, nothing wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
