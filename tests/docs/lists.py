#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks lists of names that programs cannot read from each other: tests/docs/lists.py BURNISH.

What the command line reads and writes, exports to and knows by name has to be in the documents, the page and the
package, and nothing else. Prints what is wrong as FILE: MESSAGE and exits with 1 if anything is."""
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
wrong = []


def text_of(file):
    return (ROOT / file).read_text(encoding="utf-8")


def part(file, pattern):
    found = re.search(pattern, text_of(file), re.S)
    if not found:
        sys.exit(f"{file}: expected {pattern}, found none")
    return found.group(1)


def keys(file, name):
    """Keys of a literal object of JavaScript."""
    return re.findall(r"(\w+):", part(file, rf"\b{name} = \{{(.*?)\}};"))


def strings(file, pattern):
    return re.findall(r'"(\w+)"', part(file, pattern))


def same(file, what, found, expected):
    for name in sorted(set(expected) - set(found)):
        wrong.append(f"{file}: expected '{name}' in {what}, found none")
    for name in sorted(set(found) - set(expected)):
        wrong.append(f"{file}: expected no '{name}' in {what}, which the command line does not know")


def holds(file, names):
    text = " ".join(text_of(file).split()).lower()
    for name in names:
        if name.lower() not in text:
            wrong.append(f"{file}: expected '{name}' among the formats, found none")


def said(burnish, *words):
    return json.loads(subprocess.run([burnish, *words], check=True, capture_output=True, text=True).stdout)


def choices(verb, option):
    for argument in verb["arguments"]:
        if option in argument["names"]:
            return argument["choices"]
    sys.exit(f"expected an option {option}, found none")


def main(burnish):
    formats = said(burnish, "help", "formats", "--json")
    written = {f["to"]: f for f in formats if f["to"]}
    targets = choices(said(burnish, "help", "export", "--json"), "--to")
    languages = strings("src/burnish/shaders/shader.cpp", r"constexpr std::string_view kNames\[\] = \{(.*?)\};")
    models = [m["name"] for m in said(burnish, "help", "models", "--json")]

    # The texts name every measurement that is read; those of networks and our own files they call otherwise.
    ours = re.compile("model|surface|book|baseline|network|codes")
    read = [re.sub(" (3D|E1392)$", "", f["name"]) for f in formats if f["read"] and not ours.search(f["name"])]
    for file in ["README.md", "web/package/README.md", "cmake/BurnishPackages.cmake"]:
        holds(file, read)
    holds("docs/guide/formats.md", read)
    rows = re.findall(r"^\|[^|]*\| `(\w+)` \|", text_of("docs/guide/formats.md"), re.M)
    same("docs/guide/formats.md", "the table's --to", rows, written)

    page = "web/studio/takeaway.js"
    same(page, "anyFiles and modelFiles", keys(page, "anyFiles") + ["model", "burnish"], written)
    for name, ending in re.findall(r'(\w+): "([\w.]+)"', part(page, r"\bkExtensions = \{(.*?)\};")):
        usual = written[name]["extension"].split(", ")[0]
        if name in written and not ("." + ending).endswith(usual):
            wrong.append(f"{page}: expected '{usual}' for {name}, found '{ending}'")
    for name in set(written) - set(keys(page, "kExtensions")):
        if written[name]["extension"].split(", ")[0] != "." + name:
            wrong.append(f"{page}: expected the ending {written[name]['extension']} of {name} in kExtensions, found none")
    for name in ["modelFiles", "surfaceFiles"]:
        for kind in set(keys(page, name)) - set(targets) - set(written):
            wrong.append(f"{page}: expected no '{kind}' in {name}, which the command line does not know")
    same(page, "languages", keys(page, "languages"), languages)
    same(page, "extension", keys(page, "extension"), languages)

    same("web/package/index.js", "kConverted", strings("web/package/index.js", r"kConverted = new Set\(\[(.*?)\]\)"), written)
    types = "web/package/index.d.ts"
    same(types, "FileKind", strings(types, r"type FileKind = (.*?);"), written)
    same(types, "Language", strings(types, r"type Language = (.*?);"), languages)
    # a package makes one file of what convert writes too
    same(types, "FilesKind", strings(types, r"type FilesKind = (.*?);") + languages, set(targets) - set(written))
    same("web/studio/analytic.js", "models", analytic_of_page(), models)
    print("\n".join(wrong) if wrong else f"{len(formats)} formats, {len(targets)} targets, {len(models)} models: as said")
    return bool(wrong)


def analytic_of_page():
    body = part("web/studio/analytic.js", r"\nconst models = \{\n(.*?)\n\};")
    while re.search(r"[\[(][^\[\]()]*[\])]", body):
        body = re.sub(r"[\[(][^\[\]()]*[\])]", "", body)
    return [entry.split(":")[0].strip() for entry in body.split(",") if entry.strip()]


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
