#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Puts every generated file of ten models, in every language, through real compilers.

tests/shaders/compile.py BURNISH [--keep FOLDER] fits ten small models, exports each in four ways (the hardware's
filter, exact, half precision, with places of its own) and prints a table: language, compiler, files, failures. Below
it stands what the first refusals of each row say. Exits with 1 where a compiler refuses a file. A compiler that is
missing is named and skipped: glslangValidator, spirv-val, naga, tint, g++, clang++, and Slang's library of PyPI's
slangpy, whose package need not be importable: what it says is asked for by slang_compile.cpp."""
import argparse
import importlib.util
import json
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
GOLD = "ggx:alpha_x=0.2,alpha_y=0.2,f0=0.8/0.5/0.3"
BRUSHED = "ggx:alpha_x=0.1,alpha_y=0.3"
FEW = ["--samples", "4000"]
# Name, source, options of the fit; without options the formula itself is exported.
MODELS = [
    ("lines", GOLD, ["--model", "pqpr", *FEW]),
    ("grey", "blinn_phong:exponent=60", ["--model", "pqp", "--format", "half", *FEW]),
    ("bytes", GOLD, ["--model", "pqpr", "--format", "unorm8", *FEW]),
    ("floats", GOLD, ["--model", "pqpr", "--format", "float", *FEW]),
    ("shared_exponents", GOLD, ["--model", "pqp", "--format", "rgb9e5", *FEW]),
    ("disks", BRUSHED, ["--model", "p(wo) q(h) r(theta_d) p(wi)", "--table", "q=12x12", "--table", "p=8x8", *FEW]),
    ("volume", BRUSHED, ["--model", "p(wo) p(wi) v(h,d,phi_d)", "--table", "v=6x6x6", *FEW]),
    ("lobes", GOLD, ["--budget", "512", "--lobes", "2", *FEW]),
    ("coated", "openpbr:base_color=0.5/0.1/0.05,coat_weight=1,fuzz_weight=0.2", []),
    ("highlight", "blinn_phong:exponent=60,ks=0.8", []),
]
LANGUAGES = {"glsl": ".glsl", "glsl_es": ".es.glsl", "hlsl": ".hlsl", "msl": ".metal", "slang": ".slang",
             "wgsl": ".wgsl", "cpp": ".h"}
WAYS = {"filtered": [], "exact": ["--exact"], "half": ["--half"],
        "placed": ["--binding", "2", "--set", "1", "--space", "3"]}
SLANG_TARGETS = ["spirv", "hlsl", "metal", "wgsl", "glsl", "cuda"]


def calls(name, vector):
    """All functions of a model, in a language whose vector of three is made by that name."""
    a, b = f"{vector}(0.0, 0.6, 0.8)", f"{vector}(0.0, 0.0, 1.0)"
    x, u = f"{vector}(1.0, 0.0, 0.0)", f"{vector.replace('3', '2')}(0.5, 0.25)"
    drawn = (f"{vector}(burnish_{name}_sample({b}, {u}).x, burnish_{name}_sample_world({b}, {x}, {b}, {u}).w, "
             f"burnish_{name}_pdf({a}, {b}) + burnish_{name}_pdf_world({b}, {x}, {a}, {b}))")
    return f"burnish_{name}({a}, {b}) + burnish_{name}_world({b}, {x}, {a}, {b}) + {drawn}"


def fragment_hlsl(name):
    return f"float4 main(float4 at : SV_Position) : SV_Target {{ return float4({calls(name, 'float3')}, 1.0); }}\n"


def program(language, name, text):
    """A whole program of a generated file, by the language it is compiled as."""
    if language == "glsl":
        return f"#version 450\n{text}out vec4 color;\nvoid main() {{ color = vec4({calls(name, 'vec3')}, 1.0); }}\n"
    if language == "vulkan":
        return (f"#version 450\n{text}layout(location = 0) out vec4 color;\n"
                f"void main() {{ color = vec4({calls(name, 'vec3')}, 1.0); }}\n")
    if language == "glsl_es":
        return (f"#version 300 es\n{text}out highp vec4 color;\n"
                f"void main() {{ color = vec4({calls(name, 'vec3')}, 1.0); }}\n")
    if language == "wgsl":
        return f"{text}@fragment fn main() -> @location(0) vec4f {{ return vec4f({calls(name, 'vec3f')}, 1.0); }}\n"
    if language == "cuda":
        return (f"{text}RWStructuredBuffer<float3> values;\n[shader(\"compute\")] [numthreads(1, 1, 1)]\n"
                f"void main(uint3 at : SV_DispatchThreadID) {{ values[at.x] = {calls(name, 'float3')}; }}\n")
    if language == "cpp":
        return (f"{text}int main() {{ using namespace burnish_shader; const vec3 f = {calls(name, 'vec3')};\n"
                "return f.x + f.y + f.z >= 0 ? 0 : 1; }\n")
    return text + fragment_hlsl(name)


class Table:
    """Rows of language, compiler, files and failures, and what refusals say."""

    def __init__(self):
        self.rows, self.said = [], []

    def add(self, language, compiler, outcomes):
        failures = [(file, said) for file, said in outcomes if said]
        self.rows.append((language, compiler, len(outcomes), len(failures)))
        self.said += [f"{language}, {compiler}: {file}: {said.strip()[:600]}" for file, said in failures[:2]]

    def show(self):
        print(f"{'language':12}{'compiler':34}{'files':>7}{'failures':>10}")
        for language, compiler, files, failures in self.rows:
            print(f"{language:12}{compiler:34}{files:7}{failures:10}")
        print("\n".join(self.said))


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, errors="replace")
    return (done.stdout + done.stderr or f"exit {done.returncode}") if done.returncode else ""


def without_source_language(path):
    """SPIRV-Tools of 2023 refuse Slang as a source language, which changes nothing: the word becomes `unknown`."""
    words = list(struct.unpack(f"<{path.stat().st_size // 4}I", path.read_bytes()))
    at = 5
    while at < len(words):
        if words[at] & 0xFFFF == 3:
            words[at + 1] = 0
        at += words[at] >> 16
    path.write_bytes(struct.pack(f"<{len(words)}I", *words))


def refused_by_slang(slang, target, paths):
    """What Slang says of each file, by name; all in one process, or each in its own where that process crashes."""
    done = subprocess.run([str(word) for word in [*slang, target, *paths]], capture_output=True, text=True)
    if done.returncode not in (0, 1):
        return {path.name: run(*slang, target, path) for path in paths}
    said = {path.name: "" for path in paths}
    for part in done.stdout.split("\n\0"):
        file, _, message = part.partition(": ")
        if message:
            said[pathlib.Path(file).name] = message
    return said


def slang_compiler(folder):
    """The command of slang_compile and its library, or None after saying what is missing."""
    spec = importlib.util.find_spec("slangpy")
    for place in (spec.submodule_search_locations or []) if spec else []:
        for library in sorted(pathlib.Path(place).glob("libslang-compiler.so*")):
            built = folder / "slang_compile"
            said = run("c++", "-std=c++17", f"-I{place}/include", HERE / "slang_compile.cpp", "-o", built, "-ldl")
            if not said:
                return [built, library]
            print(f"skipped: Slang: {said.strip()[:300]}")
            return None
    print("skipped: Slang: no slangpy (pip install slangpy)")
    return None


def fitted(burnish, folder):
    """Every model's argument of `export`, by name."""
    models = {}
    for name, source, options in MODELS:
        models[name] = source
        if options:
            models[name] = folder / f"{name}.exr"
            said = run(burnish, "fit", source, "-o", models[name], *options)
            if said:
                sys.exit(f"{name}: {said}")
    return models


