#!/usr/bin/env python3
"""The shape of C++ code, and passages of its prose.

  code_shape.py shape DIR [--way FILE]         lines a file, a function, a class (median, 90 %, largest), files a folder, share
                                               of comment lines; with --way the types that this file names
  code_shape.py passages DIR --seed N --count N [--help-of PROGRAM]...     passages drawn at random, as they stand

Functions and classes are found by their braces: comments and literals are blanked, and what stands before a brace says what
it opens. Macros that open a brace are not understood. Tests count like any other code; generated and vendored folders (3rdparty,
build) do not.
"""
import argparse
import collections
import pathlib
import random
import re
import statistics
import subprocess
import sys

SUFFIXES = {".h", ".hpp", ".cpp", ".cc", ".cxx"}
LEFT_OUT = {"build", "3rdparty", "third_party", ".git", "node_modules"}
TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|R"([^(\s]*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.S)
CONTROL = re.compile(r"\b(if|for|while|switch|catch|do|else|try|return|case|default)\b[^;{}]*$")
CLASS = re.compile(r"\b(class|struct)\s+(?:\[\[[^]]*\]\]\s*|[A-Z_]+\s+)*[A-Za-z_]\w*(?:<[^{}]*>)?(?:::\w+)*\s*(?:final\s*)?(?::[^:(].*)?$", re.S)
FUNCTION = re.compile(r"\)\s*(?:const|noexcept(?:\([^)]*\))?|override|final|mutable|&{1,2}|->\s*[\w:<>,&*\s]+|\s)*(?::(?!:).*)?$", re.S)


def sources(root):
    for path in sorted(root.rglob("*")):
        if path.suffix in SUFFIXES and not LEFT_OUT & set(path.relative_to(root).parts) and path.is_file():
            yield path


def blanked(text):
    """Comments and literals as blanks of the same shape, and the numbers of lines that hold nothing but comment."""
    comment_lines = set()

    def blank(match):
        token = match[0]
        if token.startswith(("//", "/*")):
            first = text.count("\n", 0, match.start())
            comment_lines.update(range(first, first + token.count("\n") + 1))
        return "".join(c if c == "\n" else " " for c in token)

    bare = TOKEN.sub(blank, text)
    lines = bare.split("\n")
    return bare, {i for i in comment_lines if not lines[i].strip()}


def extents(bare):
    """Lines of each function and class: from the beginning of its head to its closing brace."""
    functions, classes, stack, head = [], [], [], 0
    bare = re.sub(r"(?m)^[ \t]*#(?:.*\\\n)*.*$", lambda m: re.sub(r"[^\n]", " ", m[0]), bare)
    for at, sign in ((m.start(), m[0]) for m in re.finditer(r"[{};]", bare)):
        if sign == "{":
            text = bare[head:at].strip()
            text = re.sub(r"^(?:(?:public|private|protected)(?:\s+\w+)?\s*:\s*)+", "", text)
            inside = any(kind == "function" for kind, _ in stack)
            begin = bare.count("\n", 0, at - len(bare[head:at].lstrip()))
            if CLASS.search(text) and not text.endswith(")") and not inside:
                stack.append(("class", begin))
            elif not inside and FUNCTION.search(text) and not CONTROL.search(text) and "=" not in text.split("(")[0].replace("operator=", ""):
                stack.append(("function", begin))
            else:
                stack.append(("other", begin))
            head = at + 1
        elif sign == "}":
            if stack:
                kind, begin = stack.pop()
                n_lines = bare.count("\n", 0, at) - begin + 1
                if kind == "function":
                    functions.append(n_lines)
                elif kind == "class":
                    classes.append(n_lines)
            head = at + 1
        else:
            head = at + 1
    return functions, classes


def three(values):
    """Median, 90th percentile (nearest rank) and largest."""
    if not values:
        return "none"
    values = sorted(values)
    return f"{statistics.median(values):g} {values[-(-9 * len(values) // 10) - 1]} {values[-1]}"


