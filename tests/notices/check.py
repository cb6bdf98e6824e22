#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks what packages say of other people's work: check.py [--python FOLDER] [PACKAGE...].

Without packages: writes the notices and the SBOM of each kind from this system, and checks that every part has its
version and its licence, that a missing part is an error, that no library of cmake/debian-packages.txt was forgotten,
and that the SBOM has what CycloneDX 1.6 requires. With packages (.whl, .deb, .tgz): that each holds LICENSE, notices
and SBOM, and that a wheel brings no shared library that its SBOM does not know. Exits with 77 where there is no dpkg."""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOTICES = ROOT / "cmake/notices/notices.py"
LIST = json.loads((ROOT / "cmake/notices/components.json").read_text(encoding="utf-8"))
KINDS = {"application", "framework", "library", "container", "platform", "operating-system", "device", "device-driver",
         "firmware", "file", "machine-learning-model", "data", "cryptographic-asset"}
LICENCES = {"Apache-2.0", "MPL-2.0", "MIT", "BSD-3-Clause", "libpng-2.0", "Zlib", "blessing"}
REFERENCES = {"website", "vcs", "issue-tracker", "distribution", "license", "documentation", "other"}
PURL = re.compile(r"pkg:[a-z]+/[\w.%+-]+(/[\w.%+-]+)*@[\w.%~-]+")
problems = []


def expect(holds, text):
    if not holds:
        problems.append(text)


def check_component(one, place):
    for field in ("type", "name"):  # what the schema requires
        expect(isinstance(one.get(field), str) and one[field], f"{place}: no {field}")
    expect(one.get("type") in KINDS, f"{place}: type {one.get('type')}")
    expect(one.get("version"), f"{place}: no version")
    for licence in one.get("licenses", [{}]):
        said = licence.get("expression") or licence.get("license", {}).get("id")
        expect(("expression" in licence) != ("license" in licence) and said, f"{place}: no licence")
        names = re.findall(r"[\w.-]+", re.sub(r"\b(AND|OR|WITH [\w.-]+)(?=\W|$)", "", said or ""))
        expect(set(names) <= LICENCES, f"{place}: unknown licence {said}")
    for reference in one.get("externalReferences", []):
        expect(reference.get("type") in REFERENCES and re.match(r"https?://", reference.get("url", "")),
               f"{place}: {reference}")
    expect("purl" not in one or PURL.fullmatch(one["purl"]), f"{place}: purl {one.get('purl')}")


def check_sbom(bom, place):
    expect(bom.get("bomFormat") == "CycloneDX", f"{place}: bomFormat {bom.get('bomFormat')}")
    expect(bom.get("specVersion") == "1.6", f"{place}: specVersion {bom.get('specVersion')}")
    expect(re.fullmatch(r"urn:uuid:[0-9a-f]{8}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{12}",
                        bom.get("serialNumber", "")), f"{place}: serialNumber {bom.get('serialNumber')}")
    expect(isinstance(bom.get("version"), int) and bom["version"] >= 1, f"{place}: version {bom.get('version')}")
    known = set(bom) - {"$schema", "bomFormat", "specVersion", "serialNumber", "version", "metadata", "components",
                        "dependencies"}
    expect(not known, f"{place}: fields that CycloneDX has not: {known}")
    root = bom["metadata"]["component"]
    everything = [root, *bom["components"]]
    for one in everything:
        check_component(one, f"{place}: {one.get('name')}")
    refs = [one["bom-ref"] for one in everything]
    expect(len(refs) == len(set(refs)), f"{place}: a bom-ref stands twice")
    for entry in bom["dependencies"]:
        expect({entry["ref"], *entry["dependsOn"]} <= set(refs), f"{place}: dependencies name what is no component")
    expect(bom["components"], f"{place}: no components")


def written(package, folder, *options):
    """(exit status, notices, SBOM) of one kind of package; None for a file that is not there."""
    notices, bom = folder / f"{package}.txt", folder / f"{package}.json"
    done = subprocess.run([sys.executable, NOTICES, package, "--version", "1.2.3", "--notices", notices, "--sbom", bom,
                           *options], capture_output=True, text=True)
    texts = [path.read_text(encoding="utf-8") if path.exists() else None for path in (notices, bom)]
    return done.returncode, *texts


def check_list():
    """No library that the build installs is forgotten, and none is listed that nothing holds."""
    listed = {part.get("debian") for part in LIST["libraries"]} | set(LIST["in no package"])
    for name in ("debian-packages.txt", "debian-studio-packages.txt"):
        lines = (ROOT / "cmake" / name).read_text(encoding="utf-8").split("\n")
        for package in lines:
            expect(not package.endswith("-dev") or package in listed, f"cmake/{name}: {package} is not in the notices")
    for part in LIST["libraries"]:
        expect(part["in"] and set(part["in"]) <= {"wheel", "deb", "npm"}, f"{part['name']}: in {part['in']}")


def check_kinds(folder, packages):
    for package in ("deb", "npm") + (("wheel",) if packages else ()):
        options = ["--python", packages] if package == "wheel" else []
        if package == "npm" and not shutil.which("em++"):
            continue
        status, notices, bom = written(package, folder / "first", "--strict", *options)
        expect(status == 0, f"{package}: exit status {status}: a version or a licence was not found")
        if status:
            continue
        check_sbom(json.loads(bom), package)
        for part in LIST["libraries"]:
            expect((f"\n{part['name']} " in notices) == (package in part["in"]), f"{package}: notices of {part['name']}")
        expect("Permission is hereby granted" in notices, f"{package}: no text of the MIT licence")
        expect(written(package, folder / "second", *options)[1:] == (notices, bom), f"{package}: twice is not the same")
    # nothing that is built with nanobind may leave it out
    status, notices, bom = written("wheel", folder / "third", "--strict", "--python", folder / "nothing")
    expect(status == 1 and notices is None and bom is None, f"a missing part: exit status {status}, and files")


def files_of(package, folder):
    """Names and a way to read them."""
    if package.suffix == ".whl":
        archive = zipfile.ZipFile(package)
        return archive.namelist(), archive.read
    if package.suffix == ".deb":
        subprocess.run(["dpkg-deb", "-x", package, folder], check=True)
        names = [str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()]
        return names, lambda name: (folder / name).read_bytes()
    archive = tarfile.open(package)
    return archive.getnames(), lambda name: archive.extractfile(name).read()


def check_package(package, folder):
    names, read = files_of(package, folder)
    ends = ["THIRD_PARTY_NOTICES", "burnish.cdx.json", "copyright" if package.suffix == ".deb" else "LICENSE"]
    for end in ends:
        expect(any(name.rsplit("/", 1)[-1] == end for name in names), f"{package.name}: no {end}")
    boms = [name for name in names if name.endswith("burnish.cdx.json")]
    for name in boms:
        bom = json.loads(read(name))
        check_sbom(bom, package.name)
        expect(bom["metadata"]["component"]["version"] in package.name, f"{package.name}: SBOM of another version")
        known = {one["name"] for one in bom["components"]}
        files = [start for part in LIST["libraries"] if part["name"] in known for start in part.get("files", [])]
        for library in (n.rsplit("/", 1)[-1] for n in names if "burnish.libs/" in n and not n.endswith("/")):
            expect(any(re.match(re.escape(start) + r"[-_.]", library) for start in files),
                   f"{package.name}: {library} is not in its SBOM")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--python", type=pathlib.Path, help="the folder of Python packages that nanobind is in")
    parser.add_argument("packages", nargs="*", type=pathlib.Path)
    given = parser.parse_args()
    if not shutil.which("dpkg-query"):
        print("notices: SKIPPED: no dpkg, so versions and licences were not looked for")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for number, package in enumerate(given.packages):
            (folder / str(number)).mkdir()
            check_package(package, folder / str(number))
        if not given.packages:
            check_list()
            check_kinds(folder, given.python)
    for problem in problems:
        print(problem, file=sys.stderr)
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
