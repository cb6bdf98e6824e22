# SPDX-License-Identifier: Apache-2.0
import threading

import numpy as np
import pytest

import burnish
from conftest import GGX, hemisphere


def write_directions(path, wi, wo):
    rows = np.hstack([wi, wo])
    np.savetxt(path, rows, delimiter=",", header="wi_x,wi_y,wi_z,wo_x,wo_y,wo_z", comments="", fmt="%.17g")


@pytest.mark.parametrize("name", ["ggx", "model", "lobes", "volume"])
def test_eval_gives_what_the_command_line_gives(name, request, cli, pairs, tmp_path):
    source = request.getfixturevalue(name)
    spec = GGX
    if name != "ggx":
        spec = tmp_path / "model.exr"
        burnish.write_model(spec, source)
    write_directions(tmp_path / "directions.csv", *pairs)
    cli("eval", spec, tmp_path / "directions.csv", "-o", tmp_path / "values.csv")
    expected = np.loadtxt(tmp_path / "values.csv", delimiter=",", skiprows=1)
    np.testing.assert_array_equal(source.eval(*pairs), expected)


@pytest.mark.parametrize("name", ["model", "lobes", "volume"])
def test_float32_is_near_the_definition(name, request, pairs):
    source = request.getfixturevalue(name)
    wi, wo = (w.astype(np.float32) for w in pairs)
    exact = source.eval(wi.astype(np.float64), wo.astype(np.float64))
    np.testing.assert_allclose(source.eval(wi, wo), exact, rtol=1e-4)


@pytest.mark.parametrize("name", ["ggx", "model"])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_any_layout_gives_the_same_bits(name, dtype, request):
    source = request.getfixturevalue(name)
    wi, wo = hemisphere(40_001, 1).astype(dtype), hemisphere(40_001, 2).astype(dtype)
    expected = source.eval(wi, wo)
    assert expected.flags.c_contiguous and expected.dtype == dtype
    planes = source.eval(np.asfortranarray(wi), np.asfortranarray(wo))
    assert planes.flags.f_contiguous
    np.testing.assert_array_equal(planes, expected)
    np.testing.assert_array_equal(source.eval(np.asfortranarray(wi), wo), expected)
    wide = np.zeros((40_001, 8), dtype)
    wide[:, 1:7:2] = wi
    np.testing.assert_array_equal(source.eval(wide[:, 1:7:2], wo), expected)
    np.testing.assert_array_equal(source.eval(wi[::-1], wo[::-1])[::-1], expected)
    out = np.zeros((80_002, 3), dtype)
    assert np.shares_memory(source.eval(wi, wo, out=out[::2]), out)
    np.testing.assert_array_equal(out[::2], expected)
    assert not out[1::2].any()


@pytest.mark.parametrize("name", ["model", "lobes", "volume"])
def test_one_pair_gives_the_same_bits_as_many(name, request):
    source = request.getfixturevalue(name)
    wi, wo = hemisphere(300, 5), hemisphere(300, 6)
    wi[7, 2] *= -1
    wo[9] *= 2
    many = source.eval(wi, wo)
    assert not many[7].any() and np.isnan(many[9]).all()
    for i in range(len(wi)):
        one = source.eval(wi[i], wo[i])
        assert one.dtype == np.float32 and one.shape == (source.channels,)
        np.testing.assert_array_equal(one, many[i])
    out = np.zeros((1, 6), np.float32)
    source.eval(wi[:1], wo[0], out=out[:, ::2])
    np.testing.assert_array_equal(out[0, ::2], many[0])
    assert not out[0, 1::2].any()


def test_one_direction_stands_for_all(model):
    wi, wo = hemisphere(500), np.array([0.6, 0, 0.8], np.float32)
    np.testing.assert_array_equal(model.eval(wi, wo), model.eval(wi, np.tile(wo, (500, 1))))
    np.testing.assert_array_equal(model.eval(wi[3], wo), model.eval(wi, wo)[3])
    assert model.eval(wi[:0], wo).shape == (0, 3)


