"""The BSDF plugin `burnish` of Mitsuba 3: a factored BRDF from its native file.

    import mitsuba as mi
    mi.set_variant("llvm_ad_rgb")
    import burnish.mitsuba
    burnish.mitsuba.register()
    bsdf = mi.load_dict({"type": "burnish", "filename": "paint.exr"})

In the JIT variants (llvm_*_rgb, cuda_*_rgb) evaluation, sampling and densities are compiled with the scene, and the
logarithms of the tables are differentiable parameters: `p.log_values` of table p, a tensor of shape (height, width,
channels). scalar_rgb calls the C++ library, one direction at a time.

Mitsuba's si.wi points to the viewer: it is the library's wo, and Mitsuba's wo its wi.
"""

import drjit as dr
import mitsuba as mi
import numpy as np

from . import Error, Model, open_source


def register():
    """Makes `burnish` known to the variant that is set. Call it again after setting another."""
    if not mi.is_rgb:
        raise Error(f"mitsuba: expected an rgb variant, found '{mi.variant()}'")
    mi.register_bsdf("burnish", _make_bsdf_class())


def _make_bsdf_class():
    # mi.BSDF is another class in every variant
    class FactoredBsdf(mi.BSDF):
        def __init__(self, props):
            super().__init__(props)
            path = str(mi.file_resolver().resolve(props["filename"]))
            self.model = open_source(path)
            if not isinstance(self.model, Model) or self.model.lambda_nm or self.model.channels not in (1, 3):
                raise Error(f"{path}: expected a burnish model of 1 or 3 channels, found {self.model!r}")
            kind = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide
            if not self.model.isotropic:
                kind |= mi.BSDFFlags.Anisotropic
            self.m_components = [kind]
            self.m_flags = kind
            self.factors = self.sampler = None
            if dr.is_jit_v(mi.Float):
                self.factors = FactoredFunction(self.model)
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
                f, pdf = self.factors.eval(wo, si.wi), self.sampler.pdf(dr.detach(wo), dr.detach(si.wi))
            else:
                to_light, to_viewer = np.array(wo, dtype=np.float64), np.array(si.wi, dtype=np.float64)
                f = mi.Color3f(*np.broadcast_to(self.model.eval(to_light, to_viewer), 3))
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

        def _enabled(self, ctx, active):
            return mi.Bool(active) & ctx.is_enabled(mi.BSDFFlags.GlossyReflection, 0)

        def to_string(self):
            return f"FactoredBsdf[{self.model.expression}, {self.model.bytes} bytes]"

    return FactoredBsdf


class FactoredFunction:
    """FactoredBrdf::eval in Dr.Jit: f_r in 1/sr without the cosine, differentiable in `log_values`."""

    def __init__(self, model):
        self.model = model
        self.tables = model.tables
        self.lobes = [(list(lobe.scale), lobe.factors) for lobe in model.lobes]
        self.log_values = {t.name: mi.TensorXf(np.log(t.values)) for t in self.tables}
        self.update()

    def update(self):
        """Call after log_values changed."""
        self.values = [dr.exp(self.log_values[t.name].array) for t in self.tables]

    def current_model(self):
        """The model with the tables as they are now, rounded to their formats."""
        return self.model.with_log_tables([np.array(v, dtype=np.float64) for v in self.log_values.values()])

    def eval(self, wi, wo):
        sum = mi.Color3f(0)
        for scale, factors in self.lobes:
            product = mi.Color3f(*(scale if len(scale) == 3 else 3 * scale))
            for use in factors:  # [HomomorphicBrdf, eq. 4]
                product *= self._lookup(use, wi, wo)
            sum += product
        return sum

    def _lookup(self, use, wi, wo):
        table, values = self.tables[use.table], self.values[use.table]
        height, width, channels = table.values.shape
        node_type = mi.Color3f if channels == 3 else mi.Float
        if table.shape == "disk":
            w = _project(use.projection, wi, wo)
            t = _tan_half(w)
            stretch = dr.select(t > 0, _warp(table.warp, t) / t, 0) / (1 + w.z)
            (x, fx), (y, fy) = _cell(0.5 + 0.5 * w.x * stretch, width), _cell(0.5 + 0.5 * w.y * stretch, height)
        else:
            x, fx = _cell(_warp(table.warp, _project_tan_half(use.projection, wi, wo)), width)
            if table.shape == "grid":
                y, fy = _cell(_warp(table.warp_y, _project_tan_half(use.projection_y, wi, wo)), height)

        def row(first):
            low, high = (dr.gather(node_type, values, node) for node in (first, first + 1))
            return dr.lerp(low, high, fx)

        if table.shape == "line":
            return row(x)
        return dr.lerp(row(y * width + x), row((y + 1) * width + x), fy)


