#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/guide/fit-options.md, all options of a fit, from what the command line says of them:
docs/options.py BURNISH [--check].

With --check it writes nothing, and exits with 1 if the page is not as the command line has it."""
import json
import pathlib
import subprocess
import sys

PAGE = pathlib.Path(__file__).resolve().parent / "guide/fit-options.md"
INTRODUCTION = """\
# Options of a fit

<!-- Made by docs/options.py: edit src/burnish/fitting/fit_request.cpp, then `make options`. -->

    burnish fit paint.binary -o paint.exr --budget 16K --fetches 2 --hold-out half=1

```python
model = burnish.fit(paint, budget="16K", fetches=2, hold_out="half=1")
```

```js
const model = await paint.fit({budget: "16K", fetches: 2, holdOut: "half=1"});
```

`fit` and `batch` of the command line, `fit` and `batch` in Python and `fit` of the [page's package](../../web/package)
read the same table. A wrong value or combination gives the same message everywhere, and the exit code 2 on the command
line. Only the spelling of the options differs. [From a measurement to a model](fitting.md) explains the choices and
the words: fetches, lobes, lines, hemispheres, projections, warps. [Nodes](nodes.md) are values as they were measured. A
*book* is what the [materials of a library](library.md#a-book-a-few-pairs-of-a-material-are-enough) share.

"""
HEAD = ["option", "takes", "default", "does"]
TAKES = {"flag": "nothing", "text": "a text", "texts": "a text; several times", "whole number": "a whole number",
         "number": "a number", "bytes": "auto or a number of bytes", "number or auto": "auto or a number",
         "node part": "half=0, half=1, theta_i=K", "file": "a file"}


def cell(text):
    return text.replace("|", "\\|")


def takes(option):
    if option["choices"]:
        return ", ".join(f"`{choice}`" for choice in option["choices"])
    return " ".join([TAKES[option["takes"]], option["range"] or ""]).strip()


def left_out(option):
    if option["takes"] == "flag":
        return "off" if option["default"] == "false" else "the reciprocal part is fitted"
    return f"`{option['default']}`" if option["default"] else option["left_out"]


def row(option, words):
    does = option["help"]
    if option["needs"]:
        does += f" Needs `{words[option['needs']]}`."
    if option["excludes"]:
        does += " Excludes " + ", ".join(f"`{words[name]}`" for name in option["excludes"]) + "."
    spelled = f"`{option['command_line']}`" + (f" {chr(96)}{option['example']}{chr(96)}" if option["example"] else "")
    return "| " + " | ".join(cell(text) for text in (spelled, takes(option), left_out(option), does)) + " |"


def names(options):
    """A sentence about the options that Python and the package spell in their own way."""
    lines = ["| command line | Python | package |", "|---|---|---|"]
    for option in options:
        plain = "--" + option["name"]
        if option["command_line"] == plain and option["package"] == option["name"]:
            continue
        value = "=False" if option["default"] == "true" else ""
        package = f"`{option['package']}{': false' if value else ''}`" if option["package"] else "has none"
        lines.append(f"| `{option['command_line']}` | `{option['python']}{value}` | {package} |")
    return ["", "Most names are the same everywhere, without the dashes. These differ:", "", *lines]


def page(burnish):
    told = subprocess.run([burnish, "describe", "--json"], check=True, capture_output=True, text=True).stdout
    options = json.loads(told)["fit_options"]
    words = {option["name"]: option["command_line"] for option in options}
    lines = ["| " + " | ".join(HEAD) + " |", "|---|---|---|---|", *(row(option, words) for option in options),
             *names(options)]
    return INTRODUCTION + "\n".join(lines) + "\n"


def main():
    text = page(sys.argv[1])
    if "--check" not in sys.argv[2:]:
        PAGE.write_text(text, encoding="utf-8")
        return 0
    if PAGE.exists() and PAGE.read_text(encoding="utf-8") == text:
        return 0
    print(f"{PAGE}: is not what `burnish describe --json` says; run `make options`")
    return 1


if __name__ == "__main__":
    sys.exit(main())
