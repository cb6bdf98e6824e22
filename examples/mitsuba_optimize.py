#!/usr/bin/env python3
"""Fits a model's tables to a rendered picture by gradient descent through Mitsuba 3.

    examples/mitsuba_optimize.py -o recovered.exr

The target is a picture of a sphere under three lights, its material Mitsuba's own rough conductor; the start is a
grey model of 592 bytes. Prints the loss as it falls, and writes the model that reproduces the picture.
"""

import argparse
import os
import tempfile

import drjit as dr
import mitsuba as mi
import numpy as np

import burnish

TARGET = {"type": "roughconductor", "material": "Au", "distribution": "ggx", "alpha": 0.25}
START = "ggx:alpha_x=0.6,alpha_y=0.6,f0=0.5"


def scene(bsdf, size):
    lights = {
        f"light{i}": {"type": "directional", "direction": direction, "irradiance": 3.0}
        for i, direction in enumerate(([0, 0, -1], [-0.5, -0.2, -0.85], [0.9, 0.1, -0.45]))
    }
    return mi.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "direct"},
            "sensor": {
                "type": "orthographic",
                "to_world": mi.ScalarTransform4f().look_at([0, 0, 5], [0, 0, 0], [0, 1, 0]),
                "film": {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"}},
            },
            "shape": {"type": "sphere", "bsdf": bsdf},
            **lights,
        }
    )


def optimize(target, start, steps, size=96, spp=8, lr=0.05, report=print):
    """Adam on the logarithms of all tables; returns the losses and the scene."""
    parameters = mi.traverse(start)
    keys = [key for key in parameters.keys() if key.endswith(".log_values")]
    optimizer = mi.ad.Adam(lr=lr)
    for key in keys:
        optimizer[key] = parameters[key]
    losses = []
    for step in range(steps):
        parameters.update(optimizer)
        image = mi.render(start, parameters, spp=spp, seed=step)
        loss = dr.mean(dr.square(dr.log(1 + image) - dr.log(1 + target)), axis=None)
        dr.backward(loss)
        optimizer.step()
        losses.append(float(loss.array[0]))
        if step % 20 == 0 or step == steps - 1:
            report(f"step {step:4d}  loss {losses[-1]:.6f}")
    parameters.update(optimizer)
    return losses


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--steps", type=int, default=200)
    parser.add_argument("--size", type=int, default=96)
    parser.add_argument("--variant", default="llvm_ad_rgb")
    parser.add_argument("-o", "--output", default="recovered.exr")
    arguments = parser.parse_args()

    mi.set_variant(arguments.variant)
    import burnish.mitsuba

    burnish.mitsuba.register()
    target = mi.TensorXf(np.array(mi.render(scene(TARGET, arguments.size), spp=64)))
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "start.exr")
        burnish.write_model(path, burnish.fit(burnish.open_source(START)))
        start = scene({"type": "burnish", "filename": path}, arguments.size)
    losses = optimize(target, start, arguments.steps, arguments.size)
    bsdf = start.shapes()[0].bsdf()
    burnish.write_model(arguments.output, bsdf.factors.current_model())
    print(f"loss {losses[0]:.6f} -> {losses[-1]:.6f} ({losses[0] / losses[-1]:.0f} times smaller): {arguments.output}")


if __name__ == "__main__":
    main()