def _cell(u, count):
    """The cell of `count` nodes over [0, 1] that u falls into, and how far; the last cell takes u = 1."""
    position = dr.clip(u, 0, 1) * (count - 1)
    node = dr.minimum(mi.UInt32(position), count - 2)
    return node, position - mi.Float(node)


def _warp(warp, t):
    kind, parameter = warp
    if kind == "rational":
        return t * (1 + parameter) / (t + parameter)
    return t**parameter if kind == "power" else t


def _tan_half(w):
    return dr.sqrt(w.x * w.x + w.y * w.y) / (1 + w.z)


def _mirror(w):
    return mi.Vector3f(-w.x, -w.y, w.z)


def _twist(wi, wo):
    """tan(theta_t / 2) of parameterization/projection.h."""
    total, apart = wi + wo, wi - wo
    across = total.x * total.x + total.y * total.y
    square = across + total.z * total.z
    half = dr.maximum(across + square / 256, 1e-30)
    turn = apart.z * (total.y * apart.x - total.x * apart.y) * square
    return dr.clip(0.5 + 0.3247595264191645 * turn / half, 0, 1)


def _project(projection, wi, wo):
    """project() of parameterization/projection.h."""
    if projection == "twist":
        t = _twist(wi, wo)
        return dr.normalize(mi.Vector3f(2 * t, 0, 1 - t * t))
    if projection == "deviation":
        return mi.Vector3f(0.5 * dr.norm(_mirror(wi) - wo), 0, 0.5 * dr.norm(_mirror(wi) + wo))
    if projection == "difference":
        h = dr.normalize(wi + wo)
        sine = dr.sqrt(h.x * h.x + h.y * h.y)
        cos_phi, sin_phi = dr.select(sine > 0, h.x / sine, 1), dr.select(sine > 0, h.y / sine, 0)
        along, across = mi.Vector3f(h.z * cos_phi, h.z * sin_phi, -sine), mi.Vector3f(-sin_phi, cos_phi, 0)
        return dr.normalize(mi.Vector3f(dr.dot(wi, along), dr.dot(wi, across), 0.5 * dr.norm(wi + wo)))
    a, b, m, n = projection
    w = dr.normalize(a * wi + b * wo + m * _mirror(wi) + mi.Vector3f(0, 0, n))
    return dr.select(w.z >= 0, w, dr.normalize(mi.Vector3f(w.x, w.y, 0)))


def _project_tan_half(projection, wi, wo):
    """tan(theta / 2) of it; of differences without inverse functions."""
    if projection == "twist":
        return _twist(wi, wo)
    if projection == "deviation":
        wi = _mirror(wi)
    elif projection != "difference":
        return _tan_half(_project(projection, wi, wo))
    return dr.norm(wi - wo) / (2 + dr.norm(wi + wo))


