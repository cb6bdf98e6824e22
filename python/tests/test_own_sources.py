# SPDX-License-Identifier: Apache-2.0
"""Sources of one's own: samples in arrays, functions of NumPy."""

import subprocess
import sys
import threading

import numpy as np
import pytest

import burnish
from conftest import GGX, hemisphere

ALPHA, KD = 0.2, np.array([0.05, 0.1, 0.2])


def ggx_of_numpy(wi, wo, alpha_x=ALPHA, alpha_y=ALPHA):
    """What GGX says, written anew."""
    h = wi + wo
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    slope = (h[:, 0] / alpha_x) ** 2 + (h[:, 1] / alpha_y) ** 2 + h[:, 2] ** 2
    density = 1 / (np.pi * alpha_x * alpha_y * slope**2)

    def hidden(w):
        return (np.sqrt(1 + ((w[:, 0] * alpha_x) ** 2 + (w[:, 1] * alpha_y) ** 2) / w[:, 2] ** 2) - 1) / 2

    fresnel = 0.9 + 0.1 * (1 - np.sum(h * wi, axis=1)) ** 5
    facets = density * fresnel / (4 * wi[:, 2] * wo[:, 2] * (1 + hidden(wi) + hidden(wo)))
    return facets[:, None] + KD / np.pi


def write_csv(path, wi, wo, values, remark=""):
    columns = {1: "value", 3: "r,g,b"}[values.shape[1]]
    rows = np.hstack([wi, wo, values])
    header = f"{remark}wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,{columns}"
    np.savetxt(path, rows, delimiter=",", header=header, comments="", fmt="%.17g")
    return path


@pytest.fixture(scope="module")
def measured(ggx):
    return burnish.measure(ggx, count=1500, noise=0.02, seed=5)


@pytest.fixture(scope="module")
def samples(measured):
    return burnish.Source.from_samples(*measured, isotropic=True)


def same_tables(one, other):
    return all(np.array_equal(a.values, b.values) for a, b in zip(one.tables, other.tables, strict=True))


@pytest.mark.parametrize("how", [{"budget": 1400}, {"target": "function"}])
def test_samples_are_fitted_as_their_file_is(how, measured, samples, tmp_path):
    file = burnish.open_source(write_csv(tmp_path / "samples.csv", *measured, remark="# isotropic\n"))
    from_file, from_arrays = burnish.fit(file, **how), burnish.fit(samples, **how)
    assert same_tables(from_file, from_arrays)
    changing = ("source", "source_format")
    assert {key: value for key, value in from_file.notes.items() if key not in changing} == {
        key: value for key, value in from_arrays.notes.items() if key not in changing
    }
    wi, wo = burnish.draw_pairs(200, seed=9)
    np.testing.assert_array_equal(file.eval(wi, wo), samples.eval(wi, wo))
    one, other = file.info(), samples.info()
    for key in ("samples", "warnings", "theta_i_deg", "theta_o_deg", "albedo", "isotropic"):
        assert one[key] == other[key]


def test_whether_samples_are_isotropic_is_found_as_in_files(measured, tmp_path):
    wi, wo, values = measured
    file = burnish.open_source(write_csv(tmp_path / "samples.csv", wi, wo, values))
    assert file.isotropic and burnish.Source.from_samples(wi, wo, values).isotropic
    brushed = burnish.measure(burnish.open_source("ggx:alpha_x=0.1,alpha_y=0.4,f0=0.9"), count=1500, seed=5)
    file = burnish.open_source(write_csv(tmp_path / "brushed.csv", *brushed))
    assert not file.isotropic and not burnish.Source.from_samples(*brushed).isotropic
    in_one = [0.6, 0, 0.8]
    assert burnish.Source.from_samples(in_one, wo, values).isotropic
    assert not burnish.Source.from_samples(in_one, wo, values, isotropic=False).isotropic


