# SPDX-License-Identifier: Apache-2.0
"""The BSDF plugin `burnish` of Mitsuba 3: a factored BRDF from its native file, or OpenPBR.

    import mitsuba as mi
    mi.set_variant("llvm_ad_rgb")
    import burnish.mitsuba
    burnish.mitsuba.register()
    bsdf = mi.load_dict({"type": "burnish", "filename": "paint.exr"})
    coat = mi.load_dict({"type": "burnish", "filename": "openpbr:coat_weight=1"})

OpenPBR is a spec as above, or a file that `burnish fit --to openpbr` writes. Its formulas are OpenPBR's own.

In the JIT variants (llvm_*_rgb, cuda_*_rgb) evaluation, sampling and densities are compiled with the scene. The
logarithms of the tables are differentiable parameters: `p.log_values` of table p is a tensor of the shape of its
values. scalar_rgb calls the C++ library, one direction at a time.

Mitsuba's si.wi points to the viewer: it is the library's wo, and Mitsuba's wo is the library's wi. The difference shows
only in models that are not reciprocal. Mitsuba's own `measured` takes si.wi for the first direction of a file, which
is our wi. A model of that file must look like it, so the directions are exchanged when the value is looked up. With
`"exchange": False` they are not exchanged, and the value is that of light from Mitsuba's wo. This is OpenPBR's default.
"""

import drjit as dr
import mitsuba as mi
import numpy as np

from . import Error, Model, open_source
from .mitsuba_spatial import make_bsdf_class as _make_spatial_class


def register():
    """Registers `burnish` and `burnish_spatial` with the present variant. Call it again after setting another one."""
    if not mi.is_rgb:
        raise Error(f"mitsuba: expected an rgb variant, found '{mi.variant()}'")
    mi.register_bsdf("burnish", _make_bsdf_class())
    mi.register_bsdf("burnish_spatial", _make_spatial_class(Formula, CompiledSampler))


def _make_bsdf_class():
    # mi.BSDF is a different class in every variant.
    class BurnishBsdf(mi.BSDF):
        def __init__(self, props):
            super().__init__(props)
            self.model = _opened(str(props["filename"]))
            self.exchange = props.get("exchange", isinstance(self.model, Model))
            kind = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide
            if not self.model.isotropic:
                kind |= mi.BSDFFlags.Anisotropic
            self.m_components = [kind]
            self.m_flags = kind
            self.factors = self.sampler = None
            if dr.is_jit_v(mi.Float):
                self.factors = BrdfFunction(self.model)
                self.sampler = CompiledSampler(self.model)

        def traverse(self, callback):
            if self.factors:
                for name, values in self.factors.log_values.items():
                    callback.put(f"{name}.log_values", values, mi.ParamFlags.Differentiable)

        def parameters_changed(self, keys=()):
            if self.factors:
                self.factors.update()

        def eval(self, ctx, si, wo, active=True):
            return self.eval_pdf(ctx, si, wo, active)[0]

        def pdf(self, ctx, si, wo, active=True):
            return self.eval_pdf(ctx, si, wo, active)[1]

        def eval_pdf(self, ctx, si, wo, active=True):
            active = self._enabled(ctx, active) & (si.wi.z > 0) & (wo.z > 0)
            if self.factors:
                f, pdf = self._value(wo, si.wi), self.sampler.pdf(dr.detach(wo), dr.detach(si.wi))
            else:
                to_light, to_viewer = np.array(wo, dtype=np.float32), np.array(si.wi, dtype=np.float32)
                f = mi.Color3f(*np.broadcast_to(self._value(to_light, to_viewer), 3))
                pdf = float(self.model.pdf(to_light, to_viewer))
            return dr.select(active, f * wo.z, 0), dr.select(active, pdf, 0)

        def sample(self, ctx, si, sample1, sample2, active=True):
            active = self._enabled(ctx, active) & (si.wi.z > 0)
            drawn = dr.zeros(mi.BSDFSample3f)
            if self.factors:
                drawn.wo, drawn.pdf = self.sampler.sample_wi(dr.detach(si.wi), sample2)
            else:
                wo, pdf = self.model.sample_wi(
                    np.array(si.wi, dtype=np.float64), np.array(sample2, dtype=np.float64)
                )
                drawn.wo, drawn.pdf = mi.Vector3f(*wo), float(pdf)
            drawn.eta = 1
            drawn.sampled_type = mi.UInt32(int(self.m_flags))
            drawn.sampled_component = mi.UInt32(0)
            active &= drawn.pdf > 0
            value = self.eval(ctx, si, drawn.wo, active)
            return drawn, dr.select(active, value / drawn.pdf, 0)

        def _value(self, to_light, to_viewer):
            first, second = (to_viewer, to_light) if self.exchange else (to_light, to_viewer)
            return (self.factors or self.model).eval(first, second)

        def _enabled(self, ctx, active):
            return mi.Bool(active) & ctx.is_enabled(mi.BSDFFlags.GlossyReflection, 0)

        def to_string(self):
            if isinstance(self.model, Model):
                return f"BurnishBsdf[{self.model.expression}, {self.model.bytes} bytes]"
            return f"BurnishBsdf[{self.model.name}]"

    return BurnishBsdf


