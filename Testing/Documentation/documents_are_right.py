#!/usr/bin/env python3
"""Fails where the pages point to what is not there, leave a property out, or grow too long.

    documents_are_right.py ROOT [LINES]

ROOT is the repository. Looked at are README.md, CONTRIBUTING.md, CHANGELOG.md, Plugin/*/*.md and Data/**/*.md:
 - a relative link or picture leads to a file of the repository, and what follows its # to a heading there;
 - every filter of Plugin/ServerManager/*.xml has a section in the reference, and every property a place in it;
 - a block of code under <!-- quoted: FILE --> holds lines of FILE, in their order;
 - a C++ or OpenCL source that a page names (Folder/File.cxx) is in Kernels/, Filters/, Plugin/ or Testing/;
 - README.md has no more than LINES lines (150).
"""
import pathlib
import re
import sys
import xml.etree.ElementTree as ElementTree

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "Plugin/Documentation"))
from make_help import anchor  # noqa: E402

PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "Plugin/Documentation/*.md", "Plugin/Packaging/*.md",
         "Data/**/*.md")
LINK = re.compile(r"\]\(([^()\s]+)\)|<img [^>]*src=\"([^\"]+)\"")


def without_code(text):
    """The words alone, line by line: blocks of code become empty lines, spans of code nothing."""
    lines, fence = [], False
    for line in text.split("\n"):
        if line.lstrip().startswith("```"):
            fence, line = not fence, ""
        lines.append("" if fence else re.sub(r"`[^`]*`", "", line))
    return lines


def anchors_of(page):
    """The anchors of a page's headings; of several alike the second has -1, the third -2."""
    found, fence = set(), False
    for line in page.read_text(encoding="utf-8").split("\n"):
        if line.lstrip().startswith("```"):
            fence = not fence
        heading = re.match(r"#+ (.*)", line)
        if heading and not fence:
            words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1]).replace("`", "").replace("*", "")
            name = first = anchor(words)
            number = 0
            while name in found:
                number += 1
                name = "%s-%d" % (first, number)
            found.add(name)
    return found


def faults_of_links(root, page):
    for number, line in enumerate(without_code(page.read_text(encoding="utf-8")), 1):
        for target in (a or b for a, b in LINK.findall(line)):
            if re.match(r"\w+:", target):
                continue
            place, _, fragment = target.partition("#")
            file = (page.parent / place).resolve() if place else page
            where = "%s:%d" % (page.relative_to(root), number)
            if not file.is_relative_to(root) or not file.exists():
                yield "%s: there is no %s" % (where, place)
            elif fragment and (file.suffix != ".md" or fragment not in anchors_of(file)):
                yield "%s: %s has no heading #%s" % (where, file.relative_to(root), fragment)


def faults_of_quotations(root, page):
    text = page.read_text(encoding="utf-8")
    for name, block in re.findall(r"<!-- quoted: (\S+) -->\n+```\w*\n(.*?)```", text, re.DOTALL):
        rest = iter((root / name).read_text(encoding="utf-8").split("\n"))
        for line in filter(str.strip, block.split("\n")):
            if line not in rest:  # goes on behind the line that was found last
                yield "%s: '%s' is not in %s, or not there" % (page.relative_to(root), line.strip(), name)
                break


def faults_of_sources(root, page):
    for number, line in enumerate(page.read_text(encoding="utf-8").split("\n"), 1):
        for name in re.findall(r"(?<![\w/*])[A-Z]\w*(?:/\w+)*\.(?:cxx|cl|h)\b", line):
            places = [root / top for top in ("Kernels", "Filters", "Plugin", "Testing")]
            if not (root / name).exists() and not any(next(place.rglob(name), None) for place in places):
                yield "%s:%d: there is no source %s" % (page.relative_to(root), number, name)


def sections_of(page):
    parts = re.split(r"^## (.*)$", page.read_text(encoding="utf-8"), flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2]))


def is_internal(prop):
    """What ParaView and other properties read, and no user."""
    return prop.find("TimeStepsInformationHelper") is not None or prop.get("name").endswith("Info")


def faults_of_reference(root):
    sections = sections_of(root / "Plugin/Documentation/reference.md")
    for file in sorted((root / "Plugin/ServerManager").glob("*.xml")):
        for group in ElementTree.parse(file).getroot().findall("ProxyGroup"):
            if group.get("name").startswith(("internal", "views")):
                continue
            for proxy in (each for each in group if each.tag != "Extension"):
                name = proxy.get("name")
                if name not in sections:
                    yield "reference.md has no section %s" % name
                    continue
                properties = [child.get("name") for child in proxy if child.tag.endswith("Property") and not is_internal(child)]
                properties += [each.get("name") for each in proxy.findall("SubProxy/ExposedProperties/Property")
                               if not is_internal(each)]
                for prop in properties:
                    if "`%s`" % prop not in sections[name]:
                        yield "reference.md, section %s, leaves out %s" % (name, prop)


def main(root, most="150"):
    root = pathlib.Path(root).resolve()
    pages = sorted(page for pattern in PAGES for page in root.glob(pattern))
    faults = [fault for page in pages for fault in faults_of_links(root, page)]
    faults += [fault for page in pages for fault in faults_of_quotations(root, page)]
    faults += [fault for page in pages for fault in faults_of_sources(root, page)]
    faults += faults_of_reference(root)
    lines = len((root / "README.md").read_text(encoding="utf-8").splitlines())
    if lines > int(most):
        faults.append("README.md has %d lines, %s at most" % (lines, most))
    print("\n".join(faults) or "%d pages are right" % len(pages))
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
