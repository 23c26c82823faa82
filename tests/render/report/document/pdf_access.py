"""Prints each way in which a PDF is not accessible (PDF/UA-1) or wastes paper: pdf_access.py FILE

Of ISO 14289-1 what a program can tell without knowing the content: title, language, structure,
reading of figures, tables, headings and links, marked content and its order, embedded fonts. Of paper: pages but
the last that are more than a third empty at their end.
"""

import subprocess
import sys

import pikepdf

PAINTING = {"Tj", "TJ", "'", '"', "f", "F", "f*", "B", "B*", "b", "b*", "S", "s", "sh", "Do"}


def elements(node, above=""):
    """Structure elements in reading order, each with the kind of its parent."""
    if isinstance(node, pikepdf.Array):
        for kid in node:
            yield from elements(kid, above)
    elif isinstance(node, pikepdf.Dictionary) and "/S" in node:
        yield node, above
        if "/K" in node:
            yield from elements(node.K, str(node.S))


def of_document(pdf):
    root = pdf.Root
    if not root.get("/MarkInfo", {}).get("/Marked", False):
        yield "is not tagged"
    if not str(root.get("/Lang", "")):
        yield "has no language"
    if not root.get("/ViewerPreferences", {}).get("/DisplayDocTitle", False):
        yield "does not show its title"
    with pdf.open_metadata() as metadata:
        if metadata.get("{http://www.aiim.org/pdfua/ns/id/}part") != "1" or not metadata.get("dc:title"):
            yield "has no metadata of PDF/UA"


def of_structure(pdf):
    level, cells, count = 0, [], 0
    parents = {"/TR": {"/Table"}, "/TH": {"/TR"}, "/TD": {"/TR"}, "/LI": {"/L"}, "/LBody": {"/LI"}, "/Lbl": {"/LI"}}
    for element, above in elements(pdf.Root.StructTreeRoot.K):
        kind = str(element.S)
        count += 1
        if kind in parents and above not in parents[kind]:
            yield f"{kind} lies in {above}"
        if kind == "/Figure" and not str(element.get("/Alt", "")).strip():
            yield "a figure has no text alternative"
        if kind == "/TH" and element.get("/A", {}).get("/Scope") not in ("/Column", "/Row"):
            yield "a heading of a table has no scope"
        if kind == "/Table":
            cells.append([])
        if kind == "/TR" and cells:
            cells[-1].append(0)
        if kind in ("/TH", "/TD") and cells:
            cells[-1][-1] += 1
        if kind[:2] == "/H" and kind[2:].isdigit():
            if int(kind[2:]) > level + 1:
                yield f"{kind} follows a heading of level {level}"
            level = int(kind[2:])
    if any(len(set(rows)) != 1 for rows in cells):
        yield "rows of a table have different numbers of cells"
    if count < 20 or not cells:
        yield f"has {count} elements, {len(cells)} of them tables"


def marked_by(pdf):
    """Numbers of marked content that the structure refers to, in reading order, by page."""
    found = {}

    def walk(node, page):
        if isinstance(node, pikepdf.Array):
            for kid in node:
                walk(kid, page)
        elif isinstance(node, pikepdf.Dictionary):
            page = node.get("/Pg", page)
            if "/MCID" in node:
                walk(int(node.MCID), page)
            if "/K" in node:
                walk(node.K, page)
        elif isinstance(node, int) and page is not None:
            found.setdefault(page.objgen, []).append(node)

    walk(pdf.Root.StructTreeRoot.K, None)
    return found


def of_page(number, page, read):
    depth, marked = 0, set()
    if page.get("/Tabs") != "/S":
        yield f"page {number} is not tabbed through in the order of its structure"
    for instruction in pikepdf.parse_content_stream(page):
        name = str(instruction.operator)
        depth += {"BDC": 1, "BMC": 1, "EMC": -1}.get(name, 0)
        if name == "BDC" and "/MCID" in instruction.operands[1]:
            marked.add(int(instruction.operands[1].MCID))
        if name in PAINTING and depth == 0:
            yield f"page {number} has '{name}' outside of marked content"
            break
        if depth not in (0, 1, 2):
            yield f"page {number} has marked content at depth {depth}"
            break
    if depth != 0:
        yield f"page {number} ends within marked content"
    if marked != set(read):
        yield f"page {number} has content that the structure does not read, or reads what is not there"
    if len(read) != len(set(read)):
        yield f"page {number} is read twice in parts"
    for link in page.get("/Annots", []):
        if not str(link.get("/Contents", "")) or "/StructParent" not in link:
            yield f"page {number} has a link without a description"
    for name, font in page.get("/Resources", {}).get("/Font", {}).items():
        descriptor = font.get("/FontDescriptor") or font.get("/DescendantFonts", [{}])[0].get("/FontDescriptor", {})
        if font.get("/Subtype") != "/Type3" and not {"/FontFile", "/FontFile2", "/FontFile3"} & set(descriptor.keys()):
            yield f"page {number} has the font {name}, which is not embedded"


def empty_share(file, number):
    """Share of a page between its margins that is white below the last ink, page number aside."""
    pgm = subprocess.run(["pdftoppm", "-r", "36", "-gray", "-f", str(number), "-l", str(number), file],
                         check=True, capture_output=True).stdout
    _, size, _, pixels = pgm.split(b"\n", 3)
    width, height = map(int, size.split())
    top, bottom = int(height * 0.06), int(height * 0.935)
    inked = [row for row in range(top, bottom) if min(pixels[row * width:(row + 1) * width]) < 235]
    return 1 - (inked[-1] - top) / (bottom - top) if inked else 1


def main(file):
    with pikepdf.open(file) as pdf:
        breaches = [*of_document(pdf), *of_structure(pdf)]
        read = marked_by(pdf)
        for number, page in enumerate(pdf.pages, 1):
            breaches += of_page(number, page, read.get(page.objgen, []))
            if number < len(pdf.pages) and (empty := empty_share(file, number)) > 1 / 3:
                breaches.append(f"page {number} is {empty:.0%} empty")
    print(*dict.fromkeys(breaches), sep="\n", end="\n" if breaches else "")


main(sys.argv[1])
