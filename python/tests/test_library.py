# SPDX-License-Identifier: Apache-2.0
import gc
import json
import os
import re
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import burnish
from conftest import BRUSHED, GGX


def test_fit_is_the_command_lines_fit(cli, tmp_path):
    printed = cli("fit", GGX, "-o", tmp_path / "cli.exr", "--model", "pqpr", "--table", "q=48", "--json")
    model = burnish.fit(burnish.open_source(GGX), model="pqpr", tables=["q=48"])
    for key in ("relative", "psnr", "samples", "smooth", "iterations"):
        assert model.notes[key] == printed[key]
    assert model.bytes == printed["bytes"] and model.expression == printed["model"]
    burnish.write_model(tmp_path / "python.exr", model)
    assert (tmp_path / "python.exr").read_bytes() == (tmp_path / "cli.exr").read_bytes()


@pytest.mark.parametrize("method", ["svd", "analytic:ggx"])
def test_baselines_are_the_command_lines(method, cli, ggx, tmp_path):
    how = ["--method", method, "--budget", 1000, "--count", 20_000]
    printed = cli("fit", GGX, "-o", tmp_path / "cli.json", *how, "--json")
    baseline = burnish.fit(ggx, method=method, budget=1000, samples=20_000)
    assert isinstance(baseline, burnish.Baseline) and not isinstance(baseline, burnish.Model)
    assert baseline.kind == ("svd" if method == "svd" else "analytic")
    assert baseline.bytes == printed["bytes"] <= 1000 and baseline.expression == printed["model"]
    assert baseline.notes["psnr"] == printed["psnr"]
    burnish.write_model(tmp_path / "python.json", baseline)
    again = burnish.open_source(tmp_path / "python.json")
    wi, wo = burnish.draw_pairs(50)
    np.testing.assert_array_equal(again.eval(wi, wo), baseline.eval(wi, wo))
    assert json.loads((tmp_path / "python.json").read_text()) == json.loads((tmp_path / "cli.json").read_text())


def test_baselines_take_no_options_of_factored_models(ggx):
    with pytest.raises(burnish.Error, match="'pca'"):
        burnish.fit(ggx, method="pca")
    with pytest.raises(burnish.Error, match="^method excludes model$"):
        burnish.fit(ggx, method="svd", model="pqp")


