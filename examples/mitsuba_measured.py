#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renders a measurement of the RGL database by Mitsuba's own `measured` plug-in and as a burnish model.

    examples/mitsuba_measured.py vch_silk_blue_rgb.bsdf --budget 2700 -o comparison.png

Prints the PSNR between the two, after exposure and the power 1/2.2, and writes both pictures and their difference
(five times enhanced) side by side.
"""

import argparse
import os
import tempfile
import time

import mitsuba as mi
import numpy as np

import burnish


def scene(bsdf, size):
    light = lambda origin, radiance: {
        "type": "sphere",
        "to_world": mi.ScalarTransform4f().translate(origin).scale(0.4),
        "emitter": {"type": "area", "radiance": {"type": "rgb", "value": radiance}},
    }
    return mi.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "path", "max_depth": 3},
            "sensor": {
                "type": "perspective",
                "fov": 26,
                "to_world": mi.ScalarTransform4f().look_at([0, 0, 5], [0, 0, 0], [0, 1, 0]),
                "film": {"type": "hdrfilm", "width": size, "height": size},
            },
            "sky": {"type": "constant", "radiance": {"type": "rgb", "value": [0.3, 0.35, 0.4]}},
            "key": light([-2.5, 2.5, 3.5], [30, 28, 25]),
            "rim": light([3, 0.5, -1.5], [20, 22, 30]),
            "shape": {"type": "sphere", "bsdf": bsdf},
        }
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("measurement", help="an isotropic RGB file of the RGL database")
    parser.add_argument("--budget", type=int, default=2700, help="bytes of the model")
    parser.add_argument("--no-symmetrize", action="store_true", help="fit the measurement as it is")
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--size", type=int, default=320)
    parser.add_argument("--variant", default="llvm_ad_rgb")
    parser.add_argument("-o", "--output", default="mitsuba_measured.png")
    arguments = parser.parse_args()

    mi.set_variant(arguments.variant)
    import burnish.mitsuba

    burnish.mitsuba.register()
    source = burnish.open_source(arguments.measurement)
    model = burnish.fit(
        source, budget=arguments.budget, symmetrize=not arguments.no_symmetrize, target="function"
    )
    images = []
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "model.exr")
        burnish.write_model(path, model)
        for bsdf in (
            {"type": "measured", "filename": arguments.measurement},
            {"type": "burnish", "filename": path},
        ):
            start = time.perf_counter()
            images.append(np.array(mi.render(scene(bsdf, arguments.size), spp=arguments.spp)))
            print(f"{bsdf['type']:<9} {time.perf_counter() - start:6.2f} s")
    exposure = 1 / np.percentile(images[0], 97)
    a, b = (np.clip(exposure * image, 0, 1) ** (1 / 2.2) for image in images)
    psnr = -10 * np.log10(np.mean(np.square(a - b)))
    print(f"psnr {psnr:.2f} dB with {model.bytes} bytes ({os.path.getsize(arguments.measurement)} in the file)")
    picture = np.hstack([a, b, np.clip(5 * abs(a - b), 0, 1)])
    mi.Bitmap((255 * picture + 0.5).astype(np.uint8)).write(arguments.output)


if __name__ == "__main__":
    main()
