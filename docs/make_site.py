#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Builds the site from the Markdown of this repository: docs/make_site.py [--out FOLDER] [--stage-only] [--no-notebooks].

- Pages lie in the site as in the repository, without the folder docs; README.md is the first page.
- docs/api.md becomes a page a topic (TOPICS), and its links follow.
- Notebooks (docs/notebooks) are executed first, by build/venv, and are pages with what they printed and drew.
- Symbols of docs/notation.md get a hover card wherever they stand in text.
- Files that pages link to and that are no pages, such as sources, go along as plain text.
- The studio goes along where build/studio is.

MkDocs is strict: a link or a heading that leads nowhere is an error. Needs what docs/site/requirements.txt lists.
Writes FOLDER (build/site), from what it stages in build/site-pages."""
import argparse
import base64
import json
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
STAGE = ROOT / "build/site-pages"
LINK = re.compile(r"(\]\(\s*)([^)\s]+)(\s*(?:\"[^\"]*\")?\))")
FENCE = re.compile(r"\s*(```+|~~~+)")
ITEM = re.compile(r"(\s*)([-*+]|\d+\.)\s+")

# The pages of the API: title, and what the headers of each begin with.
TOPICS = {
    "reading": ("Reading and describing", ["error.h", "io/", "reflectance/", "source.h"]),
    "models": ("Models and their files", ["factors/"]),
    "fitting": ("Fitting and errors", ["fitting/", "metrics/"]),
    "evaluating": ("Evaluating and sampling", ["eval/factored_eval.h", "eval/sampler_expression.h",
                                              "eval/tabulated_sampler.h", "formula/"]),
    "surfaces": ("Surfaces", ["capture/", "eval/spatial_eval.h", "surface/"]),
    "export": ("Export, shaders, textures", ["export/", "image/", "render/", "shaders/", "textures/"]),
    "libraries": ("Libraries", ["library/"]),
    "power": ("The specular power", ["eval/power_span.h", "power/"]),
    "installed": ("Installed with them", ["Installed with them"]),
}

# The guide in the order in which a new user reads it; a page that is missing here is an error.
GUIDE = {
    "Start": ["fitting", "fit-options", "formats", "own-sources", "tables"],
    "Sources": ["scattered", "nodes", "analytic", "materials", "transmission"],
    "Use": ["evaluation", "python", "shaders", "rendering", "area-lights", "drawing", "export", "studio"],
    "More than one": ["surfaces", "library", "cluster"],
    "Highlights": ["specular", "hardware"],
    "Install": ["packages"],
}


def slug(heading):
    """The anchor of a heading, as GitHub makes it."""
    title = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w\- ]", "", title.strip().lower()).replace(" ", "-")


def slugify(text, separator):
    """slug() for MkDocs."""
    return slug(text)


def headings(text):
    """The text of every heading that stands in no code."""
    fence = None
    for line in text.split("\n"):
        mark = FENCE.match(line)
        if mark and (fence is None or mark.group(1).startswith(fence)):
            fence = None if fence else mark.group(1)
        elif fence is None and (heading := re.match(r"#{1,6}\s+(.*?)\s*#*$", line)):
            yield heading.group(1)


def tracked(pattern):
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", pattern], cwd=ROOT, check=True,
                            capture_output=True, text=True).stdout.split("\n")
    return sorted(ROOT / name for name in listed if name and (ROOT / name).exists())


def place_of(source):
    """Where a file of the repository lies in the site."""
    name = source.relative_to(ROOT).as_posix()
    if name == "README.md":
        return "index.md"
    if name.startswith("docs/"):
        return name.removeprefix("docs/")
    return name if source.suffix in {".md", ".png", ".svg"} else name + ".txt"


def api_pages():
    """{topic: text} of docs/api.md, cut at its headers."""
    text = (ROOT / "docs/api.md").read_text(encoding="utf-8")
    head, *sections = re.split(r"^(?=## )", text, flags=re.M)
    pages = {name: f"# {title}\n\n" for name, (title, _) in TOPICS.items()}
    for section in sections:
        header = section.split("\n", 1)[0].removeprefix("## ")
        topic = next((name for name, (_, starts) in TOPICS.items() if header.startswith(tuple(starts))), None)
        if topic is None:
            sys.exit(f"docs/api.md: expected a topic of docs/make_site.py for '{header}', found none")
        pages[topic] += section
    pages["index"] = head
    return pages


class Links:
    """Turns links between files of the repository into links between pages of the site."""

    def __init__(self, pages, notebooks):
        self.pages = set(pages)
        self.notebooks = notebooks  # whether they are pages
        self.extra = set()  # files that pages link to
        self.api = {slug(h): name for name, text in api_pages().items() for h in headings(text)}

    def place(self, aim, anchor):
        """(place in the site, anchor)"""
        if aim == ROOT / "docs/api.md":
            return f"api/{self.api.get(anchor, 'index')}.md", anchor
        if aim.is_dir():
            aim = aim / "README.md"
        if not aim.exists():
            sys.exit(f"{aim.relative_to(ROOT)}: expected a file that a page links to, found none")
        if self.notebooks and aim.suffix == ".ipynb":
            return f"notebooks/{aim.stem}.md", anchor
        if aim not in self.pages:
            self.extra.add(aim)
        return place_of(aim), anchor

    def rewrite(self, text, source, place):
        """The text of a page with its links changed, for its place in the site."""
        def change(found):
            target = found.group(2)
            if re.match(r"[a-z][a-z0-9+.-]*:|#", target):
                return found.group(0)
            name, _, anchor = target.partition("#")
            aim, anchor = self.place((source.parent / name).resolve(), anchor)
            up = "../" * place.count("/")
            return found.group(1) + up + aim + ("#" + anchor if anchor else "") + found.group(3)
        return outside_code(text, lambda line: LINK.sub(change, line))


def outside_code(text, change):
    """The text with a change made to each line that stands in no fenced code."""
    lines, fence = [], None
    for line in text.split("\n"):
        mark = FENCE.match(line)
        if mark and (fence is None or mark.group(1).startswith(fence)):
            fence = None if fence else mark.group(1)
        lines.append(line if fence or mark else change(line))
    return "\n".join(lines)


def as_python_markdown(text):
    """Lists as Python's Markdown wants them: an empty line before, and four columns a level."""
    lines, before = [], ""
    in_list = False

    def change(line):
        nonlocal before, in_list
        item = ITEM.match(line)
        if item and before.strip() and not in_list and not before.startswith(("|", "    ")):
            line = "\n" + line
        in_list = bool(item) or (in_list and (not line.strip() or line.startswith(" ")))
        before = line
        if in_list and line.startswith("  ") and (not item or item.group(1)):
            return "  " + line if not line.startswith("    ") else line
        return line
    return outside_code(text, change)


