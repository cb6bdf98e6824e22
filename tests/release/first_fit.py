# SPDX-License-Identifier: Apache-2.0
"""What someone does first with the Python package: fits a paint and evaluates the model."""
import importlib.metadata

import numpy

import burnish

paint = burnish.open_source("ggx:alpha_x=0.2,alpha_y=0.2,f0=0.8/0.4/0.2,kd=0.1")
model = burnish.fit(paint)
directions = numpy.random.default_rng(1).normal(size=(2, 100_000, 3))
directions[..., 2] = abs(directions[..., 2]) + 0.1
wi, wo = directions / numpy.linalg.norm(directions, axis=-1, keepdims=True)
error = abs(model.eval(wi, wo) / paint.eval(wi, wo) - 1).mean()
print(f"burnish {importlib.metadata.version('burnish')}: mean relative error of the first fit {error:.4f}")
assert error < 0.02
