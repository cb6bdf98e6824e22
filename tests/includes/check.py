#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks what includes what in src/burnish: tests/includes/check.py [--self-test].

- A foundation includes only what stands before it in FOUNDATIONS.
- A worker includes foundations, and another worker only where ALLOWED says so.
- What is allowed is used, so that the table stays as short as it can be.
- A house (a folder within a folder) that HOUSES names includes of its own folder only itself and houses before it.
- burnish.h is the public door: its headers, and what they include, name no header of another library.

Tests, benchmarks and testing/ include what they like; nothing else includes them. Prints what is wrong as
FILE: MESSAGE and exits with 1 if anything is. --self-test plants wrong includes and expects each to be found."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2] / "src/burnish"
# Folders and files, each of which may include those before it.
FOUNDATIONS = ["short_message", "error", "json_integer", "file", "embedded_file", "math", "formula", "power",
               "parameterization", "image", "reflectance", "factors", "book", "baselines", "source", "metrics",
               "surface"]
# Workers, and the workers each may include.
ALLOWED = {
    "io": [],
    "fitting": ["shaders"],
    "eval": [],
    "textures": [],
    "shaders": ["eval"],
    "hardware": [],
    "lighting": ["shaders"],
    "report": [],
    "render": ["shaders"],
    "export": ["eval", "fitting", "io", "lighting", "render", "shaders", "textures"],
    "library": ["io", "fitting", "export"],
    "capture": ["eval", "fitting", "io", "render"],
}
# Houses of a folder, each of which may include those before it. What stands beside the houses may include all of them.
HOUSES = {"capture": ["pictures", "texels", "ranks"]}
DOOR = "burnish.h"
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)
# Of the C and C++ libraries: no folder, no suffix.
STANDARD = re.compile(r"[a-z_0-9]+")


def home(name):
    """The ring member a file belongs to: its folder, or its own name without suffix."""
    return name.split("/")[0].split(".")[0]


def serves_tests(name):
    return name.startswith("testing/") or re.search(r"_(test|bench)\.(h|cpp)$", name) is not None


def read_tree():
    """Text of every source by its name below src/burnish."""
    return {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
            for path in sorted(ROOT.rglob("*")) if path.suffix in (".h", ".cpp")}


def includes_of(text):
    """(name, is_ours) of what a text includes, ours named below src/burnish."""
    for quote, name in INCLUDE.findall(text):
        if name.startswith("burnish/"):
            yield name.removeprefix("burnish/"), True
        else:
            yield name, quote == '"'


def wrong_house(source, target):
    """Why a file may not include another of its own folder, or nothing."""
    houses = HOUSES.get(home(source))
    if not houses:
        return None
    inside, outside = (name.split("/")[1] for name in (source, target))
    if inside not in houses:
        return None
    if outside not in houses:
        return f"includes {target}, which stands over the houses"
    if houses.index(outside) > houses.index(inside):
        return f"includes {target}: upward, from {inside} to {outside}"
    return None


def wrong_edge(source, target):
    """Why the file source may not include the file target, or nothing."""
    inside, outside = home(source), home(target)
    if serves_tests(target):
        return f"includes {target}, which serves tests"
    if target == DOOR:
        return f"includes {DOOR}, which is for programs"
    if inside == outside:
        return wrong_house(source, target)
    if outside in ALLOWED:
        if inside in ALLOWED and outside in ALLOWED[inside]:
            return None
        return f"includes {target}: {inside} may not include {outside}"
    if inside in FOUNDATIONS and FOUNDATIONS.index(outside) > FOUNDATIONS.index(inside):
        return f"includes {target}: upward, from {inside} to {outside}"
    return None


def check_rings(tree):
    used = set()
    for source, text in tree.items():
        if serves_tests(source) or source == DOOR:
            continue
        if home(source) not in ALLOWED and home(source) not in FOUNDATIONS:
            yield f"{source}: {home(source)} is neither a foundation nor a worker in tests/includes/check.py"
            continue
        for target, ours in includes_of(text):
            if not ours:
                continue
            if target not in tree:
                yield f"{source}: includes {target}, which is not in src/burnish"
            elif message := wrong_edge(source, target):
                yield f"{source}: {message}"
            used.add((home(source), home(target)))
    for worker, others in ALLOWED.items():
        for other in others:
            if (worker, other) not in used:
                yield f"{worker}: may include {other} and does not"


def public_headers(tree):
    """What burnish.h names and what that includes, by the header that brings it in."""
    found, waiting = {}, [(DOOR, DOOR)]
    while waiting:
        header, through = waiting.pop(0)
        if header in found or header not in tree:
            continue
        found[header] = through
        waiting += [(target, header) for target, ours in includes_of(tree[header]) if ours]
    return found


def check_door(tree):
    for header, through in public_headers(tree).items():
        for target, ours in includes_of(tree[header]):
            if not ours and not STANDARD.fullmatch(target):
                yield f"{header}: is public (through {through}) and includes {target} of another library"
        if header.endswith("-inl.h"):
            yield f"{header}: is public (through {through}) and made to be included by kernels"


def check(tree):
    return [*check_rings(tree), *check_door(tree)]


def self_test(tree):
    """Plants wrong includes, each of which the check has to find."""
    planted = [
        ("math/vec3.h", "<burnish/reflectance/brdf.h>", "upward, from math to reflectance"),
        ("error.cpp", "<burnish/math/vec3.h>", "upward, from error to math"),
        ("source.h", "<burnish/metrics/error_figures.h>", "upward, from source to metrics"),
        ("factors/table.cpp", "<burnish/fitting/fit.h>", "factors may not include fitting"),
        ("eval/factored_eval.cpp", "<burnish/shaders/shader.h>", "eval may not include shaders"),
        ("shaders/shader.h", "<burnish/render/scene.h>", "shaders may not include render"),
        ("capture/pictures/capture.h", "<burnish/capture/texels/texel_lanes.h>", "upward, from pictures to texels"),
        ("capture/texels/texel_solver.cpp", "<burnish/capture/ranks/fit_crew.h>", "upward, from texels to ranks"),
        ("capture/ranks/fit_crew.h", "<burnish/capture/surface_fit.h>", "which stands over the houses"),
        ("io/csv.cpp", "<burnish/testing/files.h>", "which serves tests"),
        ("fitting/fit.h", "<Eigen/Core>", "is public (through burnish.h) and includes Eigen/Core"),
        ("factors/table.h", "<nlohmann/json_fwd.hpp>", "includes nlohmann/json_fwd.hpp of another library"),
    ]
    failures = [f"the tree itself: {message}" for message in check(tree)]
    for name, target, message in planted:
        worse = tree | {name: f"#include {target}\n" + tree[name]}
        if not any(found.startswith(f"{name}: ") and message in found for found in check(worse)):
            failures.append(f"self-test: {target} planted into {name} was not found")
    return failures


def main():
    tree = read_tree()
    wrong = self_test(tree) if "--self-test" in sys.argv[1:] else check(tree)
    print("\n".join(wrong), end="\n" if wrong else "")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
