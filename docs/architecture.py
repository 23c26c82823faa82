"""Draws docs/architecture.svg, the plan of the house, from the lists of docs/architecture.md.

    python3 docs/architecture.py
"""

import pathlib
import re
from xml.sax.saxutils import escape

DOCS = pathlib.Path(__file__).parent
FLOORS = {  # from above, with the colour of its boxes
    "app": "#f3e3d3",
    "render": "#e3ecd8",
    "storage": "#d8e6ee",
    "mapping": "#ece0ee",
    "estimator": "#f2e9c9",
}
BOX_WIDTH, BOX_HEIGHT, GAP, ROW_GAP, MARGIN, LABEL_WIDTH = 138, 28, 22, 26, 16, 92
MAX_IN_ROW = 5


def read_rows():
    text = (DOCS / "architecture.md").read_text()
    rows = re.findall(r"^\* `([a-z/]+)`(?: \(([a-z/, ]*)\))?: .+$", text, re.M)
    return {folder: [f"{folder.split('/')[0]}/{use.strip()}" for use in uses.split(",") if use.strip()]
            for folder, uses in rows if folder.split("/")[0] in FLOORS}


def level(folder, uses):
    """How many folders of its floor stand one above the other below it."""
    return 1 + max((level(used, uses) for used in uses[folder]), default=-1)


def reaches(folder, goal, uses):
    return folder == goal or any(reaches(used, goal, uses) for used in uses[folder])


def drawn(folder, uses):
    """The folders that it uses but for those that one of the others uses: fewer arrows tell as much."""
    used = uses[folder]
    return [one for one in used if not any(other != one and reaches(other, one, uses) for other in used)]


def rows_of(floor, uses):
    """The folders of a floor in rows, those that are used below those that use them."""
    levels = {}
    for folder in uses:
        if folder.split("/")[0] == floor:
            levels.setdefault(level(folder, uses), []).append(folder)
    rows = []
    for height in sorted(levels, reverse=True):
        folders = sorted(levels[height])
        count = -(-len(folders) // MAX_IN_ROW)
        size = -(-len(folders) // count)
        rows += [folders[i:i + size] for i in range(0, len(folders), size)]
    return rows


def place(uses):
    """The corner of each folder's box, each floor's band as (top, bottom), and the picture's size."""
    widest = MAX_IN_ROW * (BOX_WIDTH + GAP) - GAP
    corners, bands, y = {}, {}, MARGIN
    for floor in FLOORS:
        top = y
        y += GAP
        for row in rows_of(floor, uses):
            x = MARGIN + LABEL_WIDTH + (widest - len(row) * (BOX_WIDTH + GAP) + GAP) / 2
            for folder in row:
                corners[folder] = (x, y)
                x += BOX_WIDTH + GAP
            y += BOX_HEIGHT + ROW_GAP
        y += GAP - ROW_GAP
        bands[floor] = (top, y)
        y += GAP
    return corners, bands, (MARGIN + LABEL_WIDTH + widest + MARGIN, y)


def arrow(start, end):
    x1, y1 = start[0] + BOX_WIDTH / 2, start[1] + BOX_HEIGHT
    x2, y2 = end[0] + BOX_WIDTH / 2, end[1]
    bend = max(18, (y2 - y1) / 2)
    return (f'<path d="M{x1:.0f},{y1:.0f} C{x1:.0f},{y1 + bend:.0f} {x2:.0f},{y2 - bend:.0f} {x2:.0f},{y2 - 3:.0f}" '
            'marker-end="url(#tip)"/>')


def picture(uses):
    corners, bands, (width, height) = place(uses)
    yield (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height:.0f}" '
           'font-family="DejaVu Sans, Verdana, sans-serif">')
    yield "<title>Folders of the five floors and the arrows between them</title>"
    yield ('<defs><marker id="tip" viewBox="0 0 6 6" refX="5" refY="3" markerWidth="6" markerHeight="6" '
           'orient="auto"><path d="M0,0 6,3 0,6z" fill="#7a7a7a"/></marker></defs>')
    yield '<rect width="100%" height="100%" fill="#ffffff"/>'
    for floor, (top, bottom) in bands.items():
        yield (f'<rect x="{MARGIN / 2}" y="{top:.0f}" width="{width - MARGIN:.0f}" height="{bottom - top:.0f}" rx="6" '
               f'fill="{FLOORS[floor]}" fill-opacity="0.45"/>')
        yield (f'<text x="{MARGIN + 2}" y="{(top + bottom) / 2 + 5:.0f}" font-size="16" font-weight="bold" '
               f'fill="#333333">{floor}</text>')
    yield '<g fill="none" stroke="#8a8a8a" stroke-width="0.9" stroke-opacity="0.75">'
    for folder in uses:
        yield from (arrow(corners[folder], corners[used]) for used in drawn(folder, uses))
    yield "</g>"
    for folder, (x, y) in corners.items():
        floor, _, name = folder.partition("/")
        yield (f'<rect x="{x:.0f}" y="{y:.0f}" width="{BOX_WIDTH}" height="{BOX_HEIGHT}" rx="4" '
               f'fill="{FLOORS[floor]}" stroke="#666666"/>')
        yield (f'<text x="{x + BOX_WIDTH / 2:.0f}" y="{y + BOX_HEIGHT / 2 + 4:.0f}" font-size="12" '
               f'text-anchor="middle" fill="#111111">{escape(name or "main")}</text>')
    yield "</svg>"


(DOCS / "architecture.svg").write_text("\n".join(picture(read_rows())) + "\n")
