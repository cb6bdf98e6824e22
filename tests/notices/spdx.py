#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that each source file names its license: tests/notices/spdx.py [--write]

Its first line, or the second below "#!", is the comment "SPDX-License-Identifier: Apache-2.0". Files that burnish copies
into what it writes (hw/rtl, web, GLSL) have none: what it writes is its user's. --write adds missing lines."""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINE = "SPDX-License-Identifier: Apache-2.0"
COMMENTS = {".h": "//", ".cpp": "//", ".py": "#", ".sh": "#", ".cmake": "#"}


def sources():
    """(path, comment mark) of every file of the repository that is to have the line."""
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in listed.splitlines():
        path = ROOT / name
        mark = "#" if path.name == "CMakeLists.txt" else COMMENTS.get(path.suffix)
        if mark and not name.startswith("web/") and path.exists():
            yield path, mark


def place(lines):
    """The number of the line that names the license, from 0."""
    return 1 if lines and lines[0].startswith("#!") else 0


def main():
    missing = []
    for path, mark in sources():
        lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
        at, line = place(lines), f"{mark} {LINE}\n"
        if lines[at : at + 1] == [line]:
            continue
        missing.append(path)
        if "--write" in sys.argv[1:]:
            path.write_text("".join(lines[:at] + [line] + lines[at:]), encoding="utf-8")
    for path in missing:
        print(f"{path.relative_to(ROOT)}: expected its license, '{LINE}', found none; tests/notices/spdx.py --write adds it")
    return 1 if missing and "--write" not in sys.argv[1:] else 0


if __name__ == "__main__":
    sys.exit(main())