# What Python, the page's package and the command line are asked, and what each says, options spelled as they are there.
WRONG = [
    ({"model": "pqp", "budget": 2700}, ["--model", "pqp", "--budget", 2700], "budget excludes model"),
    ({"fetches": 2}, ["--fetches", 2], "fetches requires budget"),
    ({"lobes": 3, "search": True}, ["--lobes", 3, "--search"], "lobes requires budget"),
    ({"search": True}, ["--search"], "search requires budget"),
    ({"tables": ["q=96"], "budget": 2700}, ["--table", "q=96", "--budget", 2700], "budget excludes tables"),
    (
        {"budget": 2700, "fetches": 2, "lobes": 3},
        ["--budget", 2700, "--fetches", 2, "--lobes", 3],
        "fetches excludes lobes",
    ),
    (
        {"budget": "16K", "fetches": 2, "search": True},
        ["--budget", "16K", "--fetches", 2, "--search"],
        "fetches excludes search",
    ),
    ({"method": "svd", "model": "pqp"}, ["--method", "svd", "--model", "pqp"], "method excludes model"),
    ({"method": "svd", "format": "half"}, ["--method", "svd", "--format", "half"], "method excludes format"),
    ({"method": "svd", "loss": "relative"}, ["--method", "svd", "--loss", "relative"], "method excludes loss"),
    ({"method": "nd", "smooth": "auto"}, ["--method", "nd", "--smooth", "auto"], "method excludes smooth"),
    (
        {"method": "nd", "conserve_energy": True},
        ["--method", "nd", "--conserve-energy"],
        "method excludes conserve_energy",
    ),
    (
        {"method": "svd", "budget": "auto"},
        ["--method", "svd", "--budget", "auto"],
        "budget: expected a number of bytes with method, found 'auto'",
    ),
    (
        {"target": "function", "hold_out": "half=1"},
        ["--target", "function", "--hold-out", "half=1"],
        "target: expected nodes with hold_out, found 'function'",
    ),
    (
        {"budget": 0},
        ["--budget", 0],
        "budget: expected auto or a number of bytes from 1 to 67108864, as 2700, 16K or 1M, found '0'",
    ),
    (
        {"budget": "much"},
        ["--budget", "much"],
        "budget: expected auto or a number of bytes from 1 to 67108864, as 2700, 16K or 1M, found 'much'",
    ),
    (
        {"budget": 2700, "fetches": 0},
        ["--budget", 2700, "--fetches", 0],
        "fetches: expected a whole number from 1 to 256, found '0'",
    ),
    (
        {"budget": 2700, "lobes": 1.5},
        ["--budget", 2700, "--lobes", 1.5],
        "lobes: expected a whole number from 1 to 64, found '1.5'",
    ),
    (
        {"loss": "realtive"},
        ["--loss", "realtive"],
        "loss: expected one of image, relative, log_cos, found 'realtive'; did you mean 'relative'?",
    ),
    ({"target": "cells"}, ["--target", "cells"], "target: expected one of function, nodes, found 'cells'"),
    (
        {"hold_out": "half=2"},
        ["--hold-out", "half=2"],
        "hold_out: expected half=0, half=1 or theta_i=K, found 'half=2'",
    ),
    ({"smooth": "much"}, ["--smooth", "much"], "smooth: expected auto or a number of at least 0, found 'much'"),
    ({"floor": 2}, ["--floor", 2], "floor: expected a number above 0 and at most 1, found '2'"),
    ({"seed": -1}, ["--seed", -1], "seed: expected a whole number of at least 0, found '-1'"),
]


@pytest.mark.parametrize("keywords, words, said", WRONG)
def test_wrong_options_are_told_alike(keywords, words, said, cli, ggx, tmp_path):
    with pytest.raises(burnish.Error) as told:
        burnish.fit(ggx, **keywords)
    assert str(told.value) == said
    with pytest.raises(burnish.Error) as told:
        burnish.batch([GGX], tmp_path / "out", **keywords)
    assert str(told.value) == said and not (tmp_path / "out").exists()

    command = [cli.program, "fit", GGX, "-o", str(tmp_path / "model.json"), *map(str, words)]
    run = subprocess.run(command, capture_output=True, text=True)
    first = run.stderr.splitlines()[0].replace("--table", "tables")
    first = re.sub("--([a-z-]+)", lambda word: word[1].replace("-", "_"), first)
    assert (run.returncode, first) == (2, "burnish: " + said)


def test_numbers_of_numpy_and_texts_serve_as_options(ggx):
    how = {"seed": np.int64(3), "smooth": np.float32(0.25), "tables": ("q=9",)}
    model = burnish.fit(ggx, model="pqp", samples=np.uint16(2000), floor=np.float64(1e-4), **how)
    assert model.notes["floor"] == 1e-4 and model.notes["smooth"] == 0.25
    assert burnish.fit(ggx, budget="0.5K", lobes=1).notes["budget"] == 512
    with pytest.raises(TypeError, match="model: expected None, a bool, a number, a string or a list, found"):
        burnish.fit(ggx, model=object())
    with pytest.raises(burnish.Error, match="found 'bugdet'; did you mean 'budget'"):
        burnish.fit(ggx, bugdet=2700)


def test_a_budget_is_kept_and_spent(ggx):
    model = burnish.fit(ggx, budget=1200, lobes=2)
    assert 900 < model.bytes <= 1200 and len(model.lobes) == 2
    assert model.notes["budget"] == 1200


