# SPDX-License-Identifier: Apache-2.0
import json
import os
import signal
import threading

import numpy
import pytest

import burnish

SCENE = {
    "version": 1,
    "width": 24,
    "height": 24,
    "materials": ["ggx:alpha_x=0.3,alpha_y=0.3,kd=0.2", "ggx:alpha_x=0.6,alpha_y=0.6,kd=0.5"],
    "shares": {"cells": 3, "seed": 2},
    "heights": {"cells": 3, "seed": 5, "amplitude": 0.01},
    "lights": {"count": 12, "angle_deg": 60},
    "views": {"count": 2, "angle_deg": 40},
    "held_out": 6,
}


@pytest.fixture(scope="module")
def fitted(cli, tmp_path_factory):
    folder = tmp_path_factory.mktemp("surface")
    (folder / "scene.json").write_text(json.dumps(SCENE))
    cli("measure", "--surface", folder / "scene.json", "-o", folder / "capture")
    surface, report = burnish.fit_surface(folder / "capture", lobes=2, lobe_bytes=1024, rounds=2)
    return folder, surface, report


def directions(count, seed):
    w = numpy.random.default_rng(seed).normal(size=(count, 3))
    w[:, 2] = abs(w[:, 2]) + 1
    return (w / numpy.linalg.norm(w, axis=1, keepdims=True)).astype(numpy.float32)


def test_fits_to_the_end_or_not_at_all(fitted, tmp_path):
    folder, surface, _ = fitted
    again, _ = burnish.fit_surface(
        folder / "capture", lobes=2, lobe_bytes=1024, rounds=2, checkpoint=tmp_path / "wall.part"
    )
    assert again.notes == surface.notes
    assert not (tmp_path / "wall.part").exists()
    for rounds in 0, -5:
        with pytest.raises(burnish.Error, match=f"1 to 100 rounds, found {rounds}"):
            burnish.fit_surface(folder / "capture", rounds=rounds)


def test_fits_and_reads_its_file(fitted):
    folder, surface, report = fitted
    assert report["held_out"]["psnr"] > 30
    assert (surface.width, surface.height, surface.channels, len(surface.weights)) == (24, 24, 3, 2)
    surface.write(folder / "wall.burnish")
    again = burnish.open_surface(folder / "wall.burnish")
    assert all(numpy.array_equal(a, b) for a, b in zip(surface.weights, again.weights))
    assert again.notes == surface.notes
    assert 0 < again.albedo()["mean"] < 1


def test_progress_rises_and_its_exceptions_end_the_fit(fitted):
    folder, surface, _ = fitted
    how = {"lobes": 2, "lobe_bytes": 1024, "rounds": 2}
    seen = []
    again, _ = burnish.fit_surface(
        folder / "capture", **how, memory=1 << 14, progress=lambda stage, fraction: seen.append((stage, fraction))
    )
    assert all(numpy.array_equal(a, b) for a, b in zip(surface.weights, again.weights))
    assert {"fitting lobes", "fitting weights"} <= {stage for stage, _ in seen}
    weights = [fraction for stage, fraction in seen if stage == "fitting weights"]
    assert len(weights) > 2 and weights == sorted(weights)  # a tile at a time

    def stop(stage, fraction):
        raise LookupError(stage)

    with pytest.raises(LookupError, match="reading pictures"):
        burnish.fit_surface(folder / "capture", **how, progress=stop)


def test_ctrl_c_ends_a_fit(fitted):
    folder, _, _ = fitted
    signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored where a shell runs this in the background
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    seen = []
    with pytest.raises(KeyboardInterrupt):
        burnish.fit_surface(folder / "capture", lobes=6, rounds=100, progress=lambda *step: seen.append(step))
    timer.join()
    assert all(stage != "fitting weights" for stage, _ in seen)


def test_is_the_weighted_sum_of_its_lobes(fitted):
    _, surface, _ = fitted
    wi, wo = directions(50, 1), directions(50, 2)
    uv = numpy.array([[(5 + 0.5) / 24, (7 + 0.5) / 24]], numpy.float32)
    nx, ny = surface.normals[7, 5]
    n = numpy.array([nx, ny, numpy.sqrt(1 - nx**2 - ny**2)])
    t = numpy.array([1, 0, 0]) - nx * n
    t /= numpy.linalg.norm(t)
    frame = numpy.stack([t, numpy.cross(n, t), n])
    place = surface.at(*uv[0])
    expected = place.eval((wi @ frame.T).astype(numpy.float32), (wo @ frame.T).astype(numpy.float32))
    assert numpy.allclose(surface.eval(uv, wi, wo), expected, rtol=1e-3, atol=1e-6)