def test_samples_come_in_any_type_and_order(measured):
    wi, wo, values = measured
    source = burnish.Source.from_samples(wi, wo, values)
    pairs = burnish.draw_pairs(50, seed=3)
    expected = source.eval(*pairs)
    wide = np.zeros((1500, 9))
    wide[:, ::3] = wi
    for changed in (
        (wi.tolist(), wo.tolist(), values.tolist()),
        (wide[:, ::3], np.asfortranarray(wo), values[:, ::-1][:, ::-1]),
        (list(wi), tuple(wo), [list(row) for row in values]),
    ):
        np.testing.assert_array_equal(burnish.Source.from_samples(*changed).eval(*pairs), expected)
    single = burnish.Source.from_samples(wi.astype("f4"), wo.astype("f4"), values.astype("f4")).eval(*pairs)
    np.testing.assert_allclose(single, expected, rtol=1e-3)
    grey = burnish.Source.from_samples(wi, wo, values[:, 0])
    assert grey.channels == 1 and grey.eval(*pairs).shape == (50, 1)
    np.testing.assert_array_equal(grey.eval(*pairs), burnish.Source.from_samples(wi, wo, values[:, :1]).eval(*pairs))
    one = burnish.Source.from_samples([0, 0, 1], [0, 0, 1], [1, 2, 3])
    assert (one.channels, one.info()["samples"]) == (3, 1)
    assert burnish.Source.from_samples([0, 0, 1], [0, 0, 1], 2).channels == 1


def test_the_arrays_are_copied(measured):
    wi, wo, values = (array.copy() for array in measured)
    source = burnish.Source.from_samples(wi, wo, values)
    before = source.eval([0, 0, 1], [0.6, 0, 0.8])
    wi[:], wo[:], values[:] = 0, 0, 0
    np.testing.assert_array_equal(source.eval([0, 0, 1], [0.6, 0, 0.8]), before)


def test_spectra_become_colours_or_stay(measured):
    wi, wo, values = measured
    lambda_nm = [450, 550, 650]
    grey = np.repeat(values[:, :1], 3, axis=1)
    rgb = burnish.Source.from_samples(wi, wo, grey, lambda_nm=lambda_nm)
    kept = burnish.Source.from_samples(wi, wo, values, lambda_nm=lambda_nm, keep_spectral=True)
    assert rgb.channels == 3 and rgb.lambda_nm == [] and rgb.info()["illuminant"] == "equal energy"
    assert kept.lambda_nm == lambda_nm
    many = burnish.Source.from_samples(wi, wo, values[:, [0, 1, 2, 0]], lambda_nm=[400, 500, 600, 700])
    assert many.channels == 3


def test_negative_values_are_kept_as_noise(measured):
    wi, wo, values = measured
    noisy = values - 2 * values.min()
    noisy[:700] -= values.max()
    source = burnish.Source.from_samples(wi, wo, noisy)
    assert source.info()["negatives"] == (noisy < 0).sum() > 0 and source.info()["most_negative"] == noisy.min()


def changed(array, index, value):
    array = np.array(array, float)
    array[index] = value
    return array


@pytest.mark.parametrize(
    "wrong, kind, said",
    [
        (lambda i, o, v: (i, o, v[:-1]), burnish.Error, r"values: expected shape \(1500,\) or .*, found \(1499, 3\)"),
        (lambda i, o, v: (i, o, v.T), burnish.Error, r"values: expected shape .*, found \(3, 1500\)"),
        (lambda i, o, v: (i[:, :2], o, v), burnish.Error, r"wi: expected shape \(N, 3\) or \(3,\), found \(1500, 2\)"),
        (lambda i, o, v: (i, o[:7], v), burnish.Error, "wi and wo: expected equal counts, found 1500 and 7"),
        (
            lambda i, o, v: (i, o, changed(v, 4, np.nan)),
            burnish.Error,
            r"values\[4\]: expected finite values, found nan",
        ),
        (
            lambda i, o, v: (i, o, changed(v, 9, np.inf)),
            burnish.Error,
            r"values\[9\]: expected finite values, found inf",
        ),
        (lambda i, o, v: (changed(i, 8, np.nan), o, v), burnish.Error, r"wi\[8\]: expected a unit vector, found \(nan"),
        (lambda i, o, v: (i, 1.1 * o, v), burnish.Error, r"wo\[0\]: expected a unit vector"),
        (lambda i, o, v: (i, -o, v), burnish.Error, r"wo\[0\]: expected a direction above the horizon"),
        (
            lambda i, o, v: (i, o, v[:, :2]),
            burnish.Error,
            "lambda_nm: expected 2 wavelengths for 2 channels, found none",
        ),
        (
            lambda i, o, v: (i[:0], o[:0], v[:0]),
            burnish.Error,
            "samples: expected at least one measurement, found none",
        ),
        (
            lambda i, o, v: (i, o, [[1, 2], [3]]),
            TypeError,
            "values: expected an array of real numbers, found rows of un",
        ),
        (lambda i, o, v: (i, o, v * 1j), TypeError, "values: expected an array of real numbers, found complex numbers"),
        (lambda i, o, v: ("up", o, v), TypeError, "wi: expected an array of real numbers, found str"),
    ],
)
def test_wrong_samples_are_told_in_one_line(wrong, kind, said, measured):
    with pytest.raises(kind, match=f"^{said}") as told:
        burnish.Source.from_samples(*wrong(*measured))
    assert "\n" not in str(told.value) and len(str(told.value)) < 290