class CompiledSampler:
    """TabulatedSampler in Dr.Jit, from the library's tables, by the formulas of eval/visible_half-inl.h."""

    def __init__(self, source):
        tables = source._sampler_tables()
        self.__dict__.update({k: v for k, v in tables.items() if not k.endswith("edges")})
        self.row_edges, self.cell_edges = mi.UInt32(tables["row_edges"]), mi.UInt32(tables["cell_edges"])

    def sample_wi(self, wo, u):
        """The direction to the light that u becomes, and its density, 1/sr."""
        plane, slices = self._slices(wo)
        turns = 2 if self.isotropic else 4
        target = (abs(2 * u.x - 1) if self.isotropic else mi.Float(u.x)) * 65536
        starts = [(slice * self.rows, weight) for slice, weight in slices]
        row, lower, mass, masses = self._find(self.row_edges, starts, self.rows, target)
        turned = (mi.Float(row) + dr.clip((target - lower) / mass, 0, 1)) * (turns / self.rows)
        target = u.y * mass * 65536
        starts = [((slice * self.rows + row) * self.columns, m) for (slice, _), m in zip(slices, masses)]
        column, lower, mass, _ = self._find(self.cell_edges, starts, self.columns, target)
        v = (mi.Float(column) + dr.clip((target - lower) / mass, 0, 1)) / self.columns

        if self.isotropic:
            w, stretch = 1 - turned, mi.Float(1)
            x, y = _on_half_circle(w)
            y = dr.select(u.x >= 0.5, y, -y)
            h_x, h_y = x * plane.x - y * plane.y, x * plane.y + y * plane.x
        else:
            w = abs(turned - 2) - 1
            x, y = _on_half_circle(w)
            y = dr.select(turned <= 2, y, -y)
            xx, xy, yy = self.stretch
            h_x, h_y = yy * x - xy * y, xx * y - xy * x
            stretch = 1 / (h_x * h_x + h_y * h_y)
            h_x, h_y = h_x * dr.sqrt(stretch), h_y * dr.sqrt(stretch)
        along = wo.x * h_x + wo.y * h_y
        ray = _Ray(self, stretch, along, wo.z)
        m = ray.from_unit(v)
        sine, cosine = 2 * dr.sqrt(m) / (1 + m), (1 - m) / (1 + m)
        to_half = along * sine + wo.z * cosine
        wi = mi.Vector3f(2 * to_half * sine * h_x - wo.x, 2 * to_half * sine * h_y - wo.y, 2 * to_half * cosine - wo.z)
        density = mass * self._cells() * ray.density(m, to_half, _turning(w, stretch))
        return wi, dr.select(wi.z > 0, density, 0)

    def pdf(self, wi, wo):
        """The density of wi under sample_wi, 1/sr; zero below the horizon."""
        plane, slices = self._slices(wo)
        sum = wi + wo
        length = dr.norm(sum)
        m = (sum.x * sum.x + sum.y * sum.y) / dr.square(length + sum.z)
        h = _unit_axis(sum.x, sum.y)
        stretch = mi.Float(1)
        if self.isotropic:
            image = mi.Vector2f(h.x * plane.x + h.y * plane.y, abs(h.y * plane.x - h.x * plane.y))
        else:
            xx, xy, yy = self.stretch
            x, y = xx * h.x + xy * h.y, xy * h.x + yy * h.y
            stretch = x * x + y * y
            image = _unit_axis(x, y)
        w = image.x / (1 + abs(image.y))
        ray = _Ray(self, stretch, wo.x * h.x + wo.y * h.y, wo.z)
        row = _index(_turn(w, image.y) * (self.rows / (2 if self.isotropic else 4)), self.rows)
        column = _index(ray.to_unit(m) * self.columns, self.columns)
        starts = [(slice * self.rows, weight) for slice, weight in slices]
        _, _, masses = self._interval(self.row_edges, starts, row)
        starts = [((slice * self.rows + row) * self.columns, m) for (slice, _), m in zip(slices, masses)]
        _, mass, _ = self._interval(self.cell_edges, starts, column)
        density = mass * self._cells() * ray.density(m, 0.5 * length, _turning(w, stretch))
        return dr.select((wi.z > 0) & (wo.z > 0), density, 0)

    def _cells(self):
        return 0.25 / 65536**2 * self.rows * self.columns

    def _slices(self, wo):
        """The azimuth of wo, and the tables around it with their weights."""
        plane = _unit_axis(wo.x, wo.y)
        t = (wo.x * plane.x + wo.y * plane.y) / (1 + wo.z)
        at = dr.minimum(t / (self.ring_reach - t) * self.theta_scale, self.thetas - 1)
        ring = _index(at, self.thetas - 1)
        outer = at - mi.Float(ring)
        if self.isotropic:
            return plane, [(ring, 1 - outer), (ring + 1, outer)]
        around = _turn(plane.x / (1 + abs(plane.y)), plane.y) * (0.25 * self.phis)
        first = _index(around, self.phis)
        part = around - mi.Float(first)
        next = dr.select(first < self.phis - 1, first + 1, 0)
        # between three of the four corners of the cell: those of its half
        far = outer + part >= 1
        corner = dr.select(far, outer + part - 1, 1 - outer - part)
        inner_ring, outer_ring = ring * self.phis, (ring + 1) * self.phis
        return plane, [
            (dr.select(far, outer_ring + next, inner_ring + first), corner),
            (inner_ring + next, dr.select(far, 1 - outer, part)),
            (outer_ring + first, dr.select(far, 1 - part, outer)),
        ]

    def _find(self, edges, starts, count, target):
        """The last of `count` entries whose weighed edge is at most the target, with its interval."""
        index, step = mi.UInt32(0), count // 2
        while step > 0:
            edge = mi.Float(0)
            for start, weight in starts:
                edge += weight * mi.Float(dr.gather(mi.UInt32, edges, start + index + step))
            index = dr.select(edge <= target, index + step, index)
            step //= 2
        return index, *self._interval(edges, starts, index)

    def _interval(self, edges, starts, index):
        lower, mass, masses = mi.Float(0), mi.Float(0), []
        for start, weight in starts:
            low, high = (dr.gather(mi.UInt32, edges, start + index + k) for k in (0, 1))
            high = dr.select(high == 0, 65536, high)  # the next row's first entry
            masses.append(weight * mi.Float(high - low))
            lower += weight * mi.Float(low)
            mass += masses[-1]
        return lower, mass, masses