def exported(burnish, folder, models):
    """Every model's code: (language, way, model, text). What draws directions stands behind what evaluates."""
    files = []
    for name, model in models.items():
        formula = not pathlib.Path(str(model)).exists()
        for way, options in WAYS.items():
            if formula and way not in ("filtered", "placed"):
                continue  # a formula has no tables to filter
            out = folder / f"{name}_{way}"
            said = run(burnish, "export", model, "--to", ",".join(LANGUAGES), "--sample", "--name", name, "-o", out,
                       *options)
            if said:
                sys.exit(f"{name}, {way}: {said}")
            manifest = json.loads((out / f"{name}.json").read_text())
            draws = {shader["language"]: shader["file"] for shader in manifest["sample"]["shaders"]}
            for shader in manifest["shaders"]:
                text = (out / shader["file"]).read_text() + (out / draws[shader["language"]]).read_text()
                files.append((shader["language"], way, name, text))
    return files


def written(folder, files, language, ending, ways=None, of=None):
    """The programs of a language as files."""
    paths = []
    for found, way, name, text in files:
        if found == language and (not ways or way in ways):
            path = folder / f"{name}_{way}_{of or language}{ending}"
            path.write_text(program(of or language, name, text))
            paths.append(path)
    return paths


def outcomes(paths, command):
    return [(path.name, command(path)) for path in paths]