def test_a_function_is_fitted_as_the_formula_is(ggx):
    source = burnish.Source.from_function(ggx_of_numpy)
    assert (source.name, source.channels, source.isotropic) == ("ggx_of_numpy", 3, True)
    pairs = burnish.draw_pairs(3000, seed=4, isotropic=False)
    np.testing.assert_allclose(source.eval(*pairs), ggx.eval(*pairs), rtol=1e-9)
    mine, formula = burnish.fit(source, model="pqp"), burnish.fit(ggx, model="pqp")
    for key in ("psnr", "relative", "rms_log", "samples"):
        assert mine.notes[key] == pytest.approx(formula.notes[key], rel=1e-4)
    of_mine, of_formula = burnish.error_figures(source, mine, count=5000), burnish.error_figures(ggx, mine, count=5000)
    assert of_mine.relative == pytest.approx(of_formula.relative, rel=1e-6)
    wi = [[0, 0, 1], [0.6, 0, 0.8]]
    np.testing.assert_allclose(burnish.directional_albedo(source, wi), burnish.directional_albedo(ggx, wi), rtol=1e-6)


def test_a_function_says_whether_it_is_isotropic_and_what_it_is_called():
    def brushed(wi, wo):
        return ggx_of_numpy(wi, wo, 0.1, 0.4)[:, 0]

    source = burnish.Source.from_function(brushed)
    assert (source.name, source.channels, source.isotropic) == ("brushed", 1, False)
    named = burnish.Source.from_function(lambda wi, wo: brushed(wi, wo), name="wood", isotropic=True)
    assert (named.name, named.isotropic) == ("wood", True)
    assert burnish.Source.from_function(lambda wi, wo: wi[:, 2] * wo[:, 2]).name == "function"
    spectrum = burnish.Source.from_function(lambda wi, wo: np.ones((len(wi), 5)), lambda_nm=range(400, 900, 100))
    assert spectrum.channels == 5 and spectrum.lambda_nm == [400, 500, 600, 700, 800]


def test_a_function_is_asked_only_above_the_horizon_and_draws_have_its_density():
    asked = []

    def function(wi, wo):
        asked.append(min(wi[:, 2].min(), wo[:, 2].min()))
        assert wi.shape == wo.shape == (len(wi), 3) and wi.dtype == wo.dtype == np.float64
        return wi[:, 2] + wo[:, 2]

    source = burnish.Source.from_function(function)
    w = np.vstack([hemisphere(500), -hemisphere(500)])
    f = source.eval(w, w[::-1].copy())
    assert min(asked) > 0 and not f.any()
    assert (source.eval(w[:500], w[:500]) > 0).all()
    wi, pdf = source.sample_wi(hemisphere(100), np.random.default_rng(1).random((100, 2)).astype("f4"))
    assert (pdf > 0).mean() > 0.95


def test_a_function_may_evaluate_other_sources(ggx, model):
    # from threads of the library, which it then uses again
    source = burnish.Source.from_function(lambda wi, wo: 0.5 * (ggx.eval(wi, wo) + model.eval(wi, wo)))
    pairs = burnish.draw_pairs(150_000, seed=2, isotropic=False)
    np.testing.assert_allclose(source.eval(*pairs), 0.5 * (ggx.eval(*pairs) + model.eval(*pairs)), rtol=1e-12)
    figures = burnish.error_figures(ggx, source, count=5000)
    assert 0 < figures.relative < burnish.error_figures(ggx, model, count=5000).relative


def test_threads_share_a_function():
    source = burnish.Source.from_function(ggx_of_numpy)
    pairs = burnish.draw_pairs(20_000, isotropic=False)
    expected, results = source.eval(*pairs), [None] * 4
    u = np.random.default_rng(1).random((20_000, 2))

    def work(i):
        results[i] = source.eval(*pairs), source.sample_wi(pairs[1], u)[1]

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(120)
    assert not any(thread.is_alive() for thread in threads)
    for f, pdf in results:
        np.testing.assert_array_equal(f, expected)
        np.testing.assert_array_equal(pdf, results[0][1])


class Failing:
    """A function that is well until it is told to fail."""

    def __init__(self, answer):
        self.answer, self.fails = answer, False

    def __call__(self, wi, wo):
        return self.answer(wi, wo) if self.fails else ggx_of_numpy(wi, wo)


