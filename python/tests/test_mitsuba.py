# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

import burnish
import export_pictures
from conftest import hemisphere

mi = pytest.importorskip("mitsuba")
dr = pytest.importorskip("drjit")


@pytest.fixture(scope="session")
def files(tmp_path_factory, model, lobes, volume):
    folder = tmp_path_factory.mktemp("models")
    models = {
        "model": model,
        "lobes": lobes,
        "volume": volume,
        "white": burnish.fit(burnish.open_source("lambert:kd=1")),
    }
    for name, one in models.items():
        burnish.write_model(folder / f"{name}.exr", one)
    return {name: str(folder / f"{name}.exr") for name in models}


def interaction(wo, count):
    si = dr.zeros(mi.SurfaceInteraction3f, count)
    si.wi = mi.Vector3f(*np.ascontiguousarray(wo.T))
    return si


@pytest.mark.parametrize("name", ["model", "lobes", "volume", "white"])
def test_eval_and_pdf_are_the_librarys(name, files, llvm):
    source = burnish.open_source(files[name])
    wi, wo = hemisphere(20_000, 1), hemisphere(20_000, 2)
    bsdf = mi.load_dict({"type": "burnish", "filename": files[name]})
    si = interaction(wo, len(wo))
    f, pdf = bsdf.eval_pdf(mi.BSDFContext(), si, mi.Vector3f(*np.ascontiguousarray(wi.T)))
    expected = source.eval(wi.astype(float), wo.astype(float)) * wi[:, 2:]
    np.testing.assert_allclose(np.array(f).T, expected, rtol=2e-5, atol=1e-5 * expected.mean())
    # rounding may put a direction on the far side of a cell's border
    ratio = np.array(pdf) / source.pdf(wi, wo)
    assert (abs(ratio - 1) < 1e-3).mean() > 0.995


def test_the_viewer_comes_first_as_in_measured_unless_told_otherwise(ggx, llvm, tmp_path):
    model = burnish.fit(ggx, model="a(theta_i) q(h)", samples=20_000)
    assert not model.reciprocal
    path = str(tmp_path / "model.exr")
    burnish.write_model(path, model)
    to_light, to_viewer = hemisphere(2_000, 1), hemisphere(2_000, 2)
    for settings, pair in (({}, (to_viewer, to_light)), ({"exchange": False}, (to_light, to_viewer))):
        bsdf = mi.load_dict({"type": "burnish", "filename": path, **settings})
        light = mi.Vector3f(*np.ascontiguousarray(to_light.T))
        value = bsdf.eval(mi.BSDFContext(), interaction(to_viewer, len(to_viewer)), light)
        expected = model.eval(*(w.astype(float) for w in pair)) * to_light[:, 2:]
        np.testing.assert_allclose(np.array(value).T, expected, rtol=2e-5, atol=1e-5 * expected.mean())


OPENPBR = (
    "openpbr:base_color=0.5/0.1/0.05,base_metalness=0.2,base_diffuse_roughness=0.4,specular_roughness_anisotropy=0.5,"
    "coat_weight=0.7,coat_roughness=0.1,fuzz_weight=0.3,thin_film_weight=0.4"
)


@pytest.fixture(scope="session", params=["spec", "file"])
def openpbr(request, cli, tmp_path_factory):
    """OpenPBR as a spec, and as what a fit writes."""
    if request.param == "spec":
        return OPENPBR
    path = str(tmp_path_factory.mktemp("openpbr") / "coated.json")
    cli("fit", "ggx:alpha_x=0.2,alpha_y=0.2,kd=0.05/0.1/0.2", "--to", "openpbr", "--alone", "-o", path)
    return path


