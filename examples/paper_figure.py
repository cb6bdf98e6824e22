#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A figure for a paper: a BRDF, its factored model, and where they differ.

    examples/paper_figure.py                                # a brushed metal, built in
    examples/paper_figure.py paint.binary --budget 2700 -o figure.pdf

Left: polar plots of the plane of incidence; right: lit spheres and the error between them.
"""

import argparse

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import burnish

LIGHTS = np.radians([0, 30, 60])


def direction(theta, phi=0.0):
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)


def plot_slice(axes, source, model, theta_i):
    """f_r in the plane of incidence; the light at theta_i on the left, its mirror direction on the right."""
    theta_o = np.radians(np.linspace(-89, 89, 713))
    wi, wo = direction(theta_i, np.pi), direction(theta_o)
    for brdf, style in ((source, dict(color="0.1", lw=1.6)), (model, dict(color="C3", lw=1.2, ls="--"))):
        axes.plot(theta_o, np.log10(1 + 100 * np.nanmean(brdf.eval(wi, wo), axis=1)), **style)
    axes.plot([-theta_i, -theta_i], axes.get_ylim(), color="C1", lw=1)
    axes.set(theta_zero_location="N", theta_direction=-1, thetamin=-90, thetamax=90, yticklabels=[])
    axes.set_title(f"light at {np.degrees(theta_i):.0f}°", fontsize=9)


def shown(image, exposure):
    return np.clip(exposure * image[..., :3], 0, 1) ** (1 / 2.2)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("brdf", nargs="?", default="ggx:alpha_x=0.12,alpha_y=0.35,f0=0.95/0.75/0.4,kd=0.02")
    parser.add_argument("--budget", type=int, default=0, help="bytes of the model; 0: one lobe")
    parser.add_argument("-o", "--output", default="paper_figure.png")
    arguments = parser.parse_args()

    source = burnish.open_source(arguments.brdf)
    model = burnish.fit(source, budget=arguments.budget)
    error = burnish.error_figures(source, model)

    figure = plt.figure(figsize=(8.4, 5.6), layout="constrained")
    grid = figure.add_gridspec(3, 4, width_ratios=[1.6, 1, 1, 1])
    pictures = [[burnish.render_sphere(brdf, light, 192) for brdf in (source, model)] for light in LIGHTS]
    heat_axes = []
    lit = np.concatenate([reference[reference > 0].ravel() for reference, _ in pictures])
    exposure = 1 / np.percentile(lit, 97)
    for row, (light, (reference, fitted)) in enumerate(zip(LIGHTS, pictures)):
        plot_slice(figure.add_subplot(grid[row, 0], projection="polar"), source, model, max(light, np.radians(5)))
        a, b = shown(reference, exposure), shown(fitted, exposure)
        for column, (picture, title) in enumerate(((a, "reference"), (b, "model"))):
            axes = figure.add_subplot(grid[row, column + 1])
            axes.imshow(np.broadcast_to(picture, picture.shape[:2] + (3,)))
            axes.set_axis_off()
            axes.set_title(title if row == 0 else "", fontsize=9)
        axes = figure.add_subplot(grid[row, 3])
        heat = axes.imshow(abs(a - b).mean(axis=2), cmap="magma", vmin=0, vmax=0.1)
        axes.set_axis_off()
        axes.set_title("difference" if row == 0 else "", fontsize=9)
        heat_axes.append(axes)
    figure.colorbar(heat, ax=heat_axes, fraction=0.05, aspect=40)
    figure.suptitle(
        f"{model.expression}, {model.bytes} bytes: PSNR {error.psnr:.1f} dB, SSIM {error.ssim:.3f}, "
        f"relative error {100 * error.relative:.1f} %",
        fontsize=10,
    )
    figure.savefig(arguments.output, dpi=160)
    print(f"psnr {error.psnr:.2f} dB, ssim {error.ssim:.4f}, {model.bytes} bytes: {arguments.output}")


if __name__ == "__main__":
    main()
