# SPDX-License-Identifier: Apache-2.0
"""The notebooks of the documents run from an empty folder and have what they say."""

import pathlib
import subprocess
import sys

import pytest

RUN = pathlib.Path(__file__).resolve().parents[2] / "docs/notebooks/run.py"


@pytest.mark.parametrize("name", sorted(file.stem for file in RUN.parent.glob("*.ipynb")))
def test_notebook_runs(name, tmp_path):
    pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    done = subprocess.run([sys.executable, RUN, name, "--out", tmp_path], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    # Every notebook draws something.
    assert '"image/png"' in (tmp_path / f"{name}.ipynb").read_text()


def test_a_cell_that_fails_is_said(tmp_path):
    nbformat = pytest.importorskip("nbformat")
    pytest.importorskip("ipykernel")
    sys.path.insert(0, str(RUN.parent))
    import run

    book = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("assert 1 == 2, 'no'")])
    nbformat.write(book, tmp_path / "bad.ipynb")
    assert "AssertionError" in run.run(tmp_path / "bad.ipynb", tmp_path / "out")
    book.cells[0].outputs = [nbformat.v4.new_output("stream", text="said before")]
    nbformat.write(book, tmp_path / "bad.ipynb")
    assert "expected no outputs" in run.run(tmp_path / "bad.ipynb", tmp_path / "out")