def test_compare_and_info_print_the_same(cli, ggx, model, tmp_path):
    path = tmp_path / "model.exr"
    burnish.write_model(path, model)
    again = burnish.open_source(path)
    assert burnish.compare_models(ggx, [again], count=5000) == cli(
        "compare", GGX, path, "--count", "5000", "--json"
    )
    printed = cli("info", path, "--json")
    assert printed.pop("shader") == burnish.generate_shader(again).cost
    assert again.info() == printed
    figures = burnish.error_figures(ggx, again, count=5000)
    compared = burnish.compare_models(ggx, [again], count=5000)[0]
    for key in ("psnr", "ssim", "relative", "rms_log", "log_cos"):
        assert getattr(figures, key) == compared[key]


def test_compare_of_samples_has_nodes_and_the_expected_error(cli, ggx, model, tmp_path):
    samples = tmp_path / "samples.csv"
    burnish.convert(ggx, samples, "csv", count=400)
    burnish.write_model(tmp_path / "model.exr", model)
    rows = burnish.compare_models(
        burnish.open_source(samples), [burnish.open_source(tmp_path / "model.exr")], count=2000
    )
    assert rows == cli("compare", samples, tmp_path / "model.exr", "--count", "2000", "--json")
    assert rows[0]["nodes"]["count"] > 0 and rows[0]["expected"]["relative"] > 0


def test_a_report_is_written(ggx, model, tmp_path):
    burnish.compare_models(ggx, [model], count=1000, report=str(tmp_path / "report"))
    page = (tmp_path / "report/index.html").read_text()
    for table in model.tables:
        name = f"factors/model_1_{table.name}.png"
        assert (tmp_path / "report" / name).exists() and name in page


def test_errors_are_exceptions_with_the_same_text(cli, tmp_path):
    (tmp_path / "bad.binary").write_bytes(b"nothing that is known")
    for spec in (tmp_path / "bad.binary", tmp_path / "missing.exr", "ggx:alpha_x=-1"):
        with pytest.raises(RuntimeError) as told:
            cli("info", spec)
        with pytest.raises(burnish.Error) as raised:
            burnish.open_source(spec)
        assert f"burnish: {raised.value}" == str(told.value)
    # cut in the same place, and one line
    (tmp_path / "long.json").write_text('{"' + "x" * 7000)
    for spec in (tmp_path / "long.json", "openpbr:base=1", "ggx:" + "x" * 7000 + "\n=1"):
        with pytest.raises(RuntimeError) as told:
            cli("info", spec)
        with pytest.raises(burnish.Error) as raised:
            burnish.open_source(spec)
        assert f"burnish: {raised.value}" == str(told.value)
        assert len(str(raised.value)) < 290 and "\n" not in str(raised.value)
    assert issubclass(burnish.Error, ValueError)
    with pytest.raises(burnish.Error, match="loss: expected one of image, relative, log_cos, found 'psnr'"):
        burnish.fit(burnish.open_source(GGX), loss="psnr")


@pytest.mark.parametrize("format", ["merl", "rgl", "csv"])
def test_converted_files_are_the_command_lines(format, cli, ggx, tmp_path):
    losses = burnish.convert(ggx, tmp_path / "python", format, count=2000)
    cli("convert", GGX, tmp_path / "cli", "--to", format, *(["--count", 2000] if format == "csv" else []))
    assert (tmp_path / "python").read_bytes() == (tmp_path / "cli").read_bytes()
    assert losses and burnish.open_source(tmp_path / "python").isotropic


@pytest.mark.parametrize("language, extension", [("glsl", "glsl"), ("wgsl", "wgsl"), ("cpp", "h")])
def test_shaders_and_textures_are_the_command_lines(language, extension, cli, model, tmp_path):
    burnish.write_model(tmp_path / "model.exr", model)
    cli("export", tmp_path / "model.exr", "--to", language, "--to", "ktx2", "-o", tmp_path / "out")
    shader = burnish.generate_shader(model, language, name="model")
    assert shader.text == (tmp_path / "out" / f"model.{extension}").read_text()
    manifest = json.loads((tmp_path / "out/model.json").read_text())
    assert shader.cost == manifest["shaders"][0]["cost"]
    if language == "cpp":  # has its tables inside, in arrays of their own sizes
        return
    for texture, entry in zip(shader.textures, manifest["textures"], strict=True):
        assert texture.values.shape == (entry["height"], entry["width"], entry["channels"])
        for placed in texture.tables:
            table = model.tables[placed.table].values
            x, y, _ = placed.first
            there = texture.values[y : y + table.shape[0], x : x + table.shape[1]]
            np.testing.assert_array_equal(there, table * 2.0**placed.exponent)
        burnish.write_ktx2(tmp_path / "texture.ktx2", texture)
        assert (tmp_path / "texture.ktx2").read_bytes() == (tmp_path / "out" / entry["file"]).read_bytes()