class _Ray:
    """VisibleHalfMap along one azimuth."""

    def __init__(self, sampler, stretch, along, up):
        self.K = sampler.sharpness / stretch
        self.a = sampler.share * (1 + self.K)
        self.b = 1 - sampler.share
        sum = dr.sqrt(along * along + up * up) + abs(along)
        behind = along <= 0
        t = dr.select(behind, up, sum) / (dr.select(behind, sum, up) + dr.sqrt(sum * sum + up * up))
        self.largest = t * t
        self.end = self.largest + self.K
        self.total = self.largest * (self.a + self.b * self.end)

    def to_unit(self, m):
        return m * (self.a + self.b * (m + self.K)) * self.end / ((m + self.K) * self.total)

    def from_unit(self, v):
        target = v * self.total
        p = (self.a + self.b * self.K) * self.end - target
        q, c = 2 * target * self.K, 2 * self.b * self.end
        sum = abs(p) + dr.sqrt(p * p + c * q)
        return dr.minimum(dr.select(p >= 0, q, sum) / dr.select(p >= 0, sum, c), self.largest)

    def density(self, m, to_half, turning):
        near = dr.square(m + self.K)
        return (
            turning * self.end * (self.a * self.K + self.b * near) * dr.square(1 + m) / (8 * to_half * self.total * near)
        )


def _index(x, count):
    """The integer part of x >= 0, below `count`; 0 of what is no number."""
    return dr.minimum(mi.UInt32(dr.select(x > 0, dr.minimum(x, count), 0)), count - 1)


def _unit_axis(x, y):
    right = x + 1e-15
    inverse = dr.rcp(dr.sqrt(right * right + y * y))
    return mi.Vector2f(right * inverse, y * inverse)


def _on_half_circle(w):
    inverse = 1 / (1 + w * w)
    return 2 * w * inverse, (1 - w * w) * inverse


def _turn(w, y):
    return dr.select(y >= 0, 1 - w, 3 + w)


def _turning(w, stretch):
    return (1 + w * w) / (2 * stretch)
