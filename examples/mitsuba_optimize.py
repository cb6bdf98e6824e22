#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
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
                # the frame lies within the sphere: no silhouette, whose pixels are noise
                "to_world": mi.ScalarTransform4f().look_at([0, 0, 5], [0, 0, 0], [0, 1, 0]).scale([0.7, 0.7, 1]),
                "film": {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"}},
            },
            "shape": {"type": "sphere", "bsdf": bsdf},
            **lights,
        }
    )


def difference(image, target):
    # linear in the picture, so that its noise does not shift the gradient's mean
    return dr.mean(dr.square((image - target) / (target + 0.1)), axis=None)


def optimize(start, target, steps, report=print):
    """Adam on the logarithms of all tables of the scene."""
    parameters = mi.traverse(start)
    optimizer = mi.ad.Adam(lr=0.05)
    for key in parameters.keys():
        if key.endswith(".log_values"):
            optimizer[key] = parameters[key]
    for step in range(steps):
        parameters.update(optimizer)
        loss = difference(mi.render(start, parameters, spp=32, seed=step), target)
        dr.backward(loss)
        optimizer.step()
        if step % 20 == 0:
            report(f"step {step:4d}  loss {loss.array[0]:.5f}")
    parameters.update(optimizer)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--steps", type=int, default=150)
    parser.add_argument("--size", type=int, default=96)
    parser.add_argument("--variant", default="llvm_ad_rgb")
    parser.add_argument("-o", "--output", default="recovered.exr")
    arguments = parser.parse_args()

    mi.set_variant(arguments.variant)
    import burnish.mitsuba

    burnish.mitsuba.register()
    picture = lambda of: mi.TensorXf(np.array(mi.render(of, spp=512, seed=1000)))
    target = picture(scene(TARGET, arguments.size))
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "start.exr")
        burnish.write_model(path, burnish.fit(burnish.open_source(START)))
        start = scene({"type": "burnish", "filename": path}, arguments.size)
    before = difference(picture(start), target).array[0]
    optimize(start, target, arguments.steps)
    after = difference(picture(start), target).array[0]
    burnish.write_model(arguments.output, start.shapes()[0].bsdf().factors.current_model())
    print(f"loss at 512 samples a pixel: {before:.5f} -> {after:.5f}, {before / after:.0f} times smaller")


if __name__ == "__main__":
    main()
