# SPDX-License-Identifier: Apache-2.0
import json
import os
import pathlib
import subprocess
import sys

import numpy
import pytest

import burnish

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "examples"))  # whose pictures tests compare
GGX = "ggx:alpha_x=0.2,alpha_y=0.2,kd=0.05/0.1/0.2"
BRUSHED = "ggx:alpha_x=0.1,alpha_y=0.4"


@pytest.fixture(scope="session")
def cli():
    """Runs the command line; with --json returns what it printed as Python objects."""
    program = os.environ.get("BURNISH_CLI", ROOT / "build/release/apps/burnish/burnish")
    if not os.path.exists(program):
        pytest.skip(f"{program} is not built")

    def run(*arguments):
        done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(done.stderr.strip())
        return json.loads(done.stdout) if "--json" in arguments else done.stdout

    run.program = str(program)
    return run


@pytest.fixture(scope="session")
def llvm():
    """Mitsuba's variant by LLVM, with our plug-in."""
    mi = pytest.importorskip("mitsuba")
    try:
        mi.set_variant("llvm_ad_rgb")
        mi.Float(1) + mi.Float([2, 3])
    except Exception as error:  # Dr.Jit loads libLLVM when it is first needed
        pytest.skip(f"llvm_ad_rgb is not available: {error}")
    import burnish.mitsuba

    burnish.mitsuba.register()
    return mi


@pytest.fixture(scope="session")
def ggx():
    return burnish.open_source(GGX)


@pytest.fixture(scope="session")
def model(ggx):
    return burnish.fit(ggx, model="pqp")


@pytest.fixture(scope="session")
def lobes():
    """Two lobes over every kind of projection and table."""
    return burnish.fit(
        burnish.open_source(BRUSHED),
        model="p(wo) q(h) p(wi) + a(wi+wo+0.5n) r(theta_d) g(theta_h,theta_d) b(theta_m) t(theta_t) e(phi_d) u(phi_s)",
        tables=["q=24x24,power:0.5", "p=12x12", "a=12,rational:0.3", "r=8", "g=8x6", "b=10", "t=5", "e=6", "u=7"],
        samples=20_000,
    )


@pytest.fixture(scope="session")
def volume(ggx):
    """A line times a table over three angles."""
    return burnish.fit(
        ggx,
        model="z(theta_h) g(theta_h,theta_d,phi_d)",
        tables=["z=32,power:0.5", "g=7x5x3,power:0.5"],
        samples=20_000,
    )


@pytest.fixture(scope="session")
def pairs():
    return burnish.draw_pairs(2000, seed=7, isotropic=False)


@pytest.fixture(scope="session")
def rgl_files():
    folder = os.environ.get("BURNISH_DATA")
    if not folder:
        pytest.skip("BURNISH_DATA is not set")
    return [path for part in ("rgl", "repeat") for path in sorted((pathlib.Path(folder) / part).glob("*.bsdf"))]


@pytest.fixture(scope="session")
def rgl_file(rgl_files):
    return rgl_files[0]


def hemisphere(count, seed=1):
    """Unit vectors above the horizon, float32."""
    w = numpy.random.default_rng(seed).normal(size=(count, 3))
    w[:, 2] = abs(w[:, 2]) + 0.01
    return (w / numpy.linalg.norm(w, axis=1, keepdims=True)).astype(numpy.float32)
