#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A Mitsuba scene with a burnish material: mitsuba_scene.py paint.burnish [-o scene.png] [--samples N].

The material is on a sphere under a window and a dim sky. Needs `pip install burnish mitsuba`. Prints the mean
of the picture, and how far it is from a picture of the same scene with half as many samples: its noise."""
import argparse

import mitsuba as mi


def scene_of(model, size):
    """What Mitsuba draws: any shape takes a BSDF of type `burnish`, wrapped where both sides are seen."""
    place = mi.ScalarTransform4f
    return mi.load_dict({
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 4},
        "sensor": {"type": "perspective", "fov": 30, "to_world": place().look_at([0, 0.6, 5], [0, 0, 0], [0, 1, 0]),
                   "film": {"type": "hdrfilm", "width": size, "height": size}},
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": [0.25, 0.3, 0.35]}},
        "window": {"type": "rectangle", "to_world": place().look_at([-3, 3, 3], [0, 0, 0], [0, 1, 0]).scale(0.8),
                   "emitter": {"type": "area", "radiance": {"type": "rgb", "value": [14, 13, 12]}}},
        "floor": {"type": "rectangle", "to_world": place().translate([0, -1, 0]).rotate([1, 0, 0], -90).scale(6),
                  "material": {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.4}}},
        "ball": {"type": "sphere", "material": {"type": "twosided", "inner": {"type": "burnish", "filename": model}}},
    })


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split(":")[0])
    arguments.add_argument("model")
    arguments.add_argument("-o", "--output", default="scene.png")
    arguments.add_argument("--samples", type=int, default=128)
    arguments.add_argument("--size", type=int, default=256)
    arguments.add_argument("--variant", default="llvm_ad_rgb", help="or cuda_ad_rgb, scalar_rgb")
    given = arguments.parse_args()

    mi.set_variant(given.variant)
    import burnish.mitsuba  # after the variant, which it compiles its code for
    burnish.mitsuba.register()

    scene = scene_of(given.model, given.size)
    fine = mi.render(scene, spp=given.samples, seed=1)
    coarse = mi.render(scene, spp=max(given.samples // 2, 1), seed=2)
    mi.util.write_bitmap(given.output, fine)
    import numpy as np
    fine, coarse = np.array(fine), np.array(coarse)
    print(f"{given.output}: mean {fine.mean():.4f}, noise {np.sqrt(((fine - coarse) ** 2).mean()):.4f}")


if __name__ == "__main__":
    main()
