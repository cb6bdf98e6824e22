#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# MaterialX's validator passes nodes that no library defines; only the generator of shaders finds them missing.
#
# Version: MaterialX 1.39.5, with its own libraries loaded.
# Expected: what validate() does with an input that a node's definition lacks: false, "Input 'iorr' doesn't match
#   declaration". The specification ("Nodes") says that a node element is an instance of a function defined elsewhere.
# Seen: a category that is misspelt or made up is valid, and so is thin_film_bsdf, which was a standard node up to 1.38
#   and is none in 1.39, in a document that says version 1.39. Generating raises LookupError, "Could not find a
#   nodedef". So a valid document proves nothing about its nodes: ask each for getNodeDef().
#
#   measured_bsdf   valid True   nodedef missing   generate: Could not find a nodedef for node 'c'
#   thin_film_bsdf  valid True   nodedef missing   generate: Could not find a nodedef for node 'c'
#   conductor_bsdf with an input iorr: valid False
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --only-binary :all: MaterialX==1.39.5

cat > see.py <<'PY'
import MaterialX as mx
from MaterialX import PyMaterialXGenGlsl as gen_glsl
from MaterialX import PyMaterialXGenShader as gen

DOCUMENT = """<?xml version="1.0"?><materialx version="1.39"><NODE name="c" type="BSDF">INPUT</NODE>
<surface name="s" type="surfaceshader"><input name="bsdf" type="BSDF" nodename="c"/></surface>
<surfacematerial name="m" type="material"><input name="surfaceshader" type="surfaceshader" nodename="s"/>
</surfacematerial></materialx>"""

def look(node, given=""):
    """(valid, node has a definition, what the generator says)."""
    library, document, search = mx.createDocument(), mx.createDocument(), mx.getDefaultDataSearchPath()
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), search, library)
    document.setDataLibrary(library)
    mx.readFromXmlString(document, DOCUMENT.replace("NODE", node).replace("INPUT", given))
    generator = gen_glsl.GlslShaderGenerator.create()
    context = gen.GenContext(generator)
    context.registerSourceCodeSearchPath(search)
    generator.registerTypeDefs(document)
    try:
        generator.generate("m", mx.getShaderNodes(document.getMaterialNodes()[0])[0], context)
        said = "made"
    except LookupError as error:
        said = str(error)
    seen = document.validate()[0], document.getNode("c").getNodeDef() is not None, said
    print(f"{node:15} {given and 'with an unknown input':22} valid {seen[0]}, defined {seen[1]}, generate: {seen[2]}")
    return seen

assert look("conductor_bsdf") == (True, True, "made")
assert not look("conductor_bsdf", '<input name="iorr" type="float" value="1"/>')[0], "unknown inputs are valid now"
for name in ("measured_bsdf", "thin_film_bsdf"):
    valid, defined, said = look(name)
    assert valid and not defined and "Could not find a nodedef" in said, f"{name} is found or not valid"
PY
venv/bin/python see.py
