#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Executes the notebooks of this folder: docs/notebooks/run.py [--out FOLDER] [NAME...], all of them without a name.

Needs what `pip install '.[notebooks]'` installs. Each runs in a folder of its own, FOLDER/NAME (build/notebooks), and
is written to FOLDER/NAME.ipynb with what it printed and drew; all run at once. The notebooks here have no outputs; one
that has them is an error. Prints what is wrong as FILE: MESSAGE and exits with 1 if anything is."""
import argparse
import concurrent.futures
import pathlib
import shutil
import sys

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

HERE = pathlib.Path(__file__).resolve().parent
SECONDS = 300  # a cell's


def run(file, out):
    """What is wrong with a notebook, or nothing."""
    book = nbformat.read(file, as_version=4)
    nbformat.validate(book)
    if any(cell.get("outputs") or cell.get("execution_count") for cell in book.cells):
        return f"{file.name}: expected no outputs, found some; clear them before a commit"
    folder = out / file.stem
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    client = NotebookClient(book, timeout=SECONDS, kernel_name="python3", extra_arguments=["--log-level=40"],
                            resources={"metadata": {"path": str(folder)}})
    try:
        client.execute()
    except CellExecutionError as error:
        return f"{file.name}: {error}"
    nbformat.write(book, out / file.name)
    return None


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("names", nargs="*", metavar="NAME")
    arguments.add_argument("--out", type=pathlib.Path, default=HERE.parents[1] / "build/notebooks")
    given = arguments.parse_args()
    files = [HERE / f"{name}.ipynb" for name in given.names] or sorted(HERE.glob("*.ipynb"))
    for file in files:
        if not file.exists():
            arguments.error(f"expected a notebook of {HERE}, found '{file.stem}'")
    given.out.mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(len(files)) as pool:
        wrong = [message for message in pool.map(lambda file: run(file, given.out.resolve()), files) if message]
    print("\n".join(wrong) if wrong else f"{len(files)} notebooks executed")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
