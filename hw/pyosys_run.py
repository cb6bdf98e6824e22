#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs a script of Yosys by the package pyosys: PYTHON hw/pyosys_run.py -q -p 'COMMAND; COMMAND', as the program yosys
does. hw/synthesize.sh calls it where YOSYS names it."""
import sys

from pyosys import libyosys

arguments = [argument for argument in sys.argv[1:] if argument != "-q"]
if len(arguments) != 2 or arguments[0] != "-p":
    sys.exit("usage: pyosys_run.py [-q] -p SCRIPT")
design = libyosys.Design()
for command in arguments[1].replace("\n", " ").split(";"):
    if command.strip():
        libyosys.run_pass(command.strip(), design)