@pytest.mark.parametrize("language, ending", [("glsl_es", "es.glsl"), ("hlsl", "hlsl"), ("wgsl", "wgsl")])
def test_half_products_are_the_command_lines(language, ending, cli, model, tmp_path):
    burnish.write_model(tmp_path / "model.exr", model)
    cli("export", tmp_path / "model.exr", "--to", language, "--half", "-o", tmp_path / "out")
    expected = (tmp_path / "out" / f"model.{ending}").read_text()
    assert burnish.generate_shader(model, language, half=True, name="model").text == expected
    assert burnish.export(model, language, half=True, name="model")[f"model.{ending}"].decode() == expected
    assert burnish.generate_shader(model, language, name="model").text != expected
    for asked in ({"exact": True}, {"language": "cpp"}):
        with pytest.raises(burnish.Error, match="expected the hardware filter with half products, found exact"):
            burnish.generate_shader(model, **{"language": language, "half": True} | asked)


def test_exports_are_the_command_lines(cli, model, tmp_path):
    burnish.write_model(tmp_path / "model.exr", model)
    options = [word for to in ("three", "babylon", "materialx", "glsl", "html") for word in ("--to", to)]
    cli("export", tmp_path / "model.exr", *options, "--environment", "sun", "-o", tmp_path / "cli")
    files = burnish.export(
        model,
        ["three", "babylon", "materialx", "glsl", "html"],
        tmp_path / "python",
        name="model",
        environment="sun",
    )
    assert list(files)[-1] == "model.json"
    for name, content in files.items():
        assert (tmp_path / "cli" / name).read_bytes() == content == (tmp_path / "python" / name).read_bytes()
    assert len(files) == len(list((tmp_path / "cli").iterdir()))
    assert list(burnish.export(model, "three")) == ["ggx.three.js", "ggx.json"]
    with pytest.raises(burnish.Error, match="expected one of ktx2, .*, found 'jpeg'"):
        burnish.export(model, "jpeg")


def test_exports_are_named_after_their_materials(model, ggx, tmp_path):
    documents = {}
    for name in ("red paint", "blue"):
        burnish.write_model(tmp_path / f"{name}.burnish", model)
        files = burnish.export(burnish.open_source(tmp_path / f"{name}.burnish"), "materialx")
        documents[name] = next(text for file, text in files.items() if file.endswith(".mtlx")).decode()
    assert "ND_burnish_red_paint_bsdf" in documents["red paint"] and "ND_burnish_blue_bsdf" in documents["blue"]
    assert "ND_burnish_mine_bsdf" in burnish.export(model, "materialx", name="mine")["mine.mtlx"].decode()
    assert "openpbr.glsl" in burnish.export("openpbr:coat_weight=1", "glsl")


def test_rows_of_a_comparison_are_named_by_model(ggx, model, volume, tmp_path):
    def names(models):
        return [row["model"] for row in burnish.compare_models(ggx, models, count=500)]

    assert names({"small": model, "large": volume}) == ["small", "large"]
    of_list = names([model, volume, model])
    assert of_list[0] == f"{model.expression}, {model.bytes} bytes" and of_list[2] == of_list[0] + " (2)"
    assert of_list[1].startswith(volume.expression) and len(set(of_list)) == 3
    burnish.write_model(tmp_path / "own.exr", model)
    assert names([burnish.open_source(tmp_path / "own.exr")]) == [str(tmp_path / "own.exr")]
    assert names(model) == names([model])
    with pytest.raises(TypeError, match="^models: expected a Source, a list or a dictionary of them, found 'x'$"):
        names(["x"])


