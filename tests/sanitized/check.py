#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the list of what sanitizers leave out to the tests that there are: tests/sanitized/check.py PROGRAM... [--self-test].

Each line of left_out.txt has to name tests of these programs of GoogleTest tests, as their filters do, and no line what
another does. A suite that loses all its tests has to be named by a pattern such as SUITE.*, so that nothing is left
unsanitized by chance. Prints what is wrong and exits with 1
if anything is; --self-test plants each fault in a list and expects it to be found."""
import fnmatch
import pathlib
import subprocess
import sys

LIST = pathlib.Path(__file__).resolve().parent / "left_out.txt"


def tests_of(program):
    """Names of the tests of a program, as SUITE.TEST."""
    found, suite = [], ""
    listing = subprocess.run([program, "--gtest_list_tests"], capture_output=True, text=True, check=True).stdout
    for line in listing.splitlines():
        name = line.split("#")[0].rstrip()
        if name.startswith("  "):
            found.append(suite + name.strip())
        elif name.endswith("."):
            suite = name
    return found


def suite_of(test):
    return test.split(".")[0]


def read_list(text):
    return [line for line in text.splitlines() if line and not line.startswith("#")]


def faults(names, tests):
    """What is wrong with the names of a list, a sentence each."""
    matched = {name: [test for test in tests if fnmatch.fnmatchcase(test, name)] for name in names}
    wrong = [f"expected names of tests, found {name}" for name, found in matched.items() if not found]
    wrong += [f"{name} is named twice" for name in matched if names.count(name) > 1]
    left_out = [test for found in matched.values() for test in found]
    wrong += [f"{test} is named by two lines" for test in sorted(set(left_out)) if left_out.count(test) > 1]
    whole = {suite_of(test) for name in names if "*" in name for test in matched[name]}
    for suite in sorted({suite_of(test) for test in left_out} - whole):
        if all(test in left_out for test in tests if suite_of(test) == suite):
            wrong.append(f"{suite} runs nowhere with sanitizers: expected a shorter test of it, or a line {suite}.*")
    return wrong


def self_test():
    tests = ["A.One", "A.Two", "B.One"]
    assert not faults(["A.One", "B.*"], tests)
    for names in (["A.Three"], ["A.One", "A.One"], ["A.One", "A.*"], ["A.One", "A.Two"], ["B.One"], ["C.*"]):
        assert len(faults(names, tests)) == 1, names


def main(arguments):
    if "--self-test" in arguments:
        self_test()
    tests = [test for program in arguments if program != "--self-test" for test in tests_of(program)]
    wrong = faults(read_list(LIST.read_text(encoding="utf-8")), tests)
    for fault in wrong:
        print(f"{LIST.name}: {fault}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
