#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# MaterialX's GLSL without an environment uses a uniform that it does not declare: no material compiles.
#
# Version: MaterialX 1.39.5 (1.39.4 is the same).
# Expected: a shader that compiles. HwSpecularEnvironmentMethod has three values, and MaterialX's API reference
#   says of SPECULAR_ENVIRONMENT_NONE: "Do not use specular environment maps."
# Seen: with NONE the pixel shader of every surface, opaque ones too, reads u_refractionTwoSided and no line declares
#   it; with FIS and PREFILTER one does. glslangValidator: "'u_refractionTwoSided' : undeclared identifier". A line
#   "const bool u_refractionTwoSided = false;" below #version makes it compile. The document itself validates.
#
#   NONE       u_refractionTwoSided: used 1 time, declared 0 times
#   FIS        u_refractionTwoSided: used 1 time, declared 1 time
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --only-binary :all: MaterialX==1.39.5

cat > see.py <<'PY'
import re
import MaterialX as mx
from MaterialX import PyMaterialXGenGlsl as gen_glsl
from MaterialX import PyMaterialXGenShader as gen

DOCUMENT = """<?xml version="1.0"?><materialx version="1.39"><NODE name="s" type="surfaceshader"/>
<surfacematerial name="m" type="material"><input name="surfaceshader" type="surfaceshader" nodename="s"/>
</surfacematerial></materialx>"""

def pixel_shader(node, method):
    library, document, search = mx.createDocument(), mx.createDocument(), mx.getDefaultDataSearchPath()
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), search, library)
    document.setDataLibrary(library)
    mx.readFromXmlString(document, DOCUMENT.replace("NODE", node))
    assert document.validate()[0], "the document is not valid"
    generator = gen_glsl.GlslShaderGenerator.create()
    context = gen.GenContext(generator)
    context.registerSourceCodeSearchPath(search)
    context.getOptions().hwSpecularEnvironmentMethod = method
    generator.registerTypeDefs(document)
    return generator.generate("m", mx.getShaderNodes(document.getMaterialNodes()[0])[0], context).getSourceCode("pixel")

for node in ("open_pbr_surface", "standard_surface"):
    for name in ("NONE", "FIS", "PREFILTER"):
        text = pixel_shader(node, getattr(gen.HwSpecularEnvironmentMethod, f"SPECULAR_ENVIRONMENT_{name}"))
        text = re.sub(r"//[^\n]*", "", text)
        declared = len(re.findall(r"\b(?:bool|int)\s+u_refractionTwoSided\b|define\s+u_refractionTwoSided\b", text))
        used = len(re.findall(r"\bu_refractionTwoSided\b", text)) - declared
        print(f"{node:16} {name:9} u_refractionTwoSided: used {used}, declared {declared}")
        assert used > 0 and (declared == 0) == (name == "NONE"), "it is declared otherwise"
PY
venv/bin/python see.py
