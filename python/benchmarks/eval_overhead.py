#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a call from Python costs over C++: seconds for N direction pairs, one thread, and ratios.

The C++ figures are FactoredEvaluator::eval on the very same arrays, timed inside the extension without Python; ratios
are over the faster one, planes of components or rows of three. Rounds of all candidates take turns, three calls in a row
each so that caches are as warm for all, and the best call counts.
"""

import argparse
import time

import numpy as np

import burnish
from burnish import _burnish


REPEATS = 3


def timed(call):
    best = float("inf")
    for _ in range(REPEATS):
        start = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - start)
    return best


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=1_000_000)
    parser.add_argument("--rounds", type=int, default=40)
    arguments = parser.parse_args()

    source = burnish.open_source("ggx:alpha_x=0.2,alpha_y=0.2")
    rows = [w.astype(np.float32) for w in burnish.draw_pairs(arguments.count)]
    planes = [np.asfortranarray(w) for w in rows]
    for name, options in (
        ("p(wo) q(h) p(wi)", {}),
        ("the same on disks of 64 x 64", {"tables": ["p=64x64", "q=64x64"]}),
        ("2,700 bytes, several lobes", {"budget": 2700}),
    ):
        model = burnish.fit(source, **options)
        out_rows, out_planes = model.eval(*rows), model.eval(*planes)
        np.testing.assert_array_equal(out_rows, out_planes)
        candidates = {
            "C++, components in planes": lambda: _burnish._time_eval(model, *planes, out_planes, REPEATS),
            "C++, rows of three": lambda: _burnish._time_eval(model, *rows, out_rows, REPEATS),
            "Python, components in planes (order='F'), out given": lambda: timed(
                lambda: model.eval(*planes, out=out_planes)
            ),
            "Python, components in planes, new result": lambda: timed(lambda: model.eval(*planes)),
            "Python, rows of three (order='C'), out given": lambda: timed(lambda: model.eval(*rows, out=out_rows)),
            "Python, rows of three, new result": lambda: timed(lambda: model.eval(*rows)),
        }
        best = dict.fromkeys(candidates, float("inf"))
        with burnish.ThreadLimit(1):
            for _ in range(arguments.rounds):
                for key, candidate in candidates.items():
                    best[key] = min(best[key], candidate())
        baseline = min(seconds for key, seconds in best.items() if key.startswith("C++"))
        print(f"{name}: {model.expression}")
        for key, seconds in best.items():
            print(f"  {key:<54} {1e9 * seconds / arguments.count:6.2f} ns  {seconds / baseline:.3f}")


if __name__ == "__main__":
    main()