def test_everything_says_what_it_is(ggx, model, volume):
    shader = burnish.generate_shader(model)
    figures = burnish.error_figures(ggx, model, count=500)
    assert repr(ggx) == f"<burnish source '{GGX}': analytic, 3 channels, isotropic>"
    assert repr(model).startswith(f"<burnish model '{GGX}': {model.expression}, {model.bytes} bytes, 3 channels, psnr ")
    assert repr(volume.tables[1]) == "<burnish table 'g': volume of 7 x 5 x 3 nodes, power 0.5, 3 channels, " \
        f"{volume.tables[1].format}, {volume.tables[1].byte_count} bytes>"
    assert repr(figures).startswith(f"ErrorFigures(psnr={figures.psnr:.2f}, ssim=")
    things = (ggx, model, figures, shader, shader.textures[0], shader.textures[0].tables[0], model.tables[0],
              model.lobes[0], model.lobes[0].factors[0], burnish.fit(ggx, method="svd", samples=2000))
    for thing in things:
        assert " object at 0x" not in repr(thing) and "\n" not in repr(thing)


def test_misspelt_keywords_are_told_in_one_line(ggx, model, tmp_path):
    wi = [0, 0, 1]
    for call, said in (
        (
            lambda: burnish.open_source(GGX, keep_spectrl=True),
            "open_source: .*, found 'keep_spectrl'; did you mean 'keep_spectral'",
        ),
        (lambda: burnish.error_figures(ggx, model, cuont=5), "error_figures: .*found 'cuont'; did you mean 'count'"),
        (lambda: ggx.eval(wi=wi, w0=wi), "eval: expected one of wi, wo, out, found 'w0'; did you mean 'wi'"),
        (lambda: burnish.export(model, "glsl", nmae="a"), "export: .*, found 'nmae'; did you mean 'name'"),
        (lambda: burnish.export(ggx, "glsl"), "export: model: expected Model, found Source"),
        (lambda: burnish.error_figures(ggx, "a.exr"), "error_figures: model: expected Source, found str 'a.exr'"),
        (lambda: burnish.error_figures(ggx), "error_figures: model: expected Source, found nothing"),
        (lambda: burnish.error_figures(ggx, model, count=1.5), "error_figures: count: expected int, found float 1.5"),
        (
            lambda: burnish.error_figures(ggx, model, 5),
            "error_figures: expected at most 2 arguments without a name, found 3",
        ),
        (lambda: burnish.fit(GGX), "fit: source: expected Source, found str"),
        (lambda: burnish.fit(GGX, model="pqp"), "fit: source: expected Source, found str"),
        (lambda: burnish.open_source(3), "spec: expected a path or a spec, found 3"),
    ):
        with pytest.raises(TypeError, match=f"^{said}") as told:
            call()
        assert "\n" not in str(told.value) and len(str(told.value)) < 290
    with pytest.raises(burnish.Error, match="found 'progres'; did you mean 'progress'"):
        burnish.fit(ggx, progres=print)
    with pytest.raises(burnish.Error, match="^batch: .*found 'keep_spectrl'; did you mean 'keep_spectral'"):
        burnish.batch([GGX], tmp_path, keep_spectrl=True)


def test_the_specular_family_is_exported(cli, tmp_path):
    cli("export", "phong:exponent=20", "--to", "hlsl", "--power", "w8", "-o", tmp_path)
    files = burnish.export("phong:exponent=20", "hlsl", name="phong", power="w8")
    assert files["phong.hlsl"] == (tmp_path / "phong.hlsl").read_bytes()


def test_progress_rises_and_its_exceptions_end_the_fit(ggx):
    seen = []
    burnish.fit(ggx, budget=800, lobes=2, progress=lambda stage, fraction: seen.append((stage, fraction)))
    assert seen and {stage for stage, _ in seen} == {"sampling", "fitting", "matching albedos"}
    assert all(0 <= fraction <= 1 for _, fraction in seen)

    def stop(stage, fraction):
        raise LookupError(stage)

    with pytest.raises(LookupError, match="sampling"):
        burnish.fit(ggx, budget=800, progress=stop)