def _opened(name):
    path = name if name.partition(":")[0] == "openpbr" else str(mi.file_resolver().resolve(name))
    source = open_source(path)
    if not isinstance(source, Model):
        source._eval_graph()  # raises an Error that says what it expects
    elif source.lambda_nm or source.channels not in (1, 3):
        raise Error(f"{path}: expected a burnish model of 1 or 3 channels, found {source!r}")
    return source


class BrdfFunction:
    """A factored BRDF, or OpenPBR, in Dr.Jit: f_r in 1/sr without the cosine, differentiable in `log_values`."""

    def __init__(self, model):
        self.model = model
        graph, self.textures = model._eval_graph()
        self.formula = Formula(graph)
        self.tables = model.tables if isinstance(model, Model) else []
        self.log_values = {t.name: mi.TensorXf(np.log(t.values)) for t in self.tables}
        self.update()

    def update(self):
        """Updates the tables. Call it after log_values changed."""
        self.values = {
            name: (self.tables[i].values.shape[-2], dr.exp(self.log_values[self.tables[i].name].array))
            for name, i in self.textures.items()
        }

    def current_model(self):
        """Returns the model with its present tables, rounded to their formats. Requires a factored BRDF."""
        return self.model.with_log_tables([np.array(v, dtype=np.float64) for v in self.log_values.values()])

    def eval(self, wi, wo):
        return mi.Color3f(self.formula(wi=wi, wo=wo, **self.values)[0])


class CompiledSampler:
    """TabulatedSampler in Dr.Jit."""

    def __init__(self, source):
        graphs = source._sampler_graphs()
        self.draw, self.density = Formula(graphs["sample_wi"]), Formula(graphs["pdf"])
        self.edges = {name: mi.UInt32(graphs[name]) for name in ("row_edges", "cell_edges")}

    def sample_wi(self, wo, u):
        """Returns the direction to the light for the sample position u, and its density in 1/sr."""
        x, y, z, pdf = self.draw(wo_x=wo.x, wo_y=wo.y, wo_z=wo.z, u_x=u.x, u_y=u.y, **self.edges)
        return mi.Vector3f(x, y, z), pdf

    def pdf(self, wi, wo):
        """Returns the density of wi under sample_wi in 1/sr; zero below the horizon."""
        return self.density(wi_x=wi.x, wi_y=wi.y, wi_z=wi.z, wo_x=wo.x, wo_y=wo.y, wo_z=wo.z, **self.edges)[0]


class Formula:
    """One of the library's expression graphs, evaluated by Dr.Jit."""

    OPERATIONS = {
        "add": lambda a, b: a + b,
        "subtract": lambda a, b: a - b,
        "multiply": lambda a, b: a * b,
        "divide": lambda a, b: a / b,
        "mul_add": lambda a, b, c: a * b + c,
        "neg_mul_add": lambda a, b, c: c - a * b,
        "negate": lambda a: -a,
        "abs": lambda a: abs(a),
        "max": lambda a, b: dr.maximum(a, b),
        "min": lambda a, b: dr.minimum(a, b),
        "if_less": lambda a, b, less, other: dr.select(a < b, less, other),
        "floor": lambda a: dr.floor(a),
        "sqrt": lambda a: dr.sqrt(a),
        "power": lambda a, b: a**b,
        "exp2": lambda a: dr.exp2(a),
        "acos": lambda a: dr.acos(a),
        "cos": lambda a: dr.cos(a),
        "vector": lambda x, y, z: mi.Color3f(x, y, z),
        "to_integer": lambda a: mi.Int32(a),
        "to_real": lambda a: mi.Float(a),
    }

    def __init__(self, graph):
        self.nodes, self.outputs = graph

    def __call__(self, **inputs):
        """Returns the outputs. `inputs` are numbers and integer arrays by name; a texture is (width, texels)."""
        values = []
        for operation, kind, constant, name, arguments in self.nodes:
            a = [values[i] for i in arguments]
            if operation == "constant":
                value = mi.Int32(int(constant)) if kind == "integer" else mi.Float(constant)
            elif operation == "input":
                value = inputs[name]
            elif operation == "component":
                value = a[0][int(constant)]
            elif operation == "element":
                value = mi.Int32(dr.gather(mi.UInt32, inputs[name], mi.UInt32(a[0])))
            elif operation == "texel":
                width, texels = inputs[name]
                node_type = mi.Color3f if kind == "vector" else mi.Float
                value = dr.gather(node_type, texels, mi.UInt32(a[1] * width + a[0]))
            else:
                value = self.OPERATIONS[operation](*a)
            values.append(value)
        return [values[i] for i in self.outputs]
