#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the comments and texts of source files: tests/docs/comments.py [--self-test | FILE...]. Without arguments it
checks the C++ files and JavaScript of FOLDERS, and the scripts of SCRIPTS.

- A comment names its subject first: it does not open with one of OPENINGS.
- No sentence within it opens with one of SENTENCE_OPENINGS.
- A sentence, or a part of it up to a colon or semicolon, has at most WORDS words.
- No comment uses one of PRIVATE_WORDS, which are not the field's.
- Texts for users hold the same: docstrings of the Python package, and in C++ what CALLS, LISTS and FIELDS receive
  (errors, help texts, warnings). They open with none of TEXT_OPENINGS, have at most TEXT_WORDS words a sentence, and
  use none of TEXT_PRIVATE_WORDS.

Prints what is wrong as FILE:LINE: MESSAGE and exits with 1 if anything is. CONTRIBUTING.md says how comments are
written."""
import ast
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
# The folders whose C++ files and JavaScript hold the rules.
FOLDERS = ["apps", "examples", "python/src", "src/burnish", "tests", "web"]
WORDS = 40
OPENINGS = re.compile(r"(Of|That|What|Whether|Where|How|Those|As)\b")
SENTENCE_OPENINGS = re.compile(r"(Of|What|Whether|How)\b")
PRIVATE_WORDS = re.compile(r"\b(foretells?|foretold|nobody did)\b", re.I)
# Files whose every text is for users, but for signatures, and the Python files that have docstrings for them.
DOCSTRINGS = ["python/src"]
SCRIPTS = ["python/burnish"]
# Functions whose texts users read, lists that texts are added to, and members of options.
CALLS = {"Error", "in_file", "in_line", "fail", "ValidationError", "RequiredError", "add_option", "add_flag",
         "add_subcommand", "footer", "lose", "note"}
LISTS = re.compile(r"(warnings|conventions|losses|notes)\w*(\.|->)push_back$")
FIELDS = re.compile(r"\.(help|left_out) = $")
TEXT_WORDS = 25
TEXT_OPENINGS = re.compile(r"(of|that|what|whether|how|those)\b", re.I)
TEXT_PRIVATE_WORDS = re.compile(r"\b(foretells?|foretold|nobody|owners?|twins?|so many(?:th)?)\b", re.I)
EXAMPLES = re.compile(r"Examples?: |\s{5,}|cd ")
TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|R"([^(\s]*)\(.*?\)\1"|"(?P<text>(?:[^"\\\n]|\\.)*)"|'
                   r"'(?:[^'\\\n]|\\.)+'|[(){}\[\];]", re.S)


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


def texts(text, all_texts):
    """(line number, text) of each text for users in a C++ file; literals that follow each other are one text."""
    found, calls, end = [], [], None
    for token in TOKEN.finditer(text):
        start = token.start()
        if token.group() in tuple("([{"):
            name = re.search(r"([\w.>-]+)(?:<[^<>()]*>)?$", text[max(0, start - 60):start])
            calls.append(name.group(1) if name else "")
        elif token.group() in tuple(")]}") and calls:
            calls.pop()
        if token.group("text") is None:
            end = end if token.group().startswith("/") else None
            continue
        joins = end is not None and not text[end:start].strip()
        names = {re.split(r"\.|->", call)[-1] for call in calls}
        wanted = (all_texts or names & CALLS or any(LISTS.search(call) for call in calls)
                  or FIELDS.search(text[max(0, start - 20):start]))
        end = None
        if not wanted or "sig" in names or text[:start].endswith("#include "):
            continue
        if not joins:
            found.append((text.count("\n", 0, start) + 1, ""))
        plain = token.group("text").replace("\\n", "\n").replace('\\"', '"')
        found[-1] = (found[-1][0], found[-1][1] + plain)
        end = token.end()
    return found


def docstrings(text):
    """(line number, text) of each docstring of a Python file."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and (said := ast.get_docstring(node)):
            yield node.body[0].lineno, said