def raising(wi, wo):
    raise LookupError("mine")


USES = {
    "eval": lambda s: s.eval(*burnish.draw_pairs(5000, isotropic=False)),
    "eval of one": lambda s: s.eval([0, 0, 1], [0, 0, 1]),
    "sample_wi": lambda s: s.sample_wi([0, 0, 1], [0.5, 0.5]),
    "pdf": lambda s: s.pdf([0, 0, 1], [0, 0, 1]),
    "info": lambda s: s.info(),
    "fit of one lobe": lambda s: burnish.fit(s, model="pqp"),
    "baseline": lambda s: burnish.fit(s, method="svd"),
    "fit_material": lambda s: burnish.fit_material(s, "gltf", beside=False),
    "error_figures": lambda s: burnish.error_figures(burnish.open_source(GGX), s, count=1000),
    "compare_models": lambda s: burnish.compare_models(s, [burnish.open_source(GGX)], count=1000),
    "directional_albedo": lambda s: burnish.directional_albedo(s, [0, 0, 1]),
    "render_sphere": lambda s: burnish.render_sphere(s, 0.5, 32),
    "measure": lambda s: burnish.measure(s, count=50),
    "convert": lambda s: burnish.convert(s, "/nowhere/never.binary", "merl", cells=8),
    "tables of the sampler": lambda s: s._sampler_graphs(),
}


@pytest.mark.parametrize("use", USES)
def test_what_a_function_raises_ends_whatever_needed_it(use):
    function = Failing(raising)
    source = burnish.Source.from_function(function, isotropic=True)
    function.fails = True
    with pytest.raises(LookupError, match="^'?mine'?$"):
        USES[use](source)
    function.fails = False
    assert source.eval([0, 0, 1], [0, 0, 1])[0] > 0


@pytest.mark.parametrize(
    "answer, kind, said",
    [
        (
            lambda wi, wo: np.where(wi[:, :1] > 0.3, np.nan, ggx_of_numpy(wi, wo)),
            burnish.Error,
            "function: expected finite values of at least 0, found nan at wi = ",
        ),
        (
            lambda wi, wo: ggx_of_numpy(wi, wo) / 0,
            burnish.Error,
            "function: expected finite values of at least 0, found inf at wi = ",
        ),
        (
            lambda wi, wo: -ggx_of_numpy(wi, wo),
            burnish.Error,
            "function: expected finite values of at least 0, found -",
        ),
        (
            lambda wi, wo: ggx_of_numpy(wi, wo)[:, :2],
            burnish.Error,
            r"function: expected shape \(200, 3\) for 200 pairs, found \(200, 2\)",
        ),
        (
            lambda wi, wo: ggx_of_numpy(wi, wo).T,
            burnish.Error,
            r"function: expected shape .* for 200 pairs, found \(3, 200\)",
        ),
        (lambda wi, wo: 0.3, burnish.Error, r"function: expected shape .* for 200 pairs, found \(\)"),
        (lambda wi, wo: None, TypeError, "function: expected an array of real numbers, found NoneType"),
        (lambda wi, wo: 1j * wi[:, 2], TypeError, "function: expected an array of real numbers, found complex numbers"),
        (lambda wi: wi, TypeError, ".*takes 1 positional argument but 2 were given"),
        (raising, LookupError, "'?mine'?$"),
    ],
)
@pytest.mark.parametrize("later", [False, True])
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_wrong_answers_are_told_in_one_line(answer, kind, said, later):
    if not later:
        if "(200, 3)" in said.replace("\\", ""):
            said = "lambda_nm: expected 2 wavelengths for 2 channels, found none"
        with pytest.raises(kind, match=f"^{said}") as told:
            burnish.Source.from_function(answer)
    else:
        function = Failing(answer)
        source = burnish.Source.from_function(function, isotropic=True)
        function.fails = True
        pairs = burnish.draw_pairs(200, isotropic=False)
        with pytest.raises(kind, match=f"^{said}") as told:
            source.eval(*pairs)
    assert "\n" not in str(told.value) and len(str(told.value)) < 290


def test_what_is_no_function_is_refused():
    with pytest.raises(TypeError, match="^function: expected a function of wi and wo, found 3$"):
        burnish.Source.from_function(3)
    with pytest.raises(TypeError, match="found 'isotropc'; did you mean 'isotropic'"):
        burnish.Source.from_function(ggx_of_numpy, isotropc=True)


