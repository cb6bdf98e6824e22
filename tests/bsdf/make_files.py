#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes ten window files with Radiance's own programs: python3 tests/bsdf/make_files.py FOLDER

Needs PyPI's pyradiance (1.3.1), which brings bsdf2klems, bsdf2ttree and wrapBSDF, and genBSDF as a function. Blinds are
sampled by genBSDF over three bases and as a tree; formulas become patches and trees of both ranks; wrapBSDF joins two
bands and both sides. The random numbers of rfluxmtx are not ours, so two runs differ by their noise."""
import os
import pathlib
import random
import subprocess
import sys

# Scattered light, a wide highlight and a narrow one, a reflection and what passes through: functions of the incident
# and the outgoing direction, in Radiance's frame.
FORMULAS = """
lobe(ix,iy,ox,oy,e) : exp(-((ix+ox)^2 + (iy+oy)^2)*e);
sheet(ix,iy,iz,ox,oy,oz) = if(iz*oz, .05/PI + .3*lobe(ix,iy,ox,oy,20), if(-iz*oz, .02 + .8*lobe(ix,iy,ox,oy,60), 0));
gloss(ix,iy,iz,ox,oy,oz) = if(iz*oz, .1/PI + 2*lobe(ix,iy,ox,oy,150), 0);
sides(ix,iy,iz,ox,oy,oz) = if(iz*oz, if(iz, .4, .1)/PI, if(-iz*oz, if(iz, .03, .02)/PI, 0));
"""
PATCHES = 145
RAYS = ["-ab", "2", "-ad", "16"]  # few: noise does not matter here, time does


def programs():
    import pyradiance
    folder = pathlib.Path(pyradiance.__file__).parent
    os.environ["PATH"] = f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}"
    os.environ["RAYPATH"] = f".{os.pathsep}{folder / 'lib'}"
    return pyradiance


def run(*command, cwd):
    done = subprocess.run(command, cwd=cwd, capture_output=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: {done.stderr[-400:].decode(errors='replace')}")
    return done.stdout


def blinds(pyradiance):
    material = pyradiance.ShadingMaterial(0.5, 0.05, 0.1)
    geometry = pyradiance.BlindsGeometry(depth=0.05, width=0.5, height=0.5, nslats=9, angle=30)
    return pyradiance.generate_blinds_for_bsdf(material, geometry)


def by_genbsdf(pyradiance, folder):
    device = blinds(pyradiance)
    for basis in ("kf", "kh", "kq"):
        made = pyradiance.generate_bsdf(device, basis=basis, nsamp=4, params=RAYS)
        (folder / f"blinds_{basis}.xml").write_bytes(pyradiance.generate_xml(vis_results=made, basis=basis))
    made = pyradiance.generate_bsdf(device, tensortree=4, ttlog2=3, nsamp=4, params=RAYS)
    (folder / "blinds_t4.xml").write_bytes(pyradiance.generate_xml(vis_results=made, basis="t4"))


def by_formulas(folder):
    (folder / "formulas.cal").write_text(FORMULAS)
    both = ("+forward", "+backward", "-f", "formulas.cal")
    for name, command in {"sheet_full": ("bsdf2klems", "-n", "4", *both, "sheet"),
                          "sheet_half": ("bsdf2klems", "-h", "-n", "4", *both, "sheet"),
                          "sides_t4": ("bsdf2ttree", "-t4", "-g", "2", *both, "sides"),
                          "gloss_t3": ("bsdf2ttree", "-t3", "-g", "5", "-f", "formulas.cal", "gloss")}.items():
        (folder / f"{name}.xml").write_bytes(run(*command, cwd=folder))
    (folder / "tree_as_patches.xml").write_bytes(run("bsdf2klems", "gloss_t3.xml", cwd=folder))


def by_wrapbsdf(folder):
    """Joins matrices of random values: two bands, each with four parts."""
    generator = random.Random(1)
    arguments = []
    for band in ("Solar", "Visible"):
        arguments += ["-s", band]
        for part in ("tf", "tb", "rf", "rb"):
            name = f"{band}_{part}.dat"
            rows = (" ".join(f"{0.2 * generator.random():.6f}" for _ in range(PATCHES)) for _ in range(PATCHES))
            (folder / name).write_text("\n".join(rows) + "\n")
            arguments += [f"-{part}", name]
    (folder / "two_bands.xml").write_bytes(run("wrapBSDF", "-a", "kf", "-f", "n=random", *arguments, cwd=folder))


def make_files(folder):
    """Returns the ten files."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    pyradiance = programs()
    by_genbsdf(pyradiance, folder)
    by_formulas(folder)
    by_wrapbsdf(folder)
    return sorted(str(file) for file in folder.glob("*.xml"))


if __name__ == "__main__":
    print("\n".join(make_files(sys.argv[1])))
