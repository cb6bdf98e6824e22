#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares what the command line, Python and the page's package say of wrong combinations of fit options.

    tests/options/agree.py BURNISH [--python build/venv/bin/python] [--package build/studio/package] [--table]

Messages name options as each place spells them (--hold-out, hold_out, holdOut) and are equal otherwise. `burnish describe
--json` has the three spellings. A place that is not built is left out with a message. --table prints them in Markdown."""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

# By name in Python. A flag is True. All are of options that the three places have.
WRONG = [
    {"model": "pqp", "budget": 2700},
    {"model": "pqp", "tables": ["q=8"], "budget": 2700},
    {"tables": ["q=8"], "budget": "16K"},
    {"fetches": 2},
    {"fetches": 2, "lobes": 3, "budget": 2700},
    {"fetches": 2, "search": True, "budget": 2700},
    {"fetches": 0, "budget": 2700},
    {"fetches": 257, "budget": 2700},
    {"lobes": 3},
    {"lobes": 3, "search": True},
    {"lobes": 65, "budget": 2700},
    {"search": True},
    {"budget": 0},
    {"budget": "16Q"},
    {"loss": "psnr"},
    {"target": "node"},
    {"hold_out": "quarter"},
    {"hold_out": "theta_i=-1"},
    {"floor": 0},
    {"floor": 2},
    {"smooth": -1},
    {"samples": 0},
    {"reweightings": 101},
    {"format": "jpeg"},
]
SOURCE = "ggx:alpha_x=0.3,alpha_y=0.3"

PYTHON = """
import json, sys
import burnish
source = burnish.open_source(sys.argv[1])
found = []
for options in json.load(sys.stdin):
    try:
        burnish.fit(source, **options)
        found.append(None)
    except (TypeError, ValueError, burnish.Error) as error:
        found.append(str(error))
print(json.dumps(found))
"""

PACKAGE = """
import fs from "node:fs";
const {open} = await import(process.argv[2]);
const source = await open(process.argv[3]), found = [];
for (const options of JSON.parse(fs.readFileSync(0, "utf8"))) {
  try {
    await source.fit(options);
    found.push(null);
  } catch (error) {
    found.push(error.message);
  }
}
console.log(JSON.stringify(found));
process.exit(0);
"""


def of_command_line(burnish, rows, options, folder):
    found = []
    for row in rows:
        words = []
        for name, value in row.items():
            for one in value if isinstance(value, list) else [value]:
                words += [options[name]["command_line"]] + ([] if one is True else [str(one)])
        done = subprocess.run([burnish, "fit", SOURCE, "-o", f"{folder}/model.burnish", *words], capture_output=True, text=True)
        found.append(done.stderr.splitlines()[0].removeprefix("burnish: ") if done.returncode == 2 else None)
    return found


def of_program(command, rows):
    done = subprocess.run(command, input=json.dumps(rows), capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{command[0]}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def as_python_says(message, place, options):
    """The message with each option as Python names it."""
    if message is None:
        return None
    spelled = {option[place]: name for name, option in options.items() if option[place]}
    by_length = "|".join(re.escape(word) for word in sorted(spelled, key=len, reverse=True))
    return re.sub(rf"(?<![\w-])(?:{by_length})(?![\w-])", lambda word: spelled[word[0]], message)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("burnish")
    parser.add_argument("--python", default="build/venv/bin/python")
    parser.add_argument("--package", default="build/studio/package")
    parser.add_argument("--table", action="store_true")
    arguments = parser.parse_args()
    described = json.loads(subprocess.run([arguments.burnish, "describe", "--json"], capture_output=True, text=True, check=True).stdout)
    options = {option["python"]: option for option in described["fit_options"] if option["python"]}

    with tempfile.TemporaryDirectory() as folder:
        said = {"command_line": of_command_line(arguments.burnish, WRONG, options, folder)}
    if subprocess.run([arguments.python, "-c", "import burnish"], capture_output=True, check=False).returncode == 0:
        said["python"] = of_program([arguments.python, "-c", PYTHON, SOURCE], WRONG)
    else:
        print("fit options: SKIPPED: Python's messages, as burnish is not installed there", file=sys.stderr)
    module = pathlib.Path(arguments.package, "index.js").resolve()
    if module.exists():
        rows = [{options[name]["package"]: value for name, value in row.items()} for row in WRONG]
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder, "fit.mjs")
            program.write_text(PACKAGE)
            said["package"] = of_program(["node", str(program), module.as_uri(), SOURCE], rows)
    else:
        print(f"fit options: SKIPPED: the package's messages; make studio builds {module}", file=sys.stderr)

    wrong = 0
    for i, row in enumerate(WRONG):
        messages = {place: as_python_says(of_place[i], place, options) for place, of_place in said.items()}
        if None in messages.values() or len(set(messages.values())) > 1:
            wrong += 1
            print(f"{row}: {json.dumps({place: said[place][i] for place in said})}", file=sys.stderr)
        elif arguments.table:
            given = ", ".join(f"`{name}={value}`" for name, value in row.items())
            print(f"| {given} | {messages['command_line']} |")
    print(f"fit options: {len(WRONG)} wrong combinations, {wrong} told otherwise among {', '.join(said)}")
    return wrong > 0


if __name__ == "__main__":
    sys.exit(main())