def test_openpbr_is_the_librarys_and_sees_the_viewer(openpbr, llvm):
    source = burnish.open_source(openpbr)
    wi, wo = hemisphere(20_000, 1), hemisphere(20_000, 2)
    bsdf = mi.load_dict({"type": "burnish", "filename": openpbr})
    light = mi.Vector3f(*np.ascontiguousarray(wi.T))
    f, pdf = bsdf.eval_pdf(mi.BSDFContext(), interaction(wo, len(wo)), light)
    expected = source.eval(wi.astype(float), wo.astype(float)) * wi[:, 2:]
    error = abs(np.array(f).T / expected - 1).max(axis=1)
    assert np.median(error) < 1e-5 and (error < 1e-3).mean() >= 0.999
    assert (abs(np.array(pdf) / source.pdf(wi, wo) - 1) < 1e-3).mean() > 0.995
    turned = mi.load_dict({"type": "burnish", "filename": openpbr, "exchange": True})
    value = np.array(turned.eval(mi.BSDFContext(), interaction(wo, len(wo)), light)).T
    expected = source.eval(wo.astype(float), wi.astype(float)) * wi[:, 2:]
    assert np.median(abs(value / expected - 1)) < 1e-5


@pytest.mark.parametrize("name", ["openpbr", "model", "volume"])
def test_looks_as_in_our_renderer(name, files, cli, llvm, tmp_path):
    material, size = files.get(name, OPENPBR), 64
    expected = export_pictures.in_burnish(cli.program, material, size, tmp_path)
    found = export_pictures.in_mitsuba({"type": "burnish", "filename": material}, size, None)
    exposure = export_pictures.exposure_of(expected)
    distance = export_pictures.psnr(exposure * found, exposure * expected)
    print(f"\n{name} in Mitsuba: {distance:.2f} dB")
    assert distance >= 40


@pytest.mark.parametrize("name", ["model", "lobes", "volume"])
def test_draws_are_the_librarys(name, files, llvm):
    source = burnish.open_source(files[name])
    wo, u = hemisphere(20_000, 3), np.random.default_rng(4).random((20_000, 2)).astype(np.float32)
    bsdf = mi.load_dict({"type": "burnish", "filename": files[name]})
    drawn, weight = bsdf.sample(
        mi.BSDFContext(), interaction(wo, len(wo)), 0.5, mi.Point2f(*np.ascontiguousarray(u.T))
    )
    wi, pdf = source.sample_wi(wo, u)
    same = np.linalg.norm(np.array(drawn.wo).T - wi, axis=1) < 1e-3
    assert same.mean() > 0.99
    assert (abs(np.array(drawn.pdf)[same] / pdf[same] - 1) < 1e-2).mean() > 0.99
    value = bsdf.eval(mi.BSDFContext(), interaction(wo, len(wo)), drawn.wo)
    expected = np.array(value) / np.maximum(np.array(drawn.pdf), 1e-20)
    np.testing.assert_allclose(np.array(weight)[:, same], expected[:, same], rtol=1e-4, atol=1e-6)


@pytest.mark.parametrize("name", ["model", "lobes"])
@pytest.mark.parametrize("theta", [0, 40, 80])
def test_draws_pass_mitsubas_chi_square_test(name, theta, files, llvm):
    import mitsuba.chi2

    angle = np.radians(theta)
    wi = [float(np.sin(angle)) * 0.6, float(np.sin(angle)) * 0.8, float(np.cos(angle))]
    sample, pdf = mitsuba.chi2.BSDFAdapter("burnish", {"type": "burnish", "filename": files[name]}, wi=wi)
    test = mitsuba.chi2.ChiSquareTest(
        domain=mitsuba.chi2.SphericalDomain(),
        sample_func=sample,
        pdf_func=pdf,
        sample_dim=3,
        sample_count=200_000,
        res=101,
        ires=40,  # steep lobes: the test's own integration has to be as fine
    )
    assert test.run(significance_level=0.01), test.messages


