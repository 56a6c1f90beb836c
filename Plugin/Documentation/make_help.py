#!/usr/bin/env python3
"""Converts the Markdown pages of this folder to HTML for ParaView's help, with their pictures.

    make_help.py CMARK_GFM OUTPUT_FOLDER

ParaView shows its help in a QTextBrowser, which knows HTML 4 in part: few styles (its own font for code, Courier, may be
missing), anchors as <a name="...">, pictures as large as they are unless they say their width. Links between pages become links to .html; links
to files that the help does not hold lose their target and keep their words.
"""
import html
import pathlib
import re
import shutil
import struct
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
WIDTH, WIDTH_IN_TABLE = 720, 360  # maximum width of a picture, pixels
PAGE = """<!DOCTYPE html>
<html>
<head><meta http-equiv="Content-Type" content="text/html; charset=utf-8"><title>%s</title>
<style type="text/css">pre, code { font-family: "DejaVu Sans Mono", monospace; }</style></head>
<body>
%s</body>
</html>
"""


def anchor(heading):
    """The anchor that GitHub gives to a heading, of its words without markup."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def plain(markup):
    return html.unescape(re.sub(r"<[^>]*>", "", markup))


def picture_width(file):
    """Columns of a PNG or JPEG picture."""
    data = file.read_bytes()
    if data.startswith(b"\x89PNG"):
        return struct.unpack(">I", data[16:20])[0]
    at = 2
    while not 0xC0 <= data[at + 1] <= 0xC3:  # skips the JPEG segments before the frame header, which holds the size
        at += 2 + struct.unpack(">H", data[at + 2:at + 4])[0]
    return struct.unpack(">H", data[at + 7:at + 9])[0]


def with_anchors(text):
    return re.sub(r"<h(\d)>(.*?)</h\1>",
                  lambda found: '<h%s><a name="%s"></a>%s</h%s>' % (found[1], anchor(plain(found[2])), found[2], found[1]),
                  text, flags=re.DOTALL)


def with_links(text, pages):
    """Links as the help has them: to pages as .html, to the world as they are, to other files none."""
    def link(found):
        target, fragment = (found[1].split("#", 1) + [""])[:2]
        if re.match(r"\w+:", target):
            return found[0]
        if target and target not in pages:
            return found[2]
        place = target[:-3] + ".html" if target else ""
        return '<a href="%s%s">%s</a>' % (place, "#" + fragment if fragment else "", found[2])
    return re.sub(r'<a href="([^"]*)">(.*?)</a>', link, text, flags=re.DOTALL)


def pictures_of(text):
    return set(re.findall(r'<img src="([^":]*)"', text))


def with_widths(text):
    """Pictures no wider than the help's window shows."""
    def shrink(most):
        def one(found):
            width = min(most, picture_width(HERE / found[1]))
            return '<img src="%s" width="%d"' % (found[1], width)
        return lambda part: re.sub(r'<img src="([^":]*)"', one, part)
    parts = re.split(r"(<table>.*?</table>)", text, flags=re.DOTALL)
    return "".join(shrink(WIDTH_IN_TABLE if part.startswith("<table>") else WIDTH)(part) for part in parts)


def page_of(file, cmark, pages):
    text = subprocess.run([cmark, "--extension", "table", "--unsafe", str(file)],
                          capture_output=True, text=True, check=True).stdout
    title = re.search(r"<h1>(.*?)</h1>", text)
    if not title:
        sys.exit("%s has no heading of the first level, which is its title in the help" % file)
    text = with_widths(with_links(with_anchors(text), pages))
    text = text.replace("<table>", '<table border="1" cellspacing="0" cellpadding="4">')
    return PAGE % (title[1], text)


def main(cmark, output):
    output = pathlib.Path(output)
    pages = sorted(HERE.glob("*.md"))
    shutil.rmtree(output, ignore_errors=True)
    (output / "images").mkdir(parents=True)
    for file in pages:
        text = page_of(file, cmark, {page.name for page in pages})
        for picture in pictures_of(text):
            shutil.copy(HERE / picture, output / picture)
        (output / (file.stem + ".html")).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
