# SPDX-License-Identifier: Apache-2.0
"""BRDFs as a few small positive tables: read, fit, evaluate, sample and compare.

    paint = burnish.open_source("paint.binary")
    model = burnish.fit(paint, budget=2700)
    f = model.eval(wi, wo)                 # (N, 3) arrays of unit vectors -> (N, channels), 1/sr
    wi, pdf = model.sample_wi(wo, u)
    print(burnish.error_figures(paint, model).psnr)
    burnish.write_model("paint.exr", model)

    burnish.Source.from_samples(wi, wo, values)    # measured values, as arrays or lists
    burnish.Source.from_function(f)                # f(wi, wo) on arrays

Directions are in the local frame of the surface: normal (0, 0, 1), tangent (1, 0, 0); wi points to the light,
wo to the viewer. Functions are named as in C++ and on the command line; angles are radians.
"""

from ._burnish import (
    Baseline,
    Batch,
    Book,
    Error,
    ErrorFigures,
    FactorUse,
    Lobe,
    Model,
    PlacedTable,
    Shader,
    ShaderTexture,
    Source,
    Surface,
    Table,
    ThreadLimit,
    batch,
    book,
    compare_models,
    conserve_energy,
    convert,
    directional_albedo,
    draw_pairs,
    error_figures,
    export,
    fit,
    fit_material,
    fit_surface,
    generate_shader,
    measure,
    next_measurements,
    open_book,
    open_source,
    open_surface,
    render_sphere,
    write_ktx2,
    write_model,
)

__all__ = [name for name in dir() if not name.startswith("_")]