def hover_cards():
    """Abbreviations of Markdown: each symbol and code name of docs/notation.md with what it means."""
    cards = {}
    for line in (ROOT / "docs/notation.md").read_text(encoding="utf-8").split("\n"):
        cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if len(cells) < 4 or set(cells[0]) <= {"-"} or cells[0] == "symbol":
            continue
        symbols, codes, unit, meaning = cells[0], cells[1], cells[2], cells[3]
        meaning = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", meaning.replace("`", "").replace("\\|", "|"))
        said = f"{meaning} [{unit}]" if unit and unit != "1" else meaning
        names = re.split(r",\s*(?![^()]*\))", symbols) + re.findall(r"`([a-z]+_[a-z_]+)`", codes)
        for name in names:
            if re.fullmatch(r"\w*_\w+|[^\W\d_a-zA-Z]\w*", name.strip()) and said:
                cards.setdefault(name.strip(), said)
    return "".join(f"\n*[{name}]: {said}" for name, said in sorted(cards.items()))


def navigation(titles, notebooks, studio):
    """The menu: (title, place) or (title, list)."""
    def page(source):
        return {titles[source]: place_of(source)}

    guides = {p.stem: p for p in tracked("docs/guide/*.md")}
    listed = [name for names in GUIDE.values() for name in names]
    if set(listed) != set(guides):
        sys.exit(f"docs/make_site.py: expected in GUIDE the pages of docs/guide, found these apart: "
                 f"{', '.join(sorted(set(listed) ^ set(guides)))}")
    menu = [{"Start": "index.md"},
            {"Guide": [{part: [page(guides[n]) for n in names]} for part, names in GUIDE.items()]}]
    if notebooks:
        menu.append({"Notebooks": [{title: place} for title, place in notebooks]})
    menu += [{"Results": [page(p) for p in tracked("docs/results/*.md")]},
             {"Notes": [page(p) for p in tracked("docs/notes/*.md")]},
             {"API": ["api/index.md"] + [{title: f"api/{name}.md"} for name, (title, _) in TOPICS.items()]},
             {"Notation": "notation.md"}]
    shown = {place_of(p) for folder in ["guide", "results", "notes"] for p in tracked(f"docs/{folder}/*.md")}
    shown |= {"index.md", "notation.md"}
    menu.append({"Work on it": [page(p) for p in titles if place_of(p) not in shown and p.name != "api.md"]})
    if studio:
        menu.append({"Studio": "studio/index.html"})
    return menu


def notebook_page(book, folder, rewrite):
    """The Markdown of an executed notebook, rewrite() of its texts; its pictures are written to a folder."""
    parts, pictures = [], 0
    for cell in book["cells"]:
        text = "".join(cell["source"])
        parts.append(rewrite(text) if cell["cell_type"] == "markdown" else f"```python\n{text}\n```")
        for output in cell.get("outputs", []):
            data = output.get("data", {})
            if "image/png" in data:
                pictures += 1
                picture = folder / f"{folder.name}-{pictures}.png"
                picture.parent.mkdir(parents=True, exist_ok=True)
                picture.write_bytes(base64.b64decode(data["image/png"]))
                parts.append(f"![What the cell above draws]({folder.name}/{picture.name})")
            elif said := "".join(output.get("text", data.get("text/plain", ""))).rstrip():
                parts.append(f"```text\n{said}\n```")
    return "\n\n".join(parts) + "\n"


def execute_notebooks():
    """Executes docs/notebooks by build/venv into build/notebooks; false where that lacks what they need."""
    python = ROOT / "build/venv/bin/python"
    if not python.exists() or subprocess.run([python, "-c", "import burnish, matplotlib, nbclient, ipykernel"],
                                             capture_output=True).returncode:
        print("docs/make_site.py: build/venv cannot run notebooks, so the site has none (`make python` installs it)")
        return False
    if subprocess.run([python, ROOT / "docs/notebooks/run.py", "--out", ROOT / "build/notebooks"]).returncode:
        sys.exit(1)
    return True


def notebook_pages(links):
    """[(title, place, text)] of the executed notebooks."""
    found = []
    for file in tracked("docs/notebooks/*.ipynb"):
        place = f"notebooks/{file.stem}.md"
        book = json.loads((ROOT / "build/notebooks" / file.name).read_text(encoding="utf-8"))
        text = notebook_page(book, STAGE / "notebooks" / file.stem,
                             lambda part, file=file, place=place: links.rewrite(part, file, place))
        found.append((next(headings(text)), place, text))
    return found


def copy_to_stage(aim, place):
    path = STAGE / place
    path.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(aim, path)


def stage(with_notebooks):
    """Writes all pages to STAGE and returns the menu."""
    with_notebooks = with_notebooks and execute_notebooks()
    shutil.rmtree(STAGE, ignore_errors=True)
    pages = [p for p in tracked("*.md") if p != ROOT / "docs/api.md" and p.name != "questions.md"]
    links, cards = Links(pages, with_notebooks), hover_cards()
    titles = {p: next(headings(p.read_text(encoding="utf-8")), p.stem) for p in pages}
    texts = {place_of(p): links.rewrite(p.read_text(encoding="utf-8"), p, place_of(p)) for p in pages}
    for name, text in api_pages().items():
        texts[f"api/{name}.md"] = links.rewrite(text, ROOT / "docs/api.md", f"api/{name}.md")
    texts["api/index.md"] += "".join(f"- [{title}]({name}.md)\n" for name, (title, _) in TOPICS.items())
    texts = {place: as_python_markdown(text) for place, text in texts.items()}
    notebooks = notebook_pages(links) if with_notebooks else []
    texts |= {place: text for _, place, text in notebooks}
    for place, text in texts.items():
        path = STAGE / place
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text + "\n" + cards + "\n", encoding="utf-8")
    for aim in sorted(links.extra) + tracked("docs/figures/*"):
        copy_to_stage(aim, place_of(aim))
    for name in ["docs/site/site.css", "docs/site/site.js", "web/studio/icon.svg"]:
        copy_to_stage(ROOT / name, f"site/{pathlib.Path(name).name}")
    studio = (ROOT / "build/studio/index.html").exists()
    if studio:
        shutil.copytree(ROOT / "build/studio", STAGE / "studio", ignore=shutil.ignore_patterns("*.md"))
    else:
        print("docs/make_site.py: build/studio is missing, so the site has no studio (`make studio` makes it)")
    return navigation(titles, [(title, place) for title, place, _ in notebooks], studio)


def build(menu, out):
    from mkdocs.commands.build import build as build_site
    from mkdocs.config import load_config
    from mkdocs.exceptions import Abort
    import logging
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s: %(message)s")
    config = load_config(str(ROOT / "docs/site/mkdocs.yml"), docs_dir=str(STAGE), site_dir=str(out), nav=menu)
    config.mdx_configs.setdefault("toc", {})["slugify"] = slugify
    counter = logging.Handler(logging.WARNING)
    counter.emit = lambda record: warnings.append(record)
    warnings = []
    logging.getLogger("mkdocs").addHandler(counter)
    try:
        build_site(config)
    except Abort:
        return 1
    return 1 if warnings else 0


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--out", type=pathlib.Path, default=ROOT / "build/site")
    arguments.add_argument("--no-notebooks", action="store_true")
    given = arguments.parse_args()
    status = build(stage(not given.no_notebooks), given.out)
    if status == 0:
        print(f"{given.out}: {sum(1 for _ in given.out.rglob('*.html'))} pages")
    return status


if __name__ == "__main__":
    sys.exit(main())
