# SPDX-License-Identifier: Apache-2.0
"""PyTorch's tensors in and out, and gradients with respect to tables (examples/torch_tables.py)."""
import importlib.util
import pathlib
import subprocess
import sys

import numpy as np
import pytest

import burnish

torch = pytest.importorskip("torch")
EXAMPLE = pathlib.Path(__file__).resolve().parents[2] / "examples/torch_tables.py"


@pytest.fixture(scope="module")
def example():
    spec = importlib.util.spec_from_file_location("torch_tables", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def pairs(example):
    return example.drawn_pairs(50, torch.Generator().manual_seed(7))


@pytest.mark.parametrize("kind", [torch.float32, torch.float64])
def test_tensors_are_read_and_written_where_they_lie(model, pairs, kind):
    wi, wo = (w.to(kind) for w in pairs)
    expected = model.eval(wi.numpy(), wo.numpy())
    f = model.eval(wi, wo)
    assert isinstance(f, np.ndarray) and f.dtype == expected.dtype
    np.testing.assert_array_equal(f, expected)
    out = torch.zeros((len(wi), model.channels), dtype=kind)
    address = out.data_ptr()
    assert model.eval(wi, wo, out=out) is out and out.data_ptr() == address
    np.testing.assert_array_equal(out.numpy(), expected)
    # columns of a wider tensor, without a copy
    wide = torch.zeros((len(wi), 8), dtype=kind)
    wide[:, 2:5], wide[:, 5:8] = wi, wo
    np.testing.assert_array_equal(model.eval(wide[:, 2:5], wide[:, 5:8]), expected)


def test_no_gradient_goes_through_eval(model, pairs):
    wi, wo = pairs
    differentiated = wi.clone().requires_grad_()
    # Arrays of one type are read where they lie; a list beside them makes NumPy ask torch, which refuses.
    f = model.eval(differentiated, wo)
    assert isinstance(f, np.ndarray)
    np.testing.assert_array_equal(f, model.eval(wi, wo))
    with pytest.raises(TypeError, match="^wi: expected an array of real numbers, found Tensor: .*requires grad"):
        model.eval(differentiated, [0, 0, 1])


def test_gradients_by_tables_are_difference_quotients(example, model, pairs):
    logs = example.log_tables_of(model)
    weights = torch.linspace(0.5, 2, len(pairs[0]) * model.channels, dtype=torch.float64).reshape(-1, model.channels)
    (example.Values.apply(model, *pairs, *logs) * weights).sum().backward()

    def weighted(tables):
        changed = model.with_log_tables([t.detach().numpy() for t in tables], format="float")
        return float((torch.from_numpy(changed.eval(*pairs)) * weights).sum())

    generator = torch.Generator().manual_seed(3)
    for k, log in enumerate(logs):
        # Along a random direction, the quotient is the product of gradient and direction.
        along = torch.randn(log.shape, dtype=torch.float64, generator=generator)
        step = 1e-3

        def moved(distance):
            return [t + distance * along if i == k else t for i, t in enumerate(logs)]

        quotient = (weighted(moved(step)) - weighted(moved(-step))) / (2 * step)
        slope = float((log.grad * along).sum())
        assert slope == pytest.approx(quotient, rel=1e-3, abs=1e-4 * weighted(logs))
        assert log.grad.abs().max() > 0


def test_the_example_lowers_its_loss(tmp_path):
    made = subprocess.run(
        [sys.executable, str(EXAMPLE), "ggx:alpha_x=0.3,alpha_y=0.3", "--budget", "700", "--samples", "20000",
         "--steps", "60", "-o", str(tmp_path / "learned.exr")],
        capture_output=True, text=True, check=True).stdout
    words = made.split()
    assert float(words[words.index("after") - 1]) < 0.9 * float(words[words.index("before,") - 1]), made
    assert burnish.open_source(str(tmp_path / "learned.exr")).bytes <= 700
