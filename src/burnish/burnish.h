// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The public door: what these headers declare is what programs may rely on; docs/api.md shows it at a glance. They
/// need the C++20 standard library and nothing else.

// A BRDF in: from a file, a spec or a program's own type; out again in another format.
#include <burnish/error.h>
#include <burnish/io/convert.h>
#include <burnish/io/open_source.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/brdf.h>
#include <burnish/source.h>

// A factored model of it, its file, and how far it is from the original.
#include <burnish/factors/compact_file.h>
#include <burnish/factors/factored_brdf.h>
#include <burnish/factors/model_file.h>
#include <burnish/factors/model_spec.h>
#include <burnish/factors/table_gradient.h>
#include <burnish/fitting/fit.h>
#include <burnish/fitting/fit_file.h>
#include <burnish/fitting/parametric/material_fit.h>
#include <burnish/metrics/error_figures.h>

// Many values and draws at a time.
#include <burnish/eval/factored_eval.h>
#include <burnish/eval/sampler_expression.h>
#include <burnish/eval/tabulated_sampler.h>
#include <burnish/formula/graph.h>

// Surfaces: lobes whose scales are maps, from registered pictures.
#include <burnish/capture/surface_fit.h>
#include <burnish/eval/spatial_eval.h>
#include <burnish/surface/surface_file.h>

// Shaders, textures, and all that a model can be exported as.
#include <burnish/export/export_model.h>
#include <burnish/shaders/shader.h>
#include <burnish/textures/ktx2.h>

// Pictures of a material on a mesh.
#include <burnish/image/png.h>
#include <burnish/render/cpu_renderer.h>
#include <burnish/render/mesh/shapes.h>
#include <burnish/render/picture.h>

// Whole libraries of materials.
#include <burnish/library/batch.h>

// Glossy highlights without pow.
#include <burnish/eval/power_span.h>
#include <burnish/power/power.h>
