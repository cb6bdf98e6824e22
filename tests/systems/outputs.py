#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Ten outputs of the command line on two kinds of machine, side by side.

outputs.py run FOLDER COMMAND...   makes the outputs in a new FOLDER by COMMAND (burnish, or an emulator and burnish)
outputs.py compare A B             prints a table of two such folders; exits with 1 where an output is missing or a
                                   number differs by more than its limit
outputs.py --self-test"""
import math
import pathlib
import re
import shlex
import struct
import subprocess
import sys
import tempfile
import time

# Output, the arguments of burnish (@ is the output; without it the output is what burnish prints), and the largest
# difference of two numbers, relative if they exceed 1; 0 asks for the same bits.
EXACT, ROUNDED, FITTED = 0.0, 1e-9, 0.02
OUTPUTS = [
    ("satin.csv", "measure satin -o @ --count 3000 --noise 0.05 --seed 7", ROUNDED),
    ("gold.binary", "convert ggx:alpha_x=0.2,alpha_y=0.2,f0=0.8/0.5/0.3 @", ROUNDED),
    ("info.json", "info --json gold.binary", ROUNDED),
    ("paint.burnish", "fit blinn_phong:exponent=60 -o @ --model pqpr --samples 20000", FITTED),
    ("values.csv", "eval paint.burnish directions.csv -o @", FITTED),
    ("figures.json", "compare --json blinn_phong:exponent=60 paint.burnish", FITTED),
    ("highlight", "export blinn_phong:exponent=60,ks=0.8 -o @ --power cubic2 --to glsl --to wgsl --to cpp", EXACT),
    ("powers.csv", "specular eval --method near_exact --exponent 50 --normalize", ROUNDED),
    ("chosen.txt", "specular choose --max-error 1/255 --exponents 2:200 --lang glsl", EXACT),
    ("hw", "hw generate --all --vectors 200 -o @", EXACT),
]
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def write_inputs(folder):
    """Directions and cosines from integers and square roots, which are the same everywhere."""
    grid = [(x / 5, y / 5) for x in range(-4, 5) for y in range(-4, 5) if x * x + y * y < 25]
    up = [(x, y, math.sqrt(1 - x * x - y * y)) for x, y in grid]
    rows = [up[i] + up[(7 * i + 3) % len(up)] for i in range(len(up))]
    lines = ["wi_x,wi_y,wi_z,wo_x,wo_y,wo_z"] + [",".join(map(repr, row)) for row in rows]
    (folder / "directions.csv").write_text("\n".join(lines) + "\n")


def run(folder, command):
    folder.mkdir()
    write_inputs(folder)
    cosines = "".join(f"{i / 256}\n" for i in range(257)).encode()
    for output, arguments, _ in OUTPUTS:
        words = [output if word == "@" else word for word in shlex.split(arguments)]
        start = time.monotonic()
        done = subprocess.run([*command, *words], cwd=folder, input=cosines, capture_output=True)
        if done.returncode != 0:
            sys.exit(f"burnish {shlex.join(words)}: exit status {done.returncode}\n{done.stderr.decode()[-1000:]}")
        if "@" not in arguments:
            (folder / output).write_bytes(done.stdout)
        print(f"{output}: {time.monotonic() - start:.1f} s", flush=True)


def numbers_of(path):
    """The numbers of a text or of a MERL file, and what is between them; None of another binary file."""
    data = path.read_bytes()
    if path.suffix == ".binary":
        return list(struct.unpack(f"<{(len(data) - 12) // 8}d", data[12:])), data[:12]
    try:
        text = data.decode()
    except UnicodeDecodeError:
        return None
    return [float(number) for number in NUMBER.findall(text)], NUMBER.sub("#", text)


def files_of(path):
    return {str(p.relative_to(path)): p for p in sorted(path.rglob("*")) if p.is_file()} if path.is_dir() else {"": path}


def difference(a, b):
    """What differs between two outputs: words, and the largest difference (infinite where it is no number's)."""
    files, others = files_of(a), files_of(b)
    if files.keys() != others.keys():
        return "other files", math.inf
    pairs = [(files[name], others[name]) for name in files]
    different = [(x, y) for x, y in pairs if x.read_bytes() != y.read_bytes()]
    if not different:
        return f"the same bits, {sum(p.stat().st_size for p in files.values())} bytes", 0.0
    worst, count = 0.0, 0
    for x, y in different:
        found, other = numbers_of(x), numbers_of(y)
        if found is None or other is None:
            # The numbers of a model are compared by its values, a line of their own.
            count += sum(p != q for p, q in zip(x.read_bytes(), y.read_bytes()))
            return f"{count} of {x.stat().st_size} and {y.stat().st_size} bytes differ", None
        if found[1] != other[1] or len(found[0]) != len(other[0]):
            return f"other words in {x.name}", math.inf
        for v, w in zip(found[0], other[0]):
            if v != w:
                count += 1
                worst = max(worst, abs(v - w) / max(abs(v), 1.0))
    return f"{count} numbers differ, by at most {worst:.1e}", worst


def compare(a, b):
    failed = False
    print("| output | command | difference |\n|---|---|---|")
    for output, arguments, limit in OUTPUTS:
        if not (a / output).exists() or not (b / output).exists():
            words, worst = "missing", math.inf
        else:
            words, worst = difference(a / output, b / output)
        # Files of models may differ wherever fits may.
        bad = limit == EXACT if worst is None else worst > limit
        failed |= bad
        print(f"| {output} | `{arguments.split(' -o')[0]}` | {words}{' (TOO FAR)' if bad else ''} |")
    return 1 if failed else 0


def self_test():
    with tempfile.TemporaryDirectory() as scratch:
        a, b = pathlib.Path(scratch) / "a.csv", pathlib.Path(scratch) / "b.csv"
        a.write_text("x,1.0,-2e3\n")
        for text, expected in (("x,1.0,-2e3\n", 0.0), ("x,1.5,-2e3\n", 0.5), ("x,1.0,-1e3\n", 0.5), ("y,1.0,-2e3\n", math.inf),
                               ("x,1.0\n", math.inf)):
            b.write_text(text)
            words, worst = difference(a, b)
            assert worst == expected, (text, words, worst)
        b.write_bytes(b"\xff\xfe")
        assert difference(a, b)[1] is None
        a.unlink(), b.unlink(), a.mkdir(), b.mkdir()
        (a / "one").write_text("1"), (b / "two").write_text("1")
        assert difference(a, b)[1] == math.inf
    print("outputs.py finds what differs")


if __name__ == "__main__":
    if sys.argv[1:] == ["--self-test"]:
        self_test()
    elif len(sys.argv) > 3 and sys.argv[1] == "run":
        run(pathlib.Path(sys.argv[2]), sys.argv[3:])
    elif len(sys.argv) == 4 and sys.argv[1] == "compare":
        sys.exit(compare(pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])))
    else:
        sys.exit(__doc__)