def render(mi, bsdf, integrator=None, spp=256, emitter=None, size=33):
    scene = mi.load_dict(
        {
            "type": "scene",
            "integrator": integrator or {"type": "path", "max_depth": 2},
            "sensor": {
                "type": "orthographic",
                "to_world": mi.ScalarTransform4f().look_at([0, 0, 5], [0, 0, 0], [0, 1, 0]),
                "film": {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"}},
            },
            "emitter": emitter or {"type": "constant"},
            "shape": {"type": "sphere", "bsdf": bsdf},
        }
    )
    return scene, np.array(mi.render(scene, spp=spp))


def test_a_white_sphere_vanishes_in_a_white_furnace(files, llvm):
    image = render(mi, {"type": "burnish", "filename": files["white"]})[1]
    # grazing directions beyond the fit's data may be off
    np.testing.assert_allclose(image.mean(axis=2), 1, atol=0.1)
    assert abs(image.mean() - 1) < 5e-3


def test_a_furnace_shows_the_albedo(files, model, llvm):
    size = 33
    image = render(mi, {"type": "burnish", "filename": files["model"]}, spp=1024, size=size)[1]
    for pixel in (16, 20, 26):
        x = (2 * pixel + 1 - size) / size
        wo = np.array([x, 0, np.sqrt(1 - x * x)])
        expected = burnish.directional_albedo(model, wo)
        np.testing.assert_allclose(image[16, pixel], expected, rtol=0.03)


def test_tables_are_recovered_from_a_picture(files, llvm):
    light = {"type": "directional", "direction": [-0.4, -0.3, -1]}
    settings = dict(integrator={"type": "direct"}, emitter=light, spp=4)
    target = mi.TensorXf(render(mi, {"type": "burnish", "filename": files["model"]}, **settings)[1])
    scene, _ = render(mi, {"type": "burnish", "filename": files["model"]}, **settings)
    parameters = mi.traverse(scene)
    key = next(k for k in parameters.keys() if k.endswith("q.log_values"))
    optimizer = mi.ad.Adam(lr=0.1)
    optimizer[key] = mi.TensorXf(np.zeros(parameters[key].shape, np.float32) - 1)
    losses = []
    for _ in range(40):
        parameters.update(optimizer)
        image = mi.render(scene, parameters, spp=4)
        loss = dr.mean(dr.square(dr.log(1 + image) - dr.log(1 + target)), axis=None)
        dr.backward(loss)
        optimizer.step()
        losses.append(float(loss.array[0]))
    assert losses[-1] < 0.02 * losses[0], losses


def test_what_is_no_model_is_refused(llvm, tmp_path):
    path = tmp_path / "table.binary"
    burnish.convert(burnish.open_source("lambert"), path, "merl", cells=8)
    with pytest.raises(Exception, match="expected a burnish model"):
        mi.load_dict({"type": "burnish", "filename": str(path)})


@pytest.mark.parametrize("name", ["model", "volume"])
def test_scalar_variants_call_the_library(name, files):
    before = mi.variant()
    mi.set_variant("scalar_rgb")
    try:
        import burnish.mitsuba

        burnish.mitsuba.register()
        source = burnish.open_source(files[name])
        bsdf = mi.load_dict({"type": "burnish", "filename": files[name]})
        si = mi.SurfaceInteraction3f()
        si.wi = [0.6, 0, 0.8]
        wi = np.array([0, 0.6, 0.8])
        f, pdf = bsdf.eval_pdf(mi.BSDFContext(), si, mi.Vector3f(wi))
        np.testing.assert_allclose(f, 0.8 * source.eval(wi, np.array([0.6, 0, 0.8])), rtol=2e-5)
        drawn, weight = bsdf.sample(mi.BSDFContext(), si, 0.5, [0.3, 0.6])
        assert drawn.pdf > 0 and np.all(np.array(weight) > 0)
        assert bsdf.pdf(mi.BSDFContext(), si, drawn.wo) == pytest.approx(drawn.pdf, rel=1e-3)
        image = render(mi, {"type": "burnish", "filename": files["white"]}, spp=64, size=9)[1]
        assert abs(image.mean() - 1) < 0.02
    finally:
        if before:
            mi.set_variant(before)


def test_mitsubas_measured_reads_exported_tables(cli, files, llvm, tmp_path):
    cli("export", files["model"], "--to", "rgl", "-o", tmp_path, "--name", "m")
    bsdf = mi.load_dict({"type": "measured", "filename": str(tmp_path / "m.bsdf")})
    wi, wo = hemisphere(5_000, 5), hemisphere(5_000, 6)
    wi, wo = wi[keep := (wi[:, 2] > 0.2) & (wo[:, 2] > 0.2)], wo[keep]
    # the first direction of the file, our wi, is Mitsuba's si.wi
    value = np.array(bsdf.eval(mi.BSDFContext(), interaction(wi, len(wi)), mi.Vector3f(*np.ascontiguousarray(wo.T)))).T
    expected = burnish.open_source(str(tmp_path / "m.bsdf")).eval(wi, wo) * wo[:, 2:]
    assert np.median(abs(value / expected - 1)) < 1e-3
    assert (abs(value - expected) < 2e-2 * expected + 1e-3).mean() > 0.99


def test_rgl_files_are_what_mitsubas_measured_says(rgl_files, llvm):
    # Mitsuba's si.wi is the file's first direction, our wi; its values have the cosine of the second and keep
    # their sign, as ours do with clamp_negatives=False. It computes in single precision: where f falls to zero
    # beside the horizon its last digits are rounding, which the floor of 1e-3/sr leaves out.
    count, most, floor = 100_000, 1e-4, 1e-3
    wi, wo = (w.astype(np.float32) for w in burnish.draw_pairs(count, seed=11))
    print(f"\nmeasured: {count} pairs of every file that differ by at most {most:g}, and the median difference")
    for path in rgl_files:
        bsdf = mi.load_dict({"type": "measured", "filename": str(path)})
        value = bsdf.eval(mi.BSDFContext(), interaction(wi, count), mi.Vector3f(*np.ascontiguousarray(wo.T)))
        expected = np.array(value).T.astype(float) / wo[:, 2:]
        raw = burnish.open_source(path, clamp_negatives=False).eval(wi.astype(float), wo.astype(float))
        cut = burnish.open_source(path).eval(wi.astype(float), wo.astype(float))
        error, size = abs(raw - expected).max(axis=1), abs(expected).max(axis=1)
        relative = error / np.maximum(size, 1e-30)
        near, strict = (error <= most * (size + floor)).mean(), (relative <= most).mean()
        print(
            f"{path.stem:32} {100 * near:8.3f} % beside {floor:g}/sr {100 * strict:8.3f} % of all"
            f" {np.median(relative):9.1e}, {100 * (expected < 0).mean():5.2f} % of the values below zero"
        )
        assert near >= 0.999 and strict >= 0.99, path
        # the results are cut, not the nodes
        np.testing.assert_array_equal(cut, np.maximum(raw, 0))


def lit_spheres(bsdf):
    """The pictures of docs/notation.md: lights at 0, 30 and 60 degrees from the view."""
    angles = np.radians([0, 30, 60])
    lights = [{"type": "directional", "direction": [-float(np.sin(a)), 0, -float(np.cos(a))]} for a in angles]
    settings = dict(integrator={"type": "direct"}, spp=16, size=128)
    return np.array([render(mi, bsdf, emitter=light, **settings)[1] for light in lights])


@pytest.mark.parametrize("budget, least", [(2_700, 37), (16_384, 40)])
def test_a_model_as_measured_looks_like_mitsubas_measured(budget, least, cli, rgl_files, llvm, tmp_path):
    file = next((str(path) for path in rgl_files if path.stem == "vch_silk_blue_rgb"), None)
    if not file:
        pytest.skip("vch_silk_blue_rgb.bsdf is not there")
    reference = lit_spheres({"type": "measured", "filename": file})
    exposure = 1 / np.percentile(reference, 97)
    shown = lambda image: np.clip(exposure * image, 0, 1) ** (1 / 2.2)
    psnr = {}
    for name, options in (("made reciprocal", []), ("as measured", ["--no-symmetrize"])):
        path = str(tmp_path / "model.exr")
        cli("fit", file, "--target", "function", "--budget", budget, "-o", path, *options)
        size = burnish.open_source(path).bytes
        assert size <= budget
        image = lit_spheres({"type": "burnish", "filename": path})
        psnr[name] = -10 * np.log10(np.mean(np.square(shown(image) - shown(reference))))
        print(f"\n{name}: {psnr[name]:.2f} dB with {size} bytes")
    assert psnr["as measured"] >= least
    # a reciprocal model cannot follow what is not
    assert psnr["made reciprocal"] < psnr["as measured"] - 4