def test_ctrl_c_ends_a_fit():
    signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored where a shell runs this in the background
    source = burnish.open_source(BRUSHED)
    timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        burnish.fit(source, budget=2700, search=True)
    timer.join()


def test_nothing_leaks_from_fits_that_are_ended():
    # nanobind reports leaked instances when the interpreter ends
    program = f"""
import burnish
source = burnish.open_source({GGX!r})
def stop(stage, fraction):
    raise LookupError
for _ in range(3):
    try:
        burnish.fit(source, progress=stop)
    except LookupError as error:
        del error
burnish.fit(source, model="pqp").eval(*burnish.draw_pairs(10))
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 0 and "leak" not in done.stderr, done.stderr


def test_other_threads_go_on_during_a_fit(ggx):
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    begin = time.perf_counter()
    burnish.fit(ggx, budget=1000)
    end = time.perf_counter()
    done.set()
    thread.join()
    inside = [t for t in ticks if begin < t < end]
    assert len(inside) > 3


def test_tables_are_views_that_keep_their_model_alive(ggx):
    values = burnish.fit(ggx, model="pqp").tables[0].values
    gc.collect()
    assert values.shape == (1, 32, 3) and values.max() == 1 and not values.flags.writeable
    with pytest.raises(ValueError):
        values[0, 0, 0] = 2


def test_volumes_have_a_depth(volume):
    line, table = volume.tables
    assert line.shape == "line" and line.values.shape == (1, 32, 3)
    assert table.shape == "volume" and table.values.shape == (3, 5, 7, 3)
    assert table.warp == ("power", 0.5) and table.warp_z[0] == "identity"
    use = volume.lobes[0].factors[1]
    assert use.projection == (1, 1, 0, 0)
    assert (use.projection_y, use.projection_z) == ("difference", "azimuth")
    logs = [np.log(t.values.astype(np.float64)) for t in volume.tables]
    np.testing.assert_array_equal(volume.with_log_tables(logs).tables[1].values, table.values)
    with pytest.raises(burnish.Error, match=r"expected shape \(3, 5, 7, 3\) of table 'g', found \(1, 15, 7, 3\)"):
        volume.with_log_tables([logs[0], logs[1].reshape(1, 15, 7, 3)])
    with pytest.raises(burnish.Error, match=r"expected shape \(3, 5, 7, 3\) of table 'g', found \(15, 7, 3\)"):
        volume.with_log_tables([logs[0], logs[1].reshape(15, 7, 3)])


def test_log_tables_restore_and_change_a_model(lobes, pairs):
    logs = [np.log(table.values.astype(np.float64)) for table in lobes.tables]
    anew = len(logs) / 512  # rounded anew: half a unit of a mantissa of at least 256 in each table
    np.testing.assert_allclose(lobes.with_log_tables(logs).eval(*pairs), lobes.eval(*pairs), rtol=anew)
    brighter = [log + (0.5 if table.name == "a" else 0) for log, table in zip(logs, lobes.tables)]
    scales = lobes.with_log_tables(brighter).lobes
    np.testing.assert_allclose(scales[1].scale, np.exp(0.5) * np.array(lobes.lobes[1].scale), rtol=anew)
    with pytest.raises(burnish.Error, match=f"expected {len(logs)} arrays, found 1"):
        lobes.with_log_tables(logs[:1])


def test_energy_is_conserved():
    bright = burnish.open_source("ggx:alpha_x=0.3,alpha_y=0.3,kd=0.9")
    model = burnish.conserve_energy(burnish.fit(bright, model="pqp"))
    angles = np.radians(np.linspace(0, 88, 9))
    wi = np.stack([np.sin(angles), np.zeros(9), np.cos(angles)], axis=1)
    assert burnish.directional_albedo(model, wi).max() <= 1.01


def test_a_measurement_is_reproducible(ggx):
    wi, wo, f = burnish.measure(ggx, count=100, seed=3)
    np.testing.assert_array_equal(f, ggx.eval(wi, wo))
    noisy = burnish.measure(ggx, count=100, noise=0.1, seed=3)[2]
    assert 0.05 < np.std(np.log(noisy / f)) < 0.2


def test_a_batch_yields_its_materials_as_they_are_done(tmp_path, cli):
    specs = ["ggx:alpha_x=0.3,alpha_y=0.3", str(tmp_path / "missing.csv"), "ward:alpha_x=0.2,alpha_y=0.2"]
    how = {"model": "pqp", "samples": 2000}
    rows = {row["argument"]: row for row in burnish.batch(specs, tmp_path / "out", threads=1, **how)}
    assert set(rows) == set(specs)
    assert "no such file" in rows[specs[1]]["reason"]
    burnish.write_model(tmp_path / "alone.burnish", burnish.fit(burnish.open_source(specs[0]), **how))
    made = tmp_path / "out" / rows[specs[0]]["files"][0]["path"]
    assert made.read_bytes() == (tmp_path / "alone.burnish").read_bytes()
    assert not rows[specs[0]]["earlier"] and (tmp_path / "out/index.html").exists()

    # the command line goes on with it: nothing is left to do
    (tmp_path / "list").write_text("\n".join([specs[0], specs[2]]))
    told = cli("batch", tmp_path / "list", "-o", tmp_path / "out", "--resume", "--model", "pqp", "--samples", "2000",
               "--json")
    assert told["earlier"] == told["fitted"] == 2
    with pytest.raises(burnish.Error, match="found 'bugdet'; did you mean 'budget'"):
        burnish.batch(specs, tmp_path / "other", bugdet=2700)


def test_a_batch_opens_and_exports_as_the_command_line_does(tmp_path, cli):
    wi, wo = burnish.draw_pairs(300, seed=2)
    theta_i, theta_o = np.degrees(np.arccos(wi[:, 2])), np.degrees(np.arccos(wo[:, 2]))
    phi = np.degrees(np.arctan2(wo[:, 1], wo[:, 0]) - np.arctan2(wi[:, 1], wi[:, 0])) % 360
    rows = np.stack([theta_i, 0 * phi, theta_o, phi, 0.2 * wi[:, 2]], axis=1)
    felt = tmp_path / "felt.csv"
    np.savetxt(felt, rows, delimiter=",", header="theta_i,phi_i,theta_o,phi_o,value", comments="")
    how = {"model": "pqp", "to": ["glsl"], "has_cosine": True, "exact": True, "mips": True, "compressed": False}
    (row,) = burnish.batch([str(felt)], tmp_path / "python", **how)
    assert "reason" not in row
    cli("batch", tmp_path, "-o", tmp_path / "cli", "--model", "pqp", "--to", "glsl", "--has-cosine", "--exact", "--mips",
        "--plain")
    for made in [row["files"][0]["path"], "exports/felt/felt.glsl"]:
        assert (tmp_path / "python" / made).read_bytes() == (tmp_path / "cli" / made).read_bytes()
    (other,) = burnish.batch([str(felt)], tmp_path / "other", model="pqp", to=["glsl"])
    for made in [other["files"][0]["path"], "exports/felt/felt.glsl"]:
        assert (tmp_path / "python" / made).read_bytes() != (tmp_path / "other" / made).read_bytes()
    with pytest.raises(burnish.Error, match="expected to= with exact, mips or compressed=False, found no exports"):
        burnish.batch([str(felt)], tmp_path / "wrong", exact=True)
    with pytest.raises(burnish.Error, match="D66"):
        burnish.batch([str(felt)], tmp_path / "wrong", illuminant="D66")
    assert not (tmp_path / "wrong").exists()


def test_every_public_name_says_what_it_is():
    for name in burnish.__all__:
        assert getattr(burnish, name).__doc__, name


def test_a_real_measurement_is_read_and_fitted(rgl_file, cli):
    source = burnish.open_source(rgl_file)
    model = burnish.fit(source, budget=1344)
    assert model.bytes <= 1344 and burnish.error_figures(source, model, count=20_000).psnr > 20
    told = cli("info", rgl_file, "--json")
    nodes = told.pop("nodes")  # what the command line says besides
    assert nodes["incident_angles"] == 8 and 0 < nodes["predicted"]["relative"] < 1
    assert source.info() == told


def test_what_a_fit_follows_is_the_command_lines(cli, tmp_path):
    file, path = str(tmp_path / "paint.bsdf"), str(tmp_path / "model.exr")
    cli("convert", GGX, file)
    source = burnish.open_source(file)
    for keywords, options in (
        ({}, []),
        ({"target": "nodes"}, ["--target", "nodes"]),
        ({"target": "function"}, ["--target", "function"]),
        ({"hold_out": "half=1"}, ["--hold-out", "half=1"]),
    ):
        cli("fit", file, "-o", path, "--budget", 700, *options)
        model, stored = burnish.fit(source, budget=700, **keywords), burnish.open_source(path)
        assert model.notes == stored.notes
        for table, other in zip(model.tables, stored.tables):
            assert (np.asarray(table.values) == np.asarray(other.values)).all()
    with pytest.raises(burnish.Error, match="expected one of function, nodes, found 'cells'"):
        burnish.fit(source, budget=700, target="cells")


def test_a_material_is_the_command_lines(cli, tmp_path):
    printed = cli("fit", GGX, "--to", "gltf", "--alone", "-o", tmp_path / "cli.json", "--json")
    summary = burnish.fit_material(burnish.open_source(GGX), "gltf", tmp_path / "python.json", beside=False)
    for changing in ("output", "seconds"):
        printed.pop(changing), summary.pop(changing)
    assert summary == printed
    assert (tmp_path / "python.json").read_bytes() == (tmp_path / "cli.json").read_bytes()
    with pytest.raises(burnish.Error, match="expected openpbr or gltf, found 'obj'"):
        burnish.fit_material(burnish.open_source(GGX), "obj")


def test_an_openpbr_material_is_opened_again(tmp_path):
    source = burnish.open_source("openpbr:base_metalness=1,base_color=0.9/0.6/0.3,specular_roughness=0.5")
    summary = burnish.fit_material(source, "openpbr", tmp_path / "metal.json", beside=False)
    assert summary["parameters"]["specular_roughness"] == pytest.approx(0.5, abs=0.005)
    for spec in (summary["spec"], tmp_path / "metal.json"):
        assert burnish.error_figures(source, burnish.open_source(spec), count=1000).relative < 0.01


def test_a_book_completes_a_few_pairs(tmp_path):
    specs = [f"ggx:alpha_x={alpha},alpha_y={alpha}" for alpha in (0.15, 0.2, 0.3, 0.4, 0.5)]
    book = burnish.book(specs, bytes=8192, bytes_a_material=8)
    assert len(book) == 5 and book.shared_bytes <= 8192 and book.bytes_a_material <= 8
    book.write(tmp_path / "a.book")
    again = burnish.open_book(tmp_path / "a.book")
    assert again.names == book.names
    assert isinstance(book[book.names[2]], burnish.Model)
    with pytest.raises(KeyError):
        book["none"]

    unseen = burnish.open_source("ggx:alpha_x=0.35,alpha_y=0.35")
    model = burnish.fit(unseen, book=again, samples=15)
    assert burnish.error_figures(unseen, model, count=1000).relative < 0.2
    with pytest.raises(burnish.Error, match="anisotropic"):
        burnish.book([*specs, "ggx:alpha_x=0.1,alpha_y=0.3"])

    # and takes no options of other fits
    for keywords, said in (
        ({"budget": 2700}, "budget excludes book"),
        ({"model": "pqp"}, "model excludes book"),
        ({"fetches": 2}, "fetches requires budget"),
        ({"symmetrize": False}, "symmetrize=false excludes book"),
    ):
        with pytest.raises(burnish.Error, match=f"^{said}$"):
            burnish.fit(unseen, book=again, **keywords)
    with pytest.raises(TypeError, match="book: expected a Book, found 'metals.burnish'"):
        burnish.fit(unseen, book="metals.burnish")