def test_nothing_is_reflected_below_the_horizon(model, ggx):
    down, up = np.array([[0.6, 0, -0.8]]), np.array([[0, 0, 1.0]])
    for source in (model, ggx):
        for dtype in (np.float32, np.float64):
            assert not source.eval(down.astype(dtype), up.astype(dtype)).any()
            assert not source.eval(up.astype(dtype), down.astype(dtype)).any()


def test_what_is_no_direction_has_no_value(model, ggx):
    up = np.array([0, 0, 1.0])
    for bad in ([np.nan, 0, 1], [0, 0, np.inf], [0, 0, 2], [0, 0, 0]):
        assert np.isnan(model.eval(np.array(bad, float), up)).all()
        assert np.isnan(ggx.eval(up, np.array(bad, float))).all()
        assert np.isnan(model.eval(np.array(bad, np.float32), up.astype(np.float32))).all()
        ggx.sample_wi(np.array(bad, float), np.array([0.5, 0.5]))
        model.pdf(np.array(bad, np.float32), np.array(bad, np.float32))


def test_shapes_and_types_that_do_not_fit_are_refused(model):
    w = hemisphere(4)
    with pytest.raises(burnish.Error, match=r"wi: expected shape \(N, 3\) or \(3,\), found \(4, 2\)"):
        model.eval(w[:, :2], w)
    with pytest.raises(burnish.Error, match="wi and wo: expected equal counts, found 4 and 3"):
        model.eval(w, w[:3])
    with pytest.raises(burnish.Error, match=r"out: expected shape \(4, 3\), found \(3, 3\)"):
        model.eval(w, w, out=np.empty((3, 3), np.float32))
    with pytest.raises(TypeError, match="out: expected a writable array of float32"):
        model.eval(w, w, out=np.empty((4, 3)))
    frozen = np.empty((4, 3), np.float32)
    frozen.flags.writeable = False
    with pytest.raises(TypeError, match="writable"):
        model.eval(w, w, out=frozen)


def test_lists_and_integers_and_mixtures_are_taken(model, ggx):
    w = hemisphere(4)
    exact = w.astype(np.float64)
    up, upright = np.array([0, 0, 1]), np.array([0, 0, 1.0])
    for source in (model, ggx):
        expected = source.eval(exact, upright)
        for wi, wo in (
            (exact.tolist(), [0, 0, 1]),
            (exact, up),
            (w, upright),
            (exact.astype(">f8"), up.astype("u1")),
            ([*exact], (0, 0, 1)),
        ):
            f = source.eval(wi, wo)
            assert f.dtype == np.float64
            np.testing.assert_array_equal(f, expected)
        # lists follow arrays
        f = source.eval(w, [0, 0, 1])
        assert f.dtype == np.float32
        np.testing.assert_array_equal(f, source.eval(w, upright.astype("f4")))
        out = np.empty((4, 3), np.float32)
        assert source.eval(w.tolist(), [0, 0, 1], out=out) is out
        np.testing.assert_array_equal(source.pdf(exact.tolist(), [0, 0, 1]), source.pdf(exact, upright))
        drawn, again = source.sample_wi([0, 0, 1], [0.25, 0.5]), source.sample_wi(upright, np.array([0.25, 0.5]))
        np.testing.assert_array_equal(drawn[0], again[0])
        assert drawn[1] == again[1] and source.eval([0, 0, 1], [0, 0, 1]).shape == (3,)
    for wrong, found in (
        ([[0, 0, 1], [0, 1]], "rows of unequal lengths"),
        ("up", "str"),
        (None, "NoneType"),
        ([0, 0, 1j], "complex numbers"),
        ([True, False, True], "booleans"),
    ):
        with pytest.raises(TypeError, match=f"^wi: expected an array of real numbers, found {found}$"):
            model.eval(wrong, up)
    with pytest.raises(burnish.Error, match=r"^wo: expected shape \(N, 3\) or \(3,\), found \(2,\)$"):
        model.eval(w, [0, 1])