def shape(root, way):
    n_lines, functions, classes, folders, n_comment, n_all = [], [], [], collections.Counter(), 0, 0
    for path in sources(root):
        text = path.read_text(encoding="utf-8", errors="replace")
        bare, comments = blanked(text)
        n_lines.append(text.count("\n") + (not text.endswith("\n")))
        n_comment += len(comments)
        n_all += sum(bool(line.strip()) for line in text.split("\n"))
        folders[path.parent] += 1
        of_functions, of_classes = extents(bare)
        functions += of_functions
        classes += of_classes
    if not n_lines:
        sys.exit(f"code_shape: {root}: no C++ source")
    print(f"{len(n_lines)} files of {three(n_lines)} lines; {len(functions)} functions of {three(functions)}; "
          f"{len(classes)} classes of {three(classes)}; {len(folders)} folders of {three(list(folders.values()))} files; "
          f"comments {100 * n_comment / n_all:.1f} % of the lines that are not empty")
    if way:
        bare, _ = blanked((root / way).read_text(encoding="utf-8", errors="replace"))
        bare = re.sub(r"(?m)^[ \t]*#.*$|^\s*(class|struct)\s+\w+;", "", bare)
        names = [n for n in dict.fromkeys(re.findall(r"\b[A-Z][a-z0-9]+(?:[A-Z][a-z0-9]*)*\b", bare))]
        print(f"{len(names)} in {way}: {' '.join(names)}")


def comments_of(path, text):
    """Blocks of whole comment lines, joined."""
    sign = "#" if path.suffix in (".sh", ".py") else "//"
    block, begin = [], 0
    for number, line in enumerate(text.split("\n") + [""], 1):
        bare = line.strip()
        if bare.startswith(sign) and not bare.startswith("#!"):
            begin = begin if block else number
            block.append(bare.lstrip(sign).strip())
        elif block:
            yield begin, " ".join(block)
            block = []


def paragraphs_of(text):
    """Paragraphs and list items of a document; tables, code and headings left out."""
    begin, block = 0, []
    for number, line in enumerate(text.split("\n") + [""], 1):
        stops = not line.strip() or line.startswith(("#", "|", "    ", "<!--", "- ", "* "))
        if stops and block:
            yield begin, " ".join(block)
            block = []
        if line.strip() and not line.startswith(("#", "|", "    ", "<!--")):
            begin = begin if block else number
            block.append(line.strip().removeprefix("- ").removeprefix("* "))


def help_of(command):
    """Meanings in a program's help: indented text behind two blanks, with its continuation lines."""
    run = subprocess.run(command.split(), capture_output=True, text=True, check=True)
    block, begin = [], 0
    for number, line in enumerate(run.stdout.split("\n") + [""], 1):
        match = re.match(r"\s*\S.*?\s{2,}(\S.*)|\s{8,}(\S.*)", line)
        if match and match[2] and block:
            block.append(match[2])
            continue
        if block:
            yield begin, " ".join(block)
        block, begin = ([match[1] or match[2]], number) if match else ([], 0)


def passages(root, seed, count, programs):
    found = []
    for path in sorted(p for p in root.rglob("*") if p.is_file() and not LEFT_OUT & set(p.relative_to(root).parts)):
        if path.suffix not in SUFFIXES | {".sh", ".py", ".md"}:
            continue
        text, name = path.read_text(encoding="utf-8", errors="replace"), path.relative_to(root)
        pieces = paragraphs_of(text) if path.suffix == ".md" else comments_of(path, text)
        found += [(f"{name}:{line}", piece) for line, piece in pieces]
    for program in programs:
        found += [(f"{program}:{line}", piece) for line, piece in help_of(program)]
    found = [(where, piece) for where, piece in found if len(piece.split()) >= 8]  # shorter ones are labels
    print(f"# {len(found)} passages of eight words or more")
    for where, piece in random.Random(seed).sample(found, min(count, len(found))):
        print(f"{where}\t{piece}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("shape", "passages"))
    parser.add_argument("root", type=pathlib.Path)
    parser.add_argument("--way")
    parser.add_argument("--seed", type=int, default=1001)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--help-of", action="append", default=[])
    a = parser.parse_args()
    if a.what == "shape":
        shape(a.root, a.way)
    else:
        passages(a.root, a.seed, a.count, a.help_of)


if __name__ == "__main__":
    main()
