#!/usr/bin/env python3
"""How far a book carries a library: tests/library/book.py BURNISH [--folds N] [--every N] [--counts 5 20 100]
[--draws N].

The library is the 100 MERL stand-ins of BURNISH_DATA/np, its stand-ins of RGL materials (--without-films: without
them), and the measured materials of BURNISH_DATA/rgl, of which no stand-in is taken. One book is made of all of it, and
N more, each of all but an Nth: with eight folds each measured material is left out alone. Scored are the measured
materials and every 10th MERL stand-in: as one of the book's; left out, its weights found of all that is known of it;
and left out, completed from a few random pairs by the book and by `fit` on these pairs alone, several draws of them.
Prints means of `burnish compare --count 20000`, of each draw as they come."""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

FIRST_SEED = 7


class Bench:
    def __init__(self, burnish, folder, counts, draws):
        self.burnish, self.folder, self.counts, self.draws, self.rows = burnish, folder, counts, draws, {}

    def run(self, *arguments):
        done = subprocess.run([self.burnish, *map(str, arguments)], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"book.py: burnish {' '.join(map(str, arguments))}: {done.stderr}")
        return done.stdout

    def book(self, name, arguments, *more):
        """(file of the book, what it says of itself)"""
        path, listed = self.folder / f"{name}.burnish", self.folder / f"{name}.txt"
        listed.write_text("\n".join(arguments))
        return path, json.loads(self.run("book", listed, "-o", path, "--json", *more))

    def score(self, argument, of, whole, shared):
        """Adds the figures of one material that is left out of `shared`."""
        held, said = self.book("held", [argument], "--shared", shared)
        name = said["materials"][0]
        models = [("in the book", f"book:{whole}#{name}"), ("left out, all known", f"book:{held}#{name}")]
        for count in self.counts:
            for seed in range(FIRST_SEED, FIRST_SEED + self.draws):
                pairs = self.folder / "pairs.csv"
                self.run("measure", argument, "-o", pairs, "--count", count, "--seed", seed)
                for how, options in (("book", ["--book", shared]), ("fit", [])):
                    path = self.folder / f"{count}-{seed}-{how}.burnish"
                    self.run("fit", pairs, "-o", path, *options)
                    models.append((f"{count} pairs, {how}", path))
        figures = json.loads(self.run("compare", argument, *(path for _, path in models), "--count", 20000, "--json"))
        for (what, _), figure in zip(models, figures):
            self.rows.setdefault(what, {}).setdefault(of, []).append((figure["psnr"], figure["relative"]))
        print(f"{name}: " + ", ".join(f"{figure['psnr']:.1f} dB {figure['relative']:.3f}" for figure in figures),
              file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("burnish")
    parser.add_argument("--folds", type=int, default=8)
    parser.add_argument("--every", type=int, default=10, help="of the stand-ins, this one is scored")
    parser.add_argument("--counts", type=int, nargs="+", default=[5, 20, 100])
    parser.add_argument("--draws", type=int, default=3, help="of the pairs of a count")
    parser.add_argument("--without-films", action="store_true", help="leave the stand-ins of RGL materials out")
    arguments = parser.parse_args()
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
        bench = Bench(os.path.abspath(arguments.burnish), pathlib.Path(name), arguments.counts, arguments.draws)
        library = stand_ins + films + measured
        whole, said = bench.book("whole", library)
        print(f"{len(library)} materials of {said['bytes_a_material']} bytes, {said['shared_bytes']} shared")
        for fold in range(arguments.folds):
            out = [argument for kind in (stand_ins, films, measured) for argument in kind[fold::arguments.folds]]
            shared, _ = bench.book("shared", [argument for argument in library if argument not in out])
            for argument in out:
                if argument in scored:
                    bench.score(argument, "measured" if argument in measured else "stand-ins", whole, shared)
        kinds = ("stand-ins", "measured")
        print(f"{'':22}" + "".join(f"{len(bench.rows['in the book'].get(of, [])):4} {of:<17}" for of in kinds))
        for what, row in bench.rows.items():
            cells = [tuple(map(statistics.fmean, zip(*row[of]))) for of in kinds if of in row]
            print(f"{what:22}" + "".join(f"{psnr:6.2f} dB {relative:6.3f}      " for psnr, relative in cells))


if __name__ == "__main__":
    main()