class Lent:
    """An array that is no NumPy: it lends its memory (DLPack) and knows nothing else."""

    def __init__(self, array):
        self.array = array

    def __dlpack__(self, **options):
        return self.array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self.array.__dlpack_device__()


class Copied:
    """An array that is no NumPy: it becomes one when asked."""

    def __init__(self, array):
        self.array, self.dtype = array, f"package.{array.dtype}"

    def __array__(self, dtype=None, copy=None):
        return np.array(self.array, dtype)


class Elsewhere:
    """An array that the processor cannot read."""

    dtype = "package.float32"

    def __dlpack__(self, **options):
        raise BufferError("not on this device")

    def __dlpack_device__(self):
        return 2, 0

    def __array__(self, dtype=None, copy=None):
        raise TypeError("cannot read card:0\nUse .cpu() first.")


@pytest.mark.parametrize("kind", [Lent, Copied])
def test_arrays_of_other_packages_are_taken(kind, model, ggx):
    w, up = hemisphere(40), np.array([0, 0, 1], np.float32)
    for source in (model, ggx):
        for dtype in (np.float32, np.float64):
            wi, wo = w.astype(dtype), np.tile(up.astype(dtype), (40, 1))
            expected = source.eval(wi, wo)
            for given in ((kind(wi), kind(wo)), (kind(wi), wo), (kind(wi), [0, 0, 1]), (kind(wi), kind(wo[0]))):
                f = source.eval(*given)
                assert isinstance(f, np.ndarray) and f.dtype == dtype
                np.testing.assert_array_equal(f, expected)
            # across, as NumPy has it reversed in memory
            np.testing.assert_array_equal(source.eval(kind(wi[::-1]), kind(wo)), expected[::-1])
            np.testing.assert_array_equal(source.pdf(kind(wi), kind(wo)), source.pdf(wi, wo))
        # of both types and of integers: float64
        f = source.eval(kind(w), kind(up.astype(int)))
        assert f.dtype == np.float64
        np.testing.assert_array_equal(f, source.eval(w.astype(np.float64), up.astype(np.float64)))


def test_results_go_into_arrays_of_other_packages(model):
    w, out = hemisphere(40), Lent(np.zeros((40, 3), np.float32))
    assert model.eval(w, w, out=out) is out
    np.testing.assert_array_equal(out.array, model.eval(w, w))
    assert model.eval(Lent(w), [0, 0, 1], out=out) is out
    np.testing.assert_array_equal(out.array, model.eval(w, np.array([0, 0, 1], np.float32)))
    with pytest.raises(TypeError, match="^out: expected a writable array of float32$"):
        model.eval(w, w, out=Lent(np.zeros((40, 3))))
    with pytest.raises(TypeError, match="^out: expected a writable array of float32$"):
        model.eval(w, w, out=Elsewhere())


def test_arrays_on_other_devices_are_refused_with_their_owners_words(model):
    found = "^wi: expected an array of real numbers, found Elsewhere: cannot read card:0$"
    with pytest.raises(TypeError, match=found):
        model.eval(Elsewhere(), hemisphere(1))
    with pytest.raises(TypeError, match="^wo: .* found complex numbers$"):
        model.eval([0, 0, 1], Lent(np.array([0, 0, 1j])))


