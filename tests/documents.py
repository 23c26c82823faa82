"""Holds the documents to the program: links lead somewhere, quoted messages are said, and command
lines use commands and options that exist.

    documents.py ROOT             0 if all hold; else 1, and each breach on stderr
    documents.py ROOT PROGRAM     checks the command lines as well, against the help of the program
"""

import pathlib
import re
import shlex
import subprocess
import sys

FLOORS = ("estimator", "mapping", "storage", "render", "app")
LINK = re.compile(r"(?<!\!)\[[^\]]*\]\(([^)\s]+)\)|!\[[^\]]*\]\(([^)\s]+)\)")


def anchors_of(page):
    """Returns the anchors of a page's headings, as GitHub makes them."""
    text = re.sub(r"```.*?```", "", page.read_text(), flags=re.S)
    headings = re.findall(r"^#+ (.*)$", text, re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-") for heading in headings}


def broken_links(root, pages):
    for page in pages:
        for match in LINK.finditer(page.read_text()):
            target = match[1] or match[2]
            if re.match(r"[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            file = (page.parent / path).resolve() if path else page
            if not file.exists():
                yield f"{page.relative_to(root)}: links to {target}, which does not exist"
            elif anchor and file.suffix == ".md" and anchor not in anchors_of(file):
                yield f"{page.relative_to(root)}: links to {target}, a heading that does not exist"


def unsaid_messages(root):
    """Messages in the first column of tables of docs/troubleshooting.md that no source contains;
    ' … ' stands for what varies."""
    sources = [file for floor in FLOORS for file in (root / floor).rglob("*.cpp")]
    said = "\n".join(re.sub(r'"\s*\n\s*"', "", file.read_text()) for file in sources)
    page = root / "docs" / "troubleshooting.md"
    quoted = [span for row in re.findall(r"^\| (.*?) \|", page.read_text(), re.M) for span in re.findall(r"`([^`]+)`", row)]
    if not quoted:
        yield f"{page.relative_to(root)}: quotes no message"
    for message in quoted:
        for part in message.split("…"):
            if part.strip() and part.strip() not in said and not part.strip().startswith("--"):
                yield f"{page.relative_to(root)}: quotes '{message}', but no source says '{part.strip()}'"


def command_lines(page):
    """Command lines of macadam in indented blocks, without remarks, pipes and redirections."""
    for line in page.read_text().splitlines():
        match = re.match(r" {4,}(?:.*\| )?macadam (.*)$", line)
        if match:
            words = re.split(r"\s(?:#|\||>|2>|&&)", match[1])[0]
            yield line.strip(), shlex.split(words.replace("'", "’") if words.count("'") % 2 else words)


def unknown_options(root, pages, program):
    known = {}
    lines = 0
    for page in pages:
        for line, words in command_lines(page):
            if not words or words[0].startswith("-") or words[0] in ("COMMAND", "help") or "..." in words[0]:
                continue
            lines += 1
            if words[0] not in known:
                answer = subprocess.run([program, words[0], "--help-all"], capture_output=True, text=True, check=False)
                known[words[0]] = answer.stdout if answer.returncode == 0 else None
            help_text = known[words[0]]
            where = f"{page.relative_to(root)}: '{line}'"
            if help_text is None:
                yield f"{where}: no command {words[0]}"
                continue
            options = set(re.findall(r"(?<![\w-])--?[a-z][\w-]*", help_text)) | {"--help", "--help-all"}
            for word in words[1:]:
                name = word.split("=")[0]
                if re.fullmatch(r"--?[a-z][\w-]*", name) and name not in options:
                    yield f"{where}: {words[0]} has no option {name}"
    if lines < 50:
        yield f"only {lines} command lines were found in the documents, expected 50 or more"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    pages = [*sorted(root.glob("*.md")), *sorted((root / "docs").rglob("*.md")), *sorted((root / "sample_data").rglob("*.md"))]
    breaches = [*broken_links(root, pages), *unsaid_messages(root)]
    if len(sys.argv) > 2:
        current = [page for page in pages if page.name != "CHANGELOG.md" and "decisions" not in page.parts]
        breaches += unknown_options(root, current, sys.argv[2])
    for breach in breaches:
        print(breach, file=sys.stderr)
    print(f"{len(pages)} documents, {len(breaches)} breaches")
    sys.exit(1 if breaches or not pages else 0)


if __name__ == "__main__":
    main()