def test_ctrl_c_in_a_function_ends_the_fit():
    program = """
import burnish, os, signal
signal.signal(signal.SIGINT, signal.default_int_handler)
calls = 0
def function(wi, wo):
    global calls
    calls += 1
    if calls == 30:
        os.kill(os.getpid(), signal.SIGINT)
    return wi[:, 2] * wo[:, 2] + 0.1
try:
    burnish.fit(burnish.Source.from_function(function), budget=2700, search=True)
except KeyboardInterrupt:
    print("ended")
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=300)
    assert done.stdout == "ended\n" and "leak" not in done.stderr, done.stderr


def test_functions_do_not_leak():
    program = """
import burnish, gc, weakref
def make():
    class Function:
        def __call__(self, wi, wo):
            return wi[:, 2] * wo[:, 2]
    function = Function()
    source = burnish.Source.from_function(function)
    source.eval(*burnish.draw_pairs(100))
    return weakref.ref(function)
gone = make()
gc.collect()
assert gone() is None
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 0 and not done.stderr, done.stderr


def test_the_error_of_samples_is_the_command_lines(cli, measured, samples, tmp_path):
    file = write_csv(tmp_path / "samples.csv", *measured, remark="# isotropic\n")
    wi, wo = burnish.draw_pairs(300, seed=8)
    wi[5, 2] *= -1
    np.savetxt(
        tmp_path / "d.csv",
        np.hstack([wi, wo]),
        delimiter=",",
        header="wi_x,wi_y,wi_z,wo_x,wo_y,wo_z",
        comments="",
        fmt="%.17g",
    )
    cli("eval", file, tmp_path / "d.csv", "-o", tmp_path / "v.csv", "--error")
    expected = np.loadtxt(tmp_path / "v.csv", delimiter=",", skiprows=1)[:, 3]
    error = samples.relative_error(wi, wo)
    assert error.shape == (300,) and error[5] == 0
    np.testing.assert_allclose(error, expected, rtol=1e-3)
    np.testing.assert_array_equal(samples.relative_error(wi.tolist(), wo), error)
    single = samples.relative_error(wi.astype("f4"), wo.astype("f4"))
    assert single.dtype == np.float32
    np.testing.assert_allclose(single, error, rtol=0.01)
    assert samples.relative_error(wi[1], wo[1]) == error[1]
    out = np.empty(300)
    assert samples.relative_error(wi, wo, out=out) is out and np.array_equal(out, error)
    assert np.isnan(samples.relative_error([0, 0, 2], [0, 0, 1]))


def test_the_error_grows_where_nothing_was_measured(measured):
    wi, wo, values = measured
    near = (wi[:, 2] > 0.7) & (wo[:, 2] > 0.7)
    source = burnish.Source.from_samples(wi[near], wo[near], values[near], isotropic=True)
    inside, outside = source.relative_error(wi[near], wo[near]), source.relative_error(wi[~near], wo[~near])
    assert np.median(outside) > 2 * np.median(inside)


def test_a_table_tells_its_error_and_a_formula_does_not(ggx, samples, tmp_path):
    burnish.convert(ggx, tmp_path / "paint.bsdf", "rgl")
    table = burnish.open_source(tmp_path / "paint.bsdf")
    assert 0 < table.relative_error([0, 0, 1], [0.6, 0, 0.8]) < 1
    for ask in (lambda: ggx.relative_error([0, 0, 1], [0, 0, 1]), lambda: burnish.next_measurements(ggx)):
        with pytest.raises(burnish.Error, match="expected a measurement, whose nodes are known, found analytic"):
            ask()


def test_the_next_directions_are_the_command_lines(cli, measured, samples, tmp_path):
    file = write_csv(tmp_path / "samples.csv", *measured, remark="# isotropic\n")
    assert burnish.next_measurements(samples, 4) == cli("measure", file, "--next", 4, "--json")["next"]
    assert len(burnish.next_measurements(samples)) == 20
    for count in (0, 801):
        with pytest.raises(burnish.Error, match=f"^count: expected 1 to 800 directions, found {count}$"):
            burnish.next_measurements(samples, count)


def test_a_fit_of_samples_says_what_error_is_expected(cli, measured, samples, tmp_path):
    file = write_csv(tmp_path / "samples.csv", *measured, remark="# isotropic\n")
    model = burnish.fit(samples, budget=1400)
    expected = model.notes["node_expected"]
    assert 0 < expected["relative"] < 1 and len(expected["from_theta_i_deg"]) == 6
    told = cli("fit", file, "-o", tmp_path / "m.exr", "--budget", 1400, "--json")
    assert told["node_expected"] == expected
    assert f"expected relative {expected['relative']:.2g}" in repr(model)
