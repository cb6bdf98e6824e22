#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes what a package says of other people's work in it:

    notices.py {wheel,deb,npm} --version V --notices FILE --sbom FILE [--python FOLDER]

The notices are the licences of every part as the system keeps them; the SBOM is the same list in CycloneDX's JSON.
Parts stand in components.json beside this file: what each is for, what packages hold it, and where its version and its
licence are found. `debian` is a package (its version by dpkg-query, its text in /usr/share/doc), `python` a
distribution in --python, the folder of Python packages that it is built with, and `head` a file there whose first
comment is the licence. On systems without dpkg versions are pkg-config's, and the text is that of /usr/share/licenses.
Both files are the same from the same list on the same system. A part whose version or licence is not found is one line
on the standard error output, and says so in the files; with --strict it is an error, and nothing is written."""
import argparse
import functools
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.parse
import uuid

HERE = pathlib.Path(__file__).resolve().parent
DOCS = pathlib.Path("/usr/share/doc")
LICENSES = pathlib.Path("/usr/share/licenses")
COMMON = pathlib.Path("/usr/share/common-licenses")
NOT_FOUND = "not found"
RULE = "=" * 100


@functools.cache
def output_of(*command):
    """What a program prints, or None where it is missing or fails."""
    if not shutil.which(command[0]):
        return None
    done = subprocess.run(command, capture_output=True, text=True, env=os.environ | {"LC_ALL": "C"})
    return done.stdout.strip() or None if done.returncode == 0 else None


def debian_version(package):
    """As dpkg has it, of an installed package."""
    found = output_of("dpkg-query", "-W", "-f", "${db:Status-Abbrev} ${Version}", package)
    return found.split()[1] if found and found.startswith("ii") else None


def upstream(version):
    """A Debian version without its epoch and the revision of the packaging."""
    return re.sub(r"-[^-]*$", "", version.partition(":")[2] or version)


def distribution(folder, name):
    """(version, folder) of a Python distribution, or None."""
    for info in sorted(folder.glob(f"{name}-*.dist-info")) if folder else []:
        return info.name.removesuffix(".dist-info").split("-")[1], info
    return None


def version_of(part, folder):
    """(version, package URL); either may be None."""
    if "debian" in part and (full := debian_version(part["debian"])):
        return upstream(full), f"pkg:deb/debian/{part['debian']}@{urllib.parse.quote(full, safe='')}"
    if "python" in part and (found := distribution(folder, part["python"])):
        return found[0], f"pkg:pypi/{part['python']}@{found[0]}"
    if "with" in part and (found := distribution(folder, part["with"])):
        return f"as in {part['with']} {found[0]}", None
    found = output_of("pkg-config", "--modversion", part["pkgconfig"]) if "pkgconfig" in part else None
    return found, None


def chosen(text, parts):
    """Of a machine-readable copyright file, the paragraphs of these files and of the licences that they name."""
    paragraphs = re.split(r"\n\s*\n", text)
    files = [p for p in paragraphs if re.match(r"Files:", p)]
    taken = [p for p in files if set(re.split(r"\s+", p.partition("\n")[0] + p[: p.find("\nCopyright:")])) & set(parts)]
    # "Expat or NCSA~LLVM", said without its text
    names = {name for p in taken for said in re.findall(r"^License: *(.+)$", p, re.M)
             for name in re.split(r" (?:or|and|with \S+ exception)(?: |$)", said)}
    texts = [p for p in paragraphs if (m := re.match(r"License: *(.+)", p)) and m.group(1).strip() in names]
    return "\n\n".join(taken + texts) + "\n"


def head_of(path):
    """The comment that a file begins with."""
    found = re.match(r"\s*/\*\*?(.*?)\*/", path.read_text(encoding="utf-8"), re.S)
    return re.sub(r"^ ?\* ?", "", found.group(1).strip("\n"), flags=re.M) if found else None


def text_of(part, folder):
    """The licence as this system has it, or None."""
    if "head" in part:
        path = folder / part["head"] if folder else None
        return head_of(path) if path and path.exists() else None
    if "python" in part:
        found = distribution(folder, part["python"])
        paths = sorted((found[1] / "licenses").glob("**/*")) if found else []
    else:
        # the package's own, or of a system that keeps them by the library's name
        paths = [DOCS / part.get("debian", "") / "copyright"]
        if not paths[0].is_file():
            paths = sorted(LICENSES.glob(f"{part.get('pkgconfig', part['name']).lower()}*/*"))
    texts = [p.read_text(encoding="utf-8", errors="replace") for p in paths if p.is_file()]
    text = "\n".join(t.strip("\n") for t in texts) if texts else None
    return chosen(text, part["parts"]) if text and "parts" in part else text


def described(package, folder):
    """Every part of the package with what was found of it."""
    parts = []
    for part in json.loads((HERE / "components.json").read_text(encoding="utf-8"))["libraries"]:
        if package in part["in"]:
            version, url = version_of(part, folder)
            parts.append(part | {"version": version, "url": url, "text": text_of(part, folder)})
    return parts


def notices(package, version, parts):
    """The text file."""
    lines = [f"burnish {version} is under the Apache License 2.0 (LICENSE). Its {package} package holds, or is compiled",
             "with, the work of others. This file lists it, with the licences as the system that built the package",
             "keeps them. What burnish writes (textures, shaders, generated code) is its user's.", ""]
    for part in parts:
        lines.append(f"- {part['name']} {part['version'] or '(version not found)'}, {part['licence']}: {part['for']}.")
        lines.append(f"  Source: {part['source']}")
    for part in parts:
        lines += ["", RULE, f"{part['name']} {part['version'] or ''}".strip(), RULE, ""]
        lines += [(part["text"] or f"Its licence was not found here; {part['source']} has it.").strip("\n")]
    for name in ("Apache-2.0", "MPL-2.0"):  # Debian's files refer to these by their place
        if any(name in part["licence"] for part in parts) and (COMMON / name).exists():
            lines += ["", RULE, f"{name}, which texts above refer to", RULE, ""]
            lines.append((COMMON / name).read_text(encoding="utf-8").strip("\n"))
    return "\n".join(line.rstrip() for line in "\n".join(lines).split("\n")) + "\n"


def licences_of(part):
    """As CycloneDX has them: one identifier, or an expression."""
    said = part["licence"]
    return [{"expression": said} if " " in said else {"license": {"id": said}}]


def sbom(package, version, parts):
    """CycloneDX 1.6."""
    root = {"type": "library", "bom-ref": "burnish", "name": "burnish", "version": version,
            "licenses": [{"license": {"id": "Apache-2.0"}}]}
    components = []
    for part in parts:
        component = {"type": "library", "bom-ref": part["name"], "name": part["name"],
                     "version": part["version"] or NOT_FOUND, "description": part["for"],
                     "licenses": licences_of(part)}
        if part["url"]:
            component["purl"] = part["url"]
        component["externalReferences"] = [{"type": "website", "url": part["source"]}]
        components.append(component)
    content = json.dumps([package, root, components], sort_keys=True)
    return {"$schema": "http://cyclonedx.org/schema/bom-1.6.schema.json", "bomFormat": "CycloneDX",
            "specVersion": "1.6", "serialNumber": f"urn:uuid:{uuid.uuid5(uuid.NAMESPACE_URL, content)}", "version": 1,
            "metadata": {"component": root, "properties": [{"name": "burnish:package", "value": package}]},
            "components": components,
            "dependencies": [{"ref": "burnish", "dependsOn": [part["name"] for part in parts]}]}


def write(path, text):
    """Whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_name(path.name + ".part")
    unfinished.write_text(text, encoding="utf-8")
    unfinished.replace(path)


def main():
    parser = argparse.ArgumentParser(description="Writes notices and the SBOM of a package.")
    parser.add_argument("package", choices=("wheel", "deb", "npm"))
    parser.add_argument("--version", required=True)
    parser.add_argument("--notices", type=pathlib.Path, required=True)
    parser.add_argument("--sbom", type=pathlib.Path, required=True)
    parser.add_argument("--python", type=pathlib.Path)
    parser.add_argument("--strict", action="store_true")
    given = parser.parse_args()
    parts = described(given.package, given.python)
    missing = [f"{what} of {part['name']}" for part in parts for what in ("version", "text") if not part[what]]
    if missing:
        print(f"notices: of the {given.package} package not found: {', '.join(missing)}", file=sys.stderr)
        if given.strict:
            sys.exit(1)
    write(given.notices, notices(given.package, given.version, parts))
    write(given.sbom, json.dumps(sbom(given.package, given.version, parts), indent=2) + "\n")


if __name__ == "__main__":
    main()