def check_text(text):
    """Messages about everything wrong in a text for users. It may be a part of a message, but has three words."""
    if len(re.findall(r"[A-Za-z]{2,}", text)) < 3:
        return
    lines = [line for line in text.split("\n") if not EXAMPLES.match(line)]
    if lines and (opening := TEXT_OPENINGS.match(lines[0])):
        yield f"the text opens with '{opening.group()}': name its subject first"
    before = ""
    for place, sentence in enumerate(sentences(lines)):
        # "name: of files" is an opening too.
        opening = (TEXT_OPENINGS if re.fullmatch(r"[\w, ]{1,40}:", before) else SENTENCE_OPENINGS).match(sentence)
        if place > 0 and opening:
            yield f"a sentence of a text opens with '{opening.group()}': name its subject first"
        if (count := words(sentence)) > TEXT_WORDS:
            yield f"a sentence of {count} words in a text, at most {TEXT_WORDS}: {sentence[:60]}..."
        if private := TEXT_PRIVATE_WORDS.search(sentence):
            yield f"'{private.group()}' in a text is no word of the field"
        before = sentence


def for_users(path):
    """(line number, text) of each text for users in a file. Tests, benchmarks and reports have none."""
    name = path.relative_to(ROOT).as_posix()
    if path.suffix == ".py":
        return list(docstrings(path.read_text(encoding="utf-8")))
    if path.suffix == ".js" or re.search(r"_(test|bench)\.cpp$|/testing/|^(tests|examples|apps/reports)/", name):
        return []
    return texts(path.read_text(encoding="utf-8"), name.startswith(tuple(DOCSTRINGS)))


def check_file(path):
    """(line, message) of everything wrong in a file."""
    if path.suffix != ".py":
        yield from check(path.read_text(encoding="utf-8"))
    for number, text in for_users(path):
        for message in check_text(text):
            yield number, message


def sources():
    """The C++ files and JavaScript of FOLDERS, and the scripts of SCRIPTS; throws where a folder has none."""
    for folder in FOLDERS + SCRIPTS:
        endings = (".py",) if folder in SCRIPTS else (".h", ".cpp", ".js")
        found = sorted(path for path in (ROOT / folder).rglob("*") if path.suffix in endings)
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
    good_texts = ['throw Error("expected a name, found " + name);  // of the file', 'm.def("f", nb::sig("of what"));',
                  'reader.fail(fmt::format("{} values", n), found ? "one of the header" : "none");',
                  'verb->footer("Reads files.\\nExample: burnish " "' + "word " * 30 + '");',
                  'print("what it says here");']
    bad_texts = ['throw Error("what " "is wrong here");', 'losses.push_back("the side. Of files none.");',
                 'reader.fail("values", f(that) + "those of texels, which are read");',
                 'option{.help = "Fits what its owner makes of it."};',
                 'app->add_flag("--x", x, "' + "word " * 26 + '");', 'throw Error(name + "a: notes, b: of what is read");']

    def faults(text):
        return [message for _, part in texts(text, "m.def" in text) for message in check_text(part)]

    wrong = [f"found {list(check(text))} in {text!r}" for text in good if list(check(text))]
    wrong += [f"found {len(list(check(text)))} faults, not 1, in {text!r}" for text in bad if len(list(check(text))) != 1]
    wrong += [f"found {faults(text)} in {text!r}" for text in good_texts if faults(text)]
    wrong += [f"found {faults(text)}, not one fault, in {text!r}" for text in bad_texts if len(faults(text)) != 1]
    print("\n".join(wrong) if wrong else "comments.py finds what it should")
    return 1 if wrong else 0


def main():
    if "--self-test" in sys.argv[1:]:
        return self_test()
    paths = [pathlib.Path(name).resolve() for name in sys.argv[1:]] or list(sources())
    wrong = [f"{path.relative_to(ROOT)}:{number}: {message}" for path in paths
             for number, message in check_file(path)]
    count = sum(len(for_users(path)) for path in paths)
    print("\n".join(wrong) if wrong else f"comments of {len(paths)} files and {count} texts, nothing wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