def test_table_gradients_are_difference_quotients(model):
    wi, wo = hemisphere(30).astype(np.float64), hemisphere(30)[::-1].astype(np.float64)
    weights = np.random.default_rng(5).normal(size=(30, 3))
    logs = [np.log(table.values, dtype=np.float64) for table in model.tables]
    # A model of floats holds tables that are moved a little.
    exact = model.with_log_tables(logs, format="float")
    gradients = exact.table_gradient(wi, wo, weights)
    assert [g.shape for g in gradients] == [table.values.shape for table in model.tables]
    assert all(g.dtype == np.float64 for g in gradients)
    for k, (gradient, table) in enumerate(zip(gradients, exact.tables)):
        along = np.random.default_rng(k).normal(size=gradient.shape)
        low, high = (
            (exact.with_log_tables(logs[:k] + [logs[k] + h * along] + logs[k + 1 :]).eval(wi, wo) * weights).sum()
            for h in (-1e-3, 1e-3)
        )
        expected = (gradient * table.values * along).sum()
        size = np.abs(exact.eval(wi, wo) * weights).sum()
        assert abs((high - low) / 2e-3 - expected) < 1e-3 * abs(expected) + 1e-4 * size
    # One weight stands for all pairs, one direction for all, and one pair adds what it adds among others.
    for got, one in zip(exact.table_gradient(wi, wo[0], weights[0]),
                        exact.table_gradient(wi, np.tile(wo[:1], (30, 1)), np.tile(weights[:1], (30, 1)))):
        np.testing.assert_array_equal(got, one)
    parts = [exact.table_gradient(wi[i], wo[i], weights[i]) for i in range(30)]
    for k, gradient in enumerate(gradients):
        np.testing.assert_allclose(sum(part[k] for part in parts), gradient, rtol=1e-9, atol=1e-12)
    with pytest.raises(burnish.Error, match=r"^weights: expected shape \(N, 3\) or \(3,\), found \(30, 2\)$"):
        model.table_gradient(wi, wo, weights[:, :2])


def test_draws_have_the_density_that_pdf_states(model, ggx):
    rng = np.random.default_rng(3)
    for source in (model, ggx):
        for dtype in (np.float32, np.float64):
            wo, u = hemisphere(20_000).astype(dtype), rng.random((20_000, 2)).astype(dtype)
            wi, pdf = source.sample_wi(wo, u)
            assert wi.dtype == pdf.dtype == dtype
            again = source.pdf(wi, wo)
            drawn = pdf > 0
            assert drawn.mean() > 0.98
            # rounding may put a draw on the far side of a cell's border
            assert (abs(again[drawn] / pdf[drawn] - 1) < 1e-2).mean() > 0.995
            np.testing.assert_allclose(np.linalg.norm(wi[drawn], axis=1), 1, rtol=1e-4)


def test_draws_estimate_the_albedo(model):
    wo = np.array([0.5, 0, np.sqrt(0.75)])
    wi, pdf = model.sample_wi(wo, np.random.default_rng(1).random((100_000, 2)))
    weight = model.eval(wi, wo) * wi[:, 2:] / np.where(pdf > 0, pdf, np.inf)[:, None]
    # reciprocal: what is sent to wo is what is received from it
    np.testing.assert_allclose(weight.mean(axis=0), burnish.directional_albedo(model, wo), rtol=0.01)


def test_nothing_is_drawn_for_a_viewer_below_the_horizon(model):
    for dtype in (np.float32, np.float64):
        down = np.array([[0, 0.6, -0.8]], dtype)
        wi, pdf = model.sample_wi(down, np.array([[0.3, 0.7]], dtype))
        assert pdf[0] == 0 and np.isfinite(wi).all()
        assert model.pdf(np.array([[0, 0, 1]], dtype), down)[0] == 0


def test_threads_share_a_source_and_run_beside_each_other():
    source = burnish.open_source(GGX)  # its tables are not made yet
    wi, wo = hemisphere(50_000, 1), hemisphere(50_000, 2)
    results = [None] * 4

    def work(i):
        results[i] = source.eval(wi, wo), source.pdf(wi, wo)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
    for t in threads:
        t.start()
    for t in threads:
        t.join()
    for f, pdf in results[1:]:
        np.testing.assert_array_equal(f, results[0][0])
        np.testing.assert_array_equal(pdf, results[0][1])
