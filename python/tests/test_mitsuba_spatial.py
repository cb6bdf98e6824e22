# SPDX-License-Identifier: Apache-2.0
"""The plugin `burnish_spatial` against the library."""

import json
import subprocess
import sys

import numpy
import pytest

import burnish

mi = pytest.importorskip("mitsuba")

SCENE = {
    "version": 1,
    "width": 16,
    "height": 16,
    "materials": ["ggx:alpha_x=0.3,alpha_y=0.3,kd=0.2", "ggx:alpha_x=0.6,alpha_y=0.6,kd=0.5"],
    "shares": {"cells": 3, "seed": 2},
    "heights": {"cells": 3, "seed": 5, "amplitude": 0.01},
    "lights": {"count": 12, "angle_deg": 60},
    "views": {"count": 2, "angle_deg": 40},
}


@pytest.fixture(scope="module")
def wall(cli, tmp_path_factory):
    try:
        mi.set_variant("llvm_ad_rgb")
        mi.Float(1) + mi.Float([2, 3])
    except Exception as error:  # Dr.Jit loads libLLVM when it is first needed
        pytest.skip(f"llvm_ad_rgb is not available: {error}")
    folder = tmp_path_factory.mktemp("wall")
    (folder / "scene.json").write_text(json.dumps(SCENE))
    cli("measure", "--surface", folder / "scene.json", "-o", folder / "capture")
    surface, _ = burnish.fit_surface(folder / "capture", lobes=2, lobe_bytes=1024, rounds=1)
    surface.write(folder / "wall.burnish")
    from burnish import mitsuba as plugin

    plugin.register()
    path = str(folder / "wall.burnish")
    return surface, mi.load_dict({"type": "burnish_spatial", "filename": path}), path


def directions(count, seed):
    w = numpy.random.default_rng(seed).normal(size=(count, 3))
    w[:, 2] = abs(w[:, 2]) + 1
    return (w / numpy.linalg.norm(w, axis=1, keepdims=True)).astype(numpy.float32)


def interaction(uv, wi):
    si = mi.SurfaceInteraction3f()
    si.uv = mi.Point2f(uv[:, 0], 1 - uv[:, 1])
    si.wi = mi.Vector3f(wi[:, 0], wi[:, 1], wi[:, 2])
    return si


def test_evaluates_as_the_library(wall):
    surface, bsdf, _ = wall
    light, viewer = directions(400, 2), directions(400, 3)
    for x, y in ((8, 4), (0, 15), (13, 9)):
        texel = numpy.array([[(x + 0.5) / 16, (y + 0.5) / 16]], numpy.float32)
        nx, ny = surface.normals[y, x]
        n = numpy.array([nx, ny, numpy.sqrt(1 - nx**2 - ny**2)])
        si = interaction(numpy.repeat(texel, 400, axis=0), viewer)
        found = numpy.array(bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(*light.T))).T
        expected = surface.eval(texel, light, viewer) * (light @ n)[:, None]
        assert numpy.allclose(found, expected, rtol=5e-3, atol=1e-5)


def test_draws_what_its_density_says(wall):
    _, bsdf, _ = wall
    count = 20000
    uv = numpy.full((count, 2), 0.4, numpy.float32)
    si = interaction(uv, numpy.repeat(directions(1, 4), count, axis=0))
    u = numpy.random.default_rng(5).random((count, 2)).astype(numpy.float32)
    drawn, weight = bsdf.sample(mi.BSDFContext(), si, mi.Float(u[:, 0]), mi.Point2f(*u.T))
    value, pdf = bsdf.eval_pdf(mi.BSDFContext(), si, drawn.wo)
    kept = numpy.array(drawn.wo.z) > 0
    assert numpy.allclose(numpy.array(drawn.pdf)[kept], numpy.array(pdf)[kept], rtol=1e-2, atol=1e-4)
    # the same light as by directions that are even over the hemisphere
    z, phi = u[:, 0], 2 * numpy.pi * u[:, 1]
    even = numpy.stack([numpy.sqrt(1 - z**2) * numpy.cos(phi), numpy.sqrt(1 - z**2) * numpy.sin(phi), z])
    flat = 2 * numpy.pi * numpy.array(bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(*even))).mean(axis=1)
    assert numpy.allclose(numpy.array(weight).mean(axis=1), flat, rtol=0.1)


def test_nothing_leaks_when_the_process_ends(wall):
    program = f"""
import mitsuba as mi
mi.set_variant("llvm_ad_rgb")
import burnish.mitsuba
burnish.mitsuba.register()
bsdf = mi.load_dict({{"type": "burnish_spatial", "filename": {wall[2]!r}}})
si = mi.SurfaceInteraction3f()
si.uv, si.wi = mi.Point2f(0.5, 0.5), mi.Vector3f(0, 0, 1)
print(bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(0, 0.6, 0.8)))
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 0 and "leak" not in done.stderr, done.stderr
