#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A metal of OpenPBR with specular_weight 0.5 gets twice as bright at its edge from one patch release to the next.
#
# Versions: MaterialX 1.39.4 and 1.39.5, both for documents of version 1.39.
# Expected: the same picture: both releases are of 1.39, and the node went from 1.1 to 1.1.1. OpenPBR Surface calls the
#   edge "a fractional tint of the Schlick curve, controlled via specular_color".
# Seen: in open_pbr_surface of 1.39.4 the tint at 82 degrees is specular_color * specular_weight, and the lobe is
#   scaled by specular_weight again: the weight counts twice. In 1.39.5 the tint is specular_color. A document
#   that does not ask for a version of the node gets what is installed (1.1 or 1.1.1). Only a weight of 1 is safe.
#
#   1.39.4  node 1.1    tint at 82 degrees times the lobe's weight: 0.25
#   1.39.5  node 1.1.1  tint at 82 degrees times the lobe's weight: 0.5
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

cat > see.py <<'PY'
import sys
import MaterialX as mx

library = mx.createDocument()
mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)
definition = library.getNodeDef("ND_open_pbr_surface_surfaceshader")
graph = definition.getImplementation()
GIVEN = {"specular_weight": 0.5, "specular_color": 1.0}  # grey, so that one number is enough

def value(node, name):
    """Of an input of the graph's node: what is given, or the product that is connected to it."""
    given = node.getInput(name)
    if given.getInterfaceName():
        return GIVEN[given.getInterfaceName()]
    source = graph.getNode(given.getNodeName())
    assert source.getCategory() == "multiply", source.getCategory()
    return value(source, "in1") * value(source, "in2")

metal = graph.getNode("metal_bsdf")
edge = value(metal, "weight") * value(metal, "color82")
print(f"{mx.getVersionString()}  node {definition.getVersionString():6} "
      f"tint at 82 degrees times the lobe's weight: {edge:g}")
sys.exit(edge != float(sys.argv[1]))
PY
for expected in 1.39.4=0.25 1.39.5=0.5; do
  python3 -m venv venv
  venv/bin/pip install -q --disable-pip-version-check --only-binary :all: "MaterialX==${expected%=*}"
  venv/bin/python see.py "${expected#*=}"
  rm -rf venv
done
