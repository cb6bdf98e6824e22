#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the comments of C++ files: tests/docs/comments.py [--self-test | FILE...], those of FOLDERS without arguments.

- A comment names its subject first: it does not open with one of OPENINGS.
- No sentence within it opens with one of SENTENCE_OPENINGS.
- A sentence, or a part of it up to a colon or semicolon, has at most WORDS words.
- No comment uses one of PRIVATE_WORDS, which are not the field's.

Prints what is wrong as FILE:LINE: MESSAGE and exits with 1 if anything is. CONTRIBUTING.md says how comments are
written."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
# The folders whose C++ files hold the rules.
FOLDERS = ["apps", "examples", "python/src", "src/burnish", "tests"]
WORDS = 40
OPENINGS = re.compile(r"(Of|That|What|Whether|Where|How|Those|As)\b")
SENTENCE_OPENINGS = re.compile(r"(Of|What|Whether|How)\b")
PRIVATE_WORDS = re.compile(r"\b(foretells?|foretold|nobody did)\b", re.I)


def comments(text):
    """(line number, text lines) of each comment: lines that hold nothing else, or what follows code in one line."""
    found, open_ = [], False
    for number, line in enumerate(text.split("\n"), 1):
        own = re.match(r"\s*///?(?!<) ?(.*)$", line)
        if own and open_:
            found[-1][1].append(own.group(1))
        elif own:
            found.append((number, [own.group(1)]))
        elif behind := re.match(r"[^\"]*\S\s+///?<? ?(.*)$", line):
            found.append((number, [behind.group(1)]))
        open_ = bool(own)
    return found


def sentences(lines):
    """The sentences of a comment, cut at colons and semicolons too. List items, indented lines and empty ones end one."""
    paragraphs = [[]]
    for line in lines:
        in_item = paragraphs[-1] and paragraphs[-1][0].startswith("- ")
        if not line.strip() or line.startswith("- ") or (line.startswith("  ") and not in_item):
            paragraphs.append([])
        paragraphs[-1].append(line.strip())
    for paragraph in paragraphs:
        text = " ".join(paragraph).removeprefix("- ")
        yield from (part for part in re.split(r"(?<=[.!?])\s+(?=[A-Z`(\"0-9])|(?<=[;:])\s+", text) if part)


def words(sentence):
    """How many words a sentence has; code and symbols count as none or one."""
    plain = re.sub(r"`[^`]*`", "code", sentence)
    return sum(1 for word in re.split(r"[\s/]+", plain) if re.search(r"[A-Za-z]{2}", word))


def check(text):
    """(line, message) of everything wrong in the comments of a file."""
    for number, lines in comments(text):
        if opening := OPENINGS.match(lines[0]):
            yield number, f"the comment opens with '{opening.group()}': name its subject first"
        for place, sentence in enumerate(sentences(lines)):
            opening = SENTENCE_OPENINGS.match(sentence)
            if place > 0 and opening:
                yield number, f"a sentence opens with '{opening.group()}': name its subject first"
            if (count := words(sentence)) > WORDS:
                yield number, f"a sentence of {count} words, at most {WORDS}: {sentence[:60]}..."
            if private := PRIVATE_WORDS.search(sentence):
                yield number, f"'{private.group()}' is no word of the field"


def sources():
    """The C++ files of FOLDERS; throws where a folder has none."""
    for folder in FOLDERS:
        found = sorted(path for path in (ROOT / folder).rglob("*") if path.suffix in (".h", ".cpp"))
        if not found:
            raise SystemExit(f"comments.py: {folder} holds no source: mend FOLDERS")
        yield from found


def self_test():
    """Nothing is found in good comments, and each fault in bad ones."""
    good = ["/// Returns the value at a place: a sum of lobes. Throws Error if there is none.\nint a();",
            "int b;  ///< of the unknowns", "// Each node adds its row; whatever is left out stays 0.\nint c();",
            "/// - exact: all;\n/// - fast: " + "word " * 39 + "\nint d();", 'auto e = "a  // Of text";']
    bad = ["/// Of the channels.\nint a();", "int b;  // What is left.", "/// Whether it is so.\nint c();",
           "/// Returns a value. Of lines it is 0.\nint d();", "/// " + "word " * 41 + "\nint e();",
           "/// The nodes that others foretell.\nint f();", "/// A value,\n/// which is 0. How it is found.\nint g();"]
    wrong = [f"found {list(check(text))} in {text!r}" for text in good if list(check(text))]
    wrong += [f"found {len(list(check(text)))} faults, not 1, in {text!r}" for text in bad if len(list(check(text))) != 1]
    print("\n".join(wrong) if wrong else "comments.py finds what it should")
    return 1 if wrong else 0


def main():
    if "--self-test" in sys.argv[1:]:
        return self_test()
    paths = [pathlib.Path(name).resolve() for name in sys.argv[1:]] or list(sources())
    wrong = [f"{path.relative_to(ROOT)}:{number}: {message}" for path in paths
             for number, message in check(path.read_text(encoding="utf-8"))]
    print("\n".join(wrong) if wrong else f"comments of {len(paths)} files, nothing wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
