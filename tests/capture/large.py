#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""large.py BURNISH CAPTURE BOOK FOLDER [--times K]: weights alone of a large surface, beside the disk.

Repeats the texels of a capture (uncompressed OpenEXR, lights and views as directions, as `burnish measure --surface` makes
it) K times along both axes into FOLDER, has the system forget the files, reads them with `cat`, has it forget them again,
and finds the weights of BOOK's lobes with `burnish fit-surface --book`. Prints times, rates and the peak of memory.
"""
import argparse
import json
import os
import pathlib
import resource
import struct
import subprocess
import sys
import time


def attributes(data):
    """Names, types and values of an OpenEXR header, and where it ends."""
    at, found = 8, []
    while data[at]:
        name, kind = data[at:at + 80].split(b"\0", 2)[:2]
        at += len(name) + len(kind) + 2
        size = struct.unpack_from("<i", data, at)[0]
        found.append((name, kind, data[at + 4:at + 4 + size]))
        at += 4 + size
    return found, at + 1


def repeat_picture(source, target, times):
    """Rows of each channel beside each other, and all of them below each other."""
    data = source.read_bytes()
    header, start = attributes(data)
    values = {name: value for name, _, value in header}
    if values[b"compression"] != b"\0":
        sys.exit(f"large.py: {source}: expected no compression")
    width, height = (n + 1 for n in struct.unpack("<4i", values[b"dataWindow"])[2:])
    sizes, channels = (2, 4), values[b"channels"]  # bytes of a half, a float
    widths, at = [], 0
    while channels[at]:
        at = channels.index(b"\0", at) + 1
        widths.append(width * sizes[struct.unpack_from("<i", channels, at)[0] - 1])
        at += 16
    window = struct.pack("<4i", 0, 0, times * width - 1, times * height - 1)
    with open(target, "wb") as out:
        out.write(data[:8])
        for name, kind, value in header:
            value = window if name in (b"dataWindow", b"displayWindow") else value
            out.write(name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value)
        out.write(b"\0")
        chunk, first = 8 + times * sum(widths), out.tell() + 8 * times * height
        out.write(struct.pack(f"<{times * height}Q", *(first + chunk * y for y in range(times * height))))
        offsets = struct.unpack_from(f"<{height}Q", data, start)
        rows = []
        for offset in offsets:
            at, parts = offset + 8, []
            for size in widths:
                parts.append(data[at:at + size] * times)
                at += size
            rows.append(b"".join(parts))
        for y in range(times * height):
            out.write(struct.pack("<2i", y, chunk - 8) + rows[y % height])
        out.flush()
        os.fsync(out.fileno())


def forget(folder):
    """The system's copies of the files in memory."""
    for path in folder.iterdir():
        with open(path, "rb") as file:
            os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("burnish")
    parser.add_argument("capture", type=pathlib.Path)
    parser.add_argument("book")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--times", type=int, default=4)
    arguments = parser.parse_args()
    folder, times = arguments.folder, arguments.times

    capture = json.loads((arguments.capture / "capture.json").read_text())
    folder.mkdir(parents=True, exist_ok=True)
    names = [picture["file"] for picture in capture["pictures"]] + [capture["normals"]]
    for name in names:
        repeat_picture(arguments.capture / name, folder / name, times)
    side = capture["width"] * times, capture["height"] * times
    (folder / "capture.json").write_text(json.dumps({**capture, "width": side[0], "height": side[1]}))
    total = sum(path.stat().st_size for path in folder.iterdir())

    def timed(command):
        forget(folder)
        begin = time.time()
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        return time.time() - begin

    cat = timed(["sh", "-c", f"cat '{folder}'/*.exr > /dev/null"])
    fit = timed([arguments.burnish, "fit-surface", str(folder), "-o", str(folder) + ".burnish", "--book", arguments.book])
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024
    print(f"{side[0]} x {side[1]} texels, {len(capture['pictures'])} pictures, {total / 1e9:.2f} GB")
    print(f"cat          {cat:7.1f} s  {total / cat / 1e9:.2f} GB/s")
    print(f"fit-surface  {fit:7.1f} s  {total / fit / 1e9:.2f} GB/s, {side[0] * side[1] / fit / 1e6:.2f} million texels a second, "
          f"{cat / fit:.2f} of cat's speed, at most {peak / 1e9:.2f} GB of memory")


if __name__ == "__main__":
    main()
