#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How far a book carries a library: tests/library/book.py BURNISH [--folds N] [--every N] [--counts 5 20 100]
[--draws N] [--only KIND] [--keep FOLDER].

The library is the 100 MERL stand-ins of BURNISH_DATA/np, its stand-ins of RGL materials (--without-films: without
them), and the measured materials of BURNISH_DATA/rgl, of which no stand-in is taken. One book is made of all of it, and
N more, each of all but an Nth: with eight folds each measured material is left out alone. Scored are the measured
materials and every 10th MERL stand-in: as one of the book's; left out, its weights found of all that is known of it;
and left out, completed from a few random pairs by the book and by `fit` on these pairs alone, several draws of them.
Prints means of `burnish compare --count 20000`, of each draw as they come; and, of each count, the error of the book
over that of `fit`, draw by draw.

With --keep FOLDER books, pairs and the fits of pairs alone are made once and left there: another run, by another
BURNISH, completes and compares alone, which takes a minute. The figures of each run are left there by the name of
--run, beside which a later one is set with --beside NAME."""
import argparse
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

FIRST_SEED = 7
KINDS = ("stand-ins", "measured")


class Bench:
    def __init__(self, burnish, folder, counts, draws):
        self.burnish, self.folder, self.counts, self.draws = burnish, folder, counts, draws
        self.rows = {}  # what -> kind of material -> (psnr, relative) of each
        self.errors = {}  # "material, count, draw" -> relative of the book, of fit

    def run(self, *arguments):
        done = subprocess.run([self.burnish, *map(str, arguments)], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"book.py: burnish {' '.join(map(str, arguments))}: {done.stderr}")
        return done.stdout

    def book(self, name, arguments, *more):
        """(file of the book, what it says of itself); as it was made before of the same materials."""
        path, listed, says = (self.folder / f"{name}.{ending}" for ending in ("burnish", "txt", "json"))
        text = "\n".join(arguments)
        if not says.exists() or listed.read_text() != text:
            listed.write_text(text)
            says.write_text(self.run("book", listed, "-o", path, "--json", *more))
        return path, json.loads(says.read_text())

    def pairs(self, argument, name, count, seed):
        """(file of the pairs, their fit alone), made once."""
        pairs, alone = (self.folder / f"{name}-{count}-{seed}{ending}" for ending in (".csv", "-fit.burnish"))
        if not alone.exists():
            self.run("measure", argument, "-o", pairs, "--count", count, "--seed", seed)
            self.run("fit", pairs, "-o", alone)
        return pairs, alone

    def score(self, argument, of, whole, shared):
        """Adds the figures of one material that is left out of `shared`."""
        held, said = self.book(f"{shared.stem}-{argument.rpartition('/')[2].rpartition('#')[2]}", [argument],
                               "--shared", shared)
        name = said["materials"][0]
        models = [("in the book", f"book:{whole}#{name}"), ("left out, all known", f"book:{held}#{name}")]
        for count in self.counts:
            for seed in range(FIRST_SEED, FIRST_SEED + self.draws):
                pairs, alone = self.pairs(argument, name, count, seed)
                completed = self.folder / f"{count}-{seed}-book.burnish"
                self.run("fit", pairs, "-o", completed, "--book", shared)
                models += [(f"{count} pairs, book", completed), (f"{count} pairs, fit", alone)]
        figures = json.loads(self.run("compare", argument, *(path for _, path in models), "--count", 20000, "--json"))
        for (what, _), figure in zip(models, figures):
            self.rows.setdefault(what, {}).setdefault(of, []).append((figure["psnr"], figure["relative"]))
        relatives = iter(figure["relative"] for figure in figures[2:])
        for count in self.counts:
            for draw in range(self.draws):
                self.errors[f"{of}, {count} pairs, draw {draw}, {name}"] = next(relatives), next(relatives)
        print(f"{name}: " + ", ".join(f"{figure['psnr']:.1f} dB {figure['relative']:.3f}" for figure in figures),
              file=sys.stderr)

    def print_ratios(self, before):
        """Of each kind and count, and of both kinds: means by draw and of all, and by how much pairs' errors differ
        from before."""
        kinds, counts = (dict.fromkeys(key.split(", ")[at] for key in self.errors) for at in (0, 1))
        together = {"both": list(kinds)} if len(kinds) > 1 else {}
        for kind, count in ((kind, count) for count in counts for kind in [*kinds, *together]):
            group = (kind, count)
            keys = [key for key in self.errors
                    if key.split(", ")[0] in together.get(kind, [kind]) and key.split(", ")[1] == count]
            ratios = []
            for draw in range(self.draws):
                book, fit = zip(*(self.errors[key] for key in keys if f", draw {draw}, " in key))
                ratios.append(statistics.fmean(book) / statistics.fmean(fit))
            book, fit = (statistics.fmean(self.errors[key][k] for key in keys) for k in (0, 1))
            print(f"{', '.join(group)}: {book:.4f} / {fit:.4f} = {book / fit:.3f}, by draw "
                  + " ".join(f"{ratio:.3f}" for ratio in ratios), end="")
            changes = [self.errors[key][0] - before[key][0] for key in keys if key in before]
            if len(changes) > 1:
                spread = statistics.stdev(changes) / len(changes) ** 0.5
                print(f"; changed by {statistics.fmean(changes):+.4f} +- {spread:.4f}", end="")
            print()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("burnish")
    parser.add_argument("--folds", type=int, default=8)
    parser.add_argument("--every", type=int, default=10, help="of the stand-ins, this one is scored")
    parser.add_argument("--counts", type=int, nargs="+", default=[5, 20, 100])
    parser.add_argument("--draws", type=int, default=3, help="of the pairs of a count")
    parser.add_argument("--without-films", action="store_true", help="leave the stand-ins of RGL materials out")
    parser.add_argument("--only", choices=KINDS, help="score these alone")
    parser.add_argument("--keep", type=pathlib.Path, metavar="FOLDER", help="made once, and used again")
    parser.add_argument("--run", default="latest", metavar="NAME", help="of --keep: under which figures are kept")
    parser.add_argument("--beside", metavar="NAME", help="of --keep: an earlier run to compare with")
    arguments = parser.parse_args()
    if arguments.beside and not arguments.keep:
        parser.error("--beside takes --keep")
    data = os.environ.get("BURNISH_DATA")
    if not data:
        sys.exit("book.py: expected BURNISH_DATA to name the measurements")
    names = [line.split(",")[0] for line in pathlib.Path(data, "np/codes.csv").read_text().splitlines()]
    measured = [str(path) for path in sorted(pathlib.Path(data, "rgl").glob("*.bsdf"))]
    known = {path.stem for below in ("rgl", "repeat") for path in pathlib.Path(data, below).glob("*.bsdf")}
    stand_ins = [f"np:{data}/np#{name}" for name in names if not name.endswith("_rgb")]
    films = [f"np:{data}/np#{name}" for name in names if name.endswith("_rgb") and name not in known]
    if arguments.without_films:
        films = []
    scored = set(measured + stand_ins[::arguments.every])
    with tempfile.TemporaryDirectory() as name:
        folder = arguments.keep or pathlib.Path(name)
        folder.mkdir(parents=True, exist_ok=True)
        bench = Bench(os.path.abspath(arguments.burnish), folder, arguments.counts, arguments.draws)
        library = stand_ins + films + measured
        whole, said = bench.book("whole", library)
        print(f"{len(library)} materials of {said['bytes_a_material']} bytes, {said['shared_bytes']} shared")
        for fold in range(arguments.folds):
            out = [argument for kind in (stand_ins, films, measured) for argument in kind[fold::arguments.folds]]
            shared, _ = bench.book(f"without-{fold}", [argument for argument in library if argument not in out])
            for argument in out:
                kind = KINDS[argument in measured]
                if argument in scored and arguments.only in (None, kind):
                    bench.score(argument, kind, whole, shared)
        print(f"{'':22}" + "".join(f"{len(bench.rows['in the book'].get(of, [])):4} {of:<17}" for of in KINDS))
        for what, row in bench.rows.items():
            cells = [tuple(map(statistics.fmean, zip(*row[of]))) if of in row else (math.nan, math.nan) for of in KINDS]
            print(f"{what:22}" + "".join(f"{psnr:6.2f} dB {relative:6.3f}      " for psnr, relative in cells))
        before = json.loads((folder / f"{arguments.beside}.run").read_text()) if arguments.beside else {}
        bench.print_ratios(before)
        (folder / f"{arguments.run}.run").write_text(json.dumps(bench.errors))


if __name__ == "__main__":
    main()