def by_glslang(table, folder, files):
    if not shutil.which("glslangValidator"):
        return print("skipped: glslangValidator: not here")
    gl = [way for way in WAYS if way != "placed"]
    for language, ending in (("glsl", ".frag"), ("glsl_es", "_es.frag")):
        ways = gl if language == "glsl" else None
        table.add(language, "glslangValidator, OpenGL" + (" ES" if ways is None else ""),
                  outcomes(written(folder, files, language, ending, ways), lambda path: run("glslangValidator", path)))
    spirv = []

    def vulkan(path, *options):
        out = path.with_suffix(path.suffix + ".spv")
        said = run("glslangValidator", "-V", *options, path, "-o", out)
        if not said:
            spirv.append(out)
        return said

    paths = written(folder, files, "glsl", "_vk.frag", ["placed"], "vulkan")
    table.add("glsl", "glslangValidator, Vulkan", outcomes(paths, vulkan))
    table.add("hlsl", "glslangValidator, HLSL", outcomes(
        written(folder, files, "hlsl", ".hlsl"), lambda path: vulkan(path, "-D", "-e", "main", "-S", "frag")))
    if shutil.which("spirv-val"):
        table.add("glsl, hlsl", "spirv-val of glslang's SPIR-V", outcomes(spirv, lambda path: run("spirv-val", path)))
    else:
        print("skipped: spirv-val: not here")


def by_slang(table, folder, files):
    slang = slang_compiler(folder)
    if not slang:
        return
    for language in ("slang", "hlsl"):
        for target in SLANG_TARGETS:
            # Slang knows no min16float: with half precision it takes the files of --to slang.
            ways = [way for way in WAYS if language == "slang" or way != "half"]
            paths = written(folder, files, language, f"_{language}.{target}.slang", ways,
                            "cuda" if target == "cuda" else None)
            said = refused_by_slang(slang, target, paths)
            table.add(language, f"Slang to {target}", list(said.items()))
            made = [path.with_name(f"{path.name}.{target}") for path in paths if not said[path.name]]
            if target == "spirv" and shutil.which("spirv-val"):
                for path in made:
                    without_source_language(path)
                table.add(language, "spirv-val of Slang's SPIR-V", outcomes(made, lambda path: run("spirv-val", path)))


def by_others(table, folder, files):
    wgsl = written(folder, files, "wgsl", ".wgsl")
    if shutil.which("naga"):
        table.add("wgsl", "naga", outcomes(wgsl, lambda path: run("naga", path)))
    else:
        print("skipped: naga: not here")
    if shutil.which("tint"):
        table.add("wgsl", "tint", outcomes(wgsl, lambda path: run("tint", "--format", "wgsl", "-o", "/dev/null", path)))
    else:
        print("skipped: tint: not here")
    cpp = written(folder, files, "cpp", ".cpp", ["exact"]) + [
        path for path in written(folder, files, "cpp", ".cpp", ["filtered"]) if path.name.startswith(("coated", "high"))]
    for compiler in ("g++", "clang++"):
        if shutil.which(compiler):
            table.add("cpp", compiler, outcomes(cpp, lambda path, by=compiler: run(
                by, "-std=c++17", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", path)))
        else:
            print(f"skipped: {compiler}: not here")
    print("skipped: MSL as we write it: no compiler of Metal is to be had here; Slang writes MSL of its own")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("burnish")
    parser.add_argument("--keep", metavar="FOLDER", help="leave all files in this folder")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(arguments.keep or scratch)
        folder.mkdir(parents=True, exist_ok=True)
        files = exported(arguments.burnish, folder, fitted(arguments.burnish, folder))
        table = Table()
        by_glslang(table, folder, files)
        by_slang(table, folder, files)
        by_others(table, folder, files)
        print(f"{len(MODELS)} models, {2 * len(files)} generated files, two a program")
        table.show()
        return any(failures for *_, failures in table.rows)


if __name__ == "__main__":
    sys.exit(main())
