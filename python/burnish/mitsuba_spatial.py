# SPDX-License-Identifier: Apache-2.0
"""The BSDF plugin `burnish_spatial` of Mitsuba 3: a surface from its .burnish file, over meshes' texture coordinates.

    import burnish.mitsuba
    burnish.mitsuba.register()
    bsdf = mi.load_dict({"type": "burnish_spatial", "filename": "wall.burnish"})

It needs a JIT variant. Weights and normals are looked up at si.uv (v upwards) with linear filters, and lobes are
evaluated by the library's formulas. Directions are drawn as for the mean of all texels. The surface's tangent is
Mitsuba's, along dp_du. `exchange` means the same as for `burnish`.
"""

import drjit as dr
import mitsuba as mi
import numpy as np

from . import Error, open_surface


def make_bsdf_class(formula_type, sampler_type):
    # mi.BSDF is a different class in every variant.
    class SpatialBsdf(mi.BSDF):
        def __init__(self, props):
            super().__init__(props)
            path = str(mi.file_resolver().resolve(props["filename"]))
            if not dr.is_jit_v(mi.Float):
                raise Error(f"{path}: expected a JIT variant with a surface, found '{mi.variant()}'")
            self.surface = open_surface(path)
            self.exchange = props.get("exchange", True)
            kind = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide
            kind |= mi.BSDFFlags.SpatiallyVarying | mi.BSDFFlags.Anisotropic
            self.m_components = [kind]
            self.m_flags = kind
            self.sampler = sampler_type(self.surface.at(0, 0, 64))
            self._take_lobes(formula_type)
            self._take_maps()

        def _take_lobes(self, formula_type):
            lobes = self.surface.lobes
            graph, textures = lobes._lobe_graph()
            self.lobes = formula_type(graph)
            tables = lobes.tables
            # The arrays are copies, since Mitsuba keeps them until the process ends, and a view would keep its model.
            self.values = {
                name: (tables[i].values.shape[-2], mi.Float(tables[i].values.flatten())) for name, i in textures.items()
            }

        def _take_maps(self):
            """Puts all maps into one texture, and keeps the columns where they begin."""
            maps = list(self.surface.weights)
            self.widths = [m.shape[-1] for m in maps]
            self.vectors = {}
            for name in ("normals", "tangents"):
                values = getattr(self.surface, name)
                if values is not None:
                    self.vectors[name] = sum(m.shape[-1] for m in maps)
                    maps.append(values)
            texels = np.ascontiguousarray(np.concatenate(maps, axis=-1))
            self.maps = mi.Texture2f(mi.TensorXf(texels), wrap_mode=dr.WrapMode.Repeat)

        def _place(self, si, active):
            """Returns the weights of the lobes, and the texel's tangent, bitangent and normal in the shading frame."""
            read = self.maps.eval(mi.Point2f(si.uv.x, 1 - si.uv.y), active)
            weights, first = [], 0
            for width in self.widths:
                weights.append(mi.Color3f(*read[first : first + 3]) if width == 3 else mi.Color3f(read[first]))
                first += width
            n, t = mi.Vector3f(0, 0, 1), mi.Vector3f(1, 0, 0)
            if "normals" in self.vectors:
                x, y = read[self.vectors["normals"]], read[self.vectors["normals"] + 1]
                n = dr.normalize(mi.Vector3f(x, y, dr.safe_sqrt(1 - x * x - y * y)))
            if "tangents" in self.vectors:
                t = mi.Vector3f(read[self.vectors["tangents"]], read[self.vectors["tangents"] + 1], 0)
            t = dr.normalize(t - dr.dot(t, n) * n)
            return weights, mi.Frame3f(t, dr.cross(n, t), n)

        def eval(self, ctx, si, wo, active=True):
            return self.eval_pdf(ctx, si, wo, active)[0]

        def pdf(self, ctx, si, wo, active=True):
            return self.eval_pdf(ctx, si, wo, active)[1]

        def eval_pdf(self, ctx, si, wo, active=True):
            active = self._enabled(ctx, active) & (si.wi.z > 0) & (wo.z > 0)
            weights, frame = self._place(si, active)
            light, viewer = frame.to_local(wo), frame.to_local(si.wi)
            active &= (light.z > 0) & (viewer.z > 0)
            first, second = (viewer, light) if self.exchange else (light, viewer)
            f = mi.Color3f(0)
            for weight, lobe in zip(weights, self.lobes(wi=first, wo=second, **self.values)):
                f += weight * lobe
            pdf = self.sampler.pdf(light, viewer)
            return dr.select(active, f * light.z, 0), dr.select(active, pdf, 0)

        def sample(self, ctx, si, sample1, sample2, active=True):
            active = self._enabled(ctx, active) & (si.wi.z > 0)
            _, frame = self._place(si, active)
            viewer = frame.to_local(si.wi)
            active &= viewer.z > 0
            drawn = dr.zeros(mi.BSDFSample3f)
            light, density = self.sampler.sample_wi(dr.detach(viewer), sample2)
            drawn.wo = frame.to_world(light)
            drawn.eta = 1
            drawn.sampled_type = mi.UInt32(int(self.m_flags))
            drawn.sampled_component = mi.UInt32(0)
            active &= (density > 0) & (drawn.wo.z > 0)
            # Evaluated anew: at the edge of a cell, rounding of the frames decides its cell, as in eval and pdf.
            value, drawn.pdf = self.eval_pdf(ctx, si, drawn.wo, active)
            active &= drawn.pdf > 0
            return drawn, dr.select(active, value / drawn.pdf, 0)

        def _enabled(self, ctx, active):
            return mi.Bool(active) & ctx.is_enabled(mi.BSDFFlags.GlossyReflection, 0)

        def to_string(self):
            return f"SpatialBsdf[{self.surface.width} x {self.surface.height}, {self.surface.bytes} bytes]"

    return SpatialBsdf