def test_evaluates_arrays_as_a_model_does(fitted):
    _, surface, _ = fitted
    wi, wo = directions(40, 4), directions(40, 5)
    uv = numpy.random.default_rng(6).random((40, 2)).astype(numpy.float32)
    f = surface.eval(uv, wi, wo, 0.5)
    assert f.dtype == numpy.float32 and f.shape == (40, 3)
    # float64 is the definition, and no float32 in between
    exact = surface.eval(*(a.astype(numpy.float64) for a in (uv, wi, wo)), lod=0.5)
    assert exact.dtype == numpy.float64 and numpy.allclose(f, exact, rtol=1e-4)
    assert not numpy.array_equal(exact, exact.astype(numpy.float32))
    assert numpy.allclose(surface.eval(uv, wi, wo, 0.5), surface.eval(uv, wo, wi, 0.5), rtol=1e-5)
    # any strides
    strided = (numpy.asfortranarray(uv), numpy.asfortranarray(wi), numpy.repeat(wo, 2, axis=0)[::2])
    numpy.testing.assert_array_equal(surface.eval(*strided, 0.5), f)
    # one row for all of the others
    for one in ((uv[3], wi, wo), (uv, wi[3], wo), (uv[3:4], wi[3], wo), (uv, wi[3], wo[3:4])):
        every = [numpy.broadcast_to(a, (40, a.shape[-1])) for a in one]
        numpy.testing.assert_array_equal(surface.eval(*one, 0.5), surface.eval(*every, 0.5))
    assert surface.eval(uv[0], wi[0], wo[0]).shape == (3,)
    assert surface.eval(uv[:0], wi[:0], wo[:0]).shape == (0, 3)
    # into what is given
    for order in "CF":
        out = numpy.empty((40, 3), numpy.float32, order)
        assert surface.eval(uv, wi, wo, 0.5, out=out) is out
        numpy.testing.assert_array_equal(out, f)
    wrong = wi.copy()
    wrong[7] *= 2
    assert numpy.isnan(surface.eval(uv, wrong, wo)).all(axis=1).nonzero()[0].tolist() == [7]
    nowhere = uv.copy()
    nowhere[5, 1] = numpy.nan
    assert numpy.isnan(surface.eval(nowhere, wi, wo)).all(axis=1).nonzero()[0].tolist() == [5]
    with pytest.raises(burnish.Error, match="expected finite u and v, found nan and 0"):
        surface.at(numpy.nan, 0)


def test_takes_places_and_directions_of_any_type(fitted):
    _, surface, _ = fitted
    w, uv = directions(4, 7), numpy.tile(numpy.array([0.5, 0.25], numpy.float32), (4, 1))
    wide = [array.astype(numpy.float64) for array in (uv, w, w)]
    expected = surface.eval(*wide)
    for given in ((uv, wide[1], w), (uv.tolist(), wide[1].tolist(), w.tolist())):
        found = surface.eval(*given)
        assert found.dtype == numpy.float64
        numpy.testing.assert_array_equal(found, expected)
    assert surface.eval(uv.tolist(), w, w).dtype == numpy.float32
    corner = numpy.zeros((4, 2), int)
    numpy.testing.assert_array_equal(surface.eval(corner, w, w), surface.eval(corner.astype(numpy.float64), w, w))
    for wrong in (uv.astype(complex), uv > 0, "uv"):
        with pytest.raises(TypeError, match="uv: expected an array of real numbers"):
            surface.eval(wrong, w, w)


def test_refuses_an_out_that_does_not_fit(fitted):
    _, surface, _ = fitted
    w, uv = directions(4, 7), numpy.full((4, 2), 0.5, numpy.float32)
    with pytest.raises(TypeError):
        surface.eval(uv, w, w, out=numpy.empty((4, 3), int))
    with pytest.raises(burnish.Error, match=r"out: expected shape \(4, 3\), found \(3, 3\)"):
        surface.eval(uv, w, w, out=numpy.empty((3, 3), numpy.float32))


def test_exports_shaders_and_maps(fitted):
    _, surface, _ = fitted
    files = surface.export(["glsl", "png", "gltf"], name="wall")
    assert b"burnish_wall_at(" in files["wall.glsl"] and "wall_map0.ktx2" in files
    assert files["wall_weight0.png"][:4] == b"\x89PNG"
    assert files["wall.glb"][:4] == b"glTF"
    with pytest.raises(burnish.Error, match="surface"):
        surface.export(["materialx"])


def test_says_what_is_wrong(fitted):
    _, surface, _ = fitted
    w = directions(4, 3)
    with pytest.raises(burnish.Error, match="uv, wi and wo: expected equal counts, found 3, 4 and 4"):
        surface.eval(numpy.zeros((3, 2), numpy.float32), w, w)
    with pytest.raises(burnish.Error):
        burnish.open_surface("no_such_file")
