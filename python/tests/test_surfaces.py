import json

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
    again = burnish.open_surface(str(folder / "wall.burnish"))
    assert all(numpy.array_equal(a, b) for a, b in zip(surface.weights, again.weights))
    assert again.notes == surface.notes
    assert 0 < again.albedo()["mean"] < 1


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
    with pytest.raises(burnish.Error, match="rows"):
        surface.eval(numpy.zeros((3, 2), numpy.float32), w, w)
    with pytest.raises(burnish.Error):
        burnish.open_surface("no_such_file")
