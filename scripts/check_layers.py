#!/usr/bin/env python3
"""Checks that the folders include each other only as agreed, that Kokkos stays where it belongs, and that no kernel
reaches through `this`.

Prints file:line for each breach; exit code 1 if there is any.
"""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

# Folder -> the folders it may include, besides itself.
ALLOWED = {
    "core": set(),
    "kernels": {"core"},
    "fem": {"core"},
    "io": {"core"},
    "coupling": {"core", "kernels", "fem"},
    "app": {"core", "kernels", "fem", "io", "coupling"},
}
ALLOWED["bench"] = set(ALLOWED)
ALLOWED["tests"] = set(ALLOWED)
ALLOWED_TO_FILE = {"app/main.cpp": {"bench"}}  # where the verbs come together
WITHOUT_KOKKOS = ("io", "fem")
WITH_KERNELS = ("core", "kernels", "coupling", "bench")
INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')

# Where a lambda begins that may capture `this`, up to its body; and a member in the body, by the underscore at its end.
LAMBDA = re.compile(r"(?:\bKOKKOS_(?:CLASS_)?LAMBDA\b|\[\s*(?:=|(?:=\s*,\s*)?\*?\s*this)\s*\])[^{;]*\{")
MEMBER = re.compile(r"\bthis\b|(?<!->)(?<!\.)(?<!::)\b[a-z]\w*_\b")
TEXT = re.compile(r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'')


def code_lines(path):
    """The lines of a file with comments blanked, so that text about Kokkos is free."""
    text = re.sub(r"/\*.*?\*/", lambda m: "\n" * m[0].count("\n"), path.read_text(), flags=re.S)
    return [line.split("//")[0] for line in text.splitlines()]


def brings_kokkos(header, seen):
    """Whether including this header of ours includes Kokkos, directly or through others."""
    path = ROOT / header
    if header in seen or not path.is_file():
        return False
    seen.add(header)
    found = [m[2] for m in map(INCLUDE.match, code_lines(path)) if m]
    return any(name.startswith("Kokkos") for name in found) or any(brings_kokkos(name, seen) for name in found)


def kernels_with_this(path):
    """Where the body of a kernel names `this` or a member, which on a device is an address of the host's."""
    code = TEXT.sub(lambda m: " " * len(m[0]), "\n".join(code_lines(path)))
    end = 0
    for start in LAMBDA.finditer(code):
        if start.end() <= end:
            continue  # inside the one before, and looked at with it
        depth, end = 1, start.end()
        while depth and end < len(code):
            depth += {"{": 1, "}": -1}.get(code[end], 0)
            end += 1
        for use in MEMBER.finditer(code, start.end(), end):
            yield code.count("\n", 0, use.start()) + 1, use[0]


def breaches(path):
    name = path.relative_to(ROOT).as_posix()
    folder = name.split("/")[0]
    allowed = ALLOWED[folder] | ALLOWED_TO_FILE.get(name, set())
    for number, line in enumerate(code_lines(path), 1):
        include = INCLUDE.match(line)
        if include:
            header, first = include[2], include[2].split("/")[0]
            if include[1] == '"' and first in ALLOWED and first != folder and first not in allowed:
                yield number, f"{folder}/ must not include {first}/ ({header})"
            if folder in WITHOUT_KOKKOS and (header.startswith("Kokkos") or brings_kokkos(header, set())):
                yield number, f"{folder}/ must stay free of Kokkos, which {header} brings"
        if name == "core/kokkos.hpp":
            continue
        if "KOKKOS_VERSION" in line:
            yield number, "only core/kokkos.hpp may ask for the version of Kokkos (KOKKOS_VERSION)"
        if "Kokkos::Experimental" in line:
            yield number, "only core/kokkos.hpp may use Kokkos::Experimental, which changes between versions"
        if "Kokkos::Tools::Experimental" in line and folder not in ("core", "tests"):
            yield number, "only core/ and tests/ may use Kokkos::Tools::Experimental"
    if folder in WITH_KERNELS:
        for number, member in kernels_with_this(path):
            yield number, f"a kernel must not reach through this ({member}): copy what it needs into a local before it"


def main():
    files = sorted(p for folder in ALLOWED for end in ("hpp", "cpp") for p in (ROOT / folder).rglob(f"*.{end}"))
    count = 0
    for path in files:
        for number, what in breaches(path):
            print(f"{path.relative_to(ROOT)}:{number}: {what}")
            count += 1
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
