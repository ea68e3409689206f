"""The table of the data kit (table.toml), and the sha256 of what it names: a file, or a folder's listing."""
import hashlib
import tomllib
from pathlib import Path

CHUNK = 1 << 20


class KitError(Exception):
    """What is wrong, with the values, and what to do."""


class File:
    """One resulting file, or a folder of files (name ends in /), and what it is made of."""

    def __init__(self, entry):
        self.name = entry["name"]
        self.sha256 = entry["sha256"]
        self.also = entry.get("also", [])  # sha256 of equally valid results
        sources = entry.get("upstream", [])
        self.upstream = [sources] if isinstance(sources, str) else sources
        hashes = entry.get("upstream_sha256", [])
        self.upstream_sha256 = [hashes] if isinstance(hashes, str) else hashes
        self.converter = entry.get("converter", "copy" if self.upstream else "none")

    @property
    def is_public(self):
        return self.converter != "none"

    def accepts(self, sha256):
        return sha256 == self.sha256 or sha256 in self.also


class Set:
    def __init__(self, name, entry):
        self.name = name
        self.what = entry["what"]
        self.repository = entry["repository"]  # https://github.com/OWNER/NAME
        self.commit = entry["commit"]
        self.licence = entry["licence"]
        self.answer = entry["known_answer"]
        self.note = entry.get("note", "")
        self.files = [File(f) for f in entry["file"]]
        for file in self.files:
            if len(file.upstream) != len(file.upstream_sha256):
                raise KitError(f"{name}/{file.name}: {len(file.upstream)} upstream paths with {len(file.upstream_sha256)} sha256")


def read_table(path):
    """Sets by name, in the order of the table."""
    try:
        entries = tomllib.loads(Path(path).read_text(encoding="utf-8"))
        return {name: Set(name, entry) for name, entry in entries.items()}
    except OSError as error:
        raise KitError(f"{path}: {error.strerror}: --table names the table") from error
    except (tomllib.TOMLDecodeError, KeyError) as error:
        raise KitError(f"{path}: not a table of data sets: {error}") from error


def sha256_of_file(path):
    digest = hashlib.sha256()
    with open(path, "rb") as data:
        while chunk := data.read(CHUNK):
            digest.update(chunk)
    return digest.hexdigest()


def sha256_of_listing(root, paths):
    """Of the lines of sha256sum, sorted by path:
    find . -type f -printf '%P\\n' | LC_ALL=C sort | xargs -d '\\n' sha256sum | sha256sum"""
    lines = "".join(f"{sha256_of_file(root / p)}  {p}\n" for p in sorted(paths))
    return hashlib.sha256(lines.encode()).hexdigest()


def files_below(folder):
    return [p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()]


def sha256_of(root, name):
    """Of a file, of a folder (NAME/), or of all files that a pattern (with *) finds below root; None where there is nothing."""
    if "*" in name:
        paths = [p.relative_to(root).as_posix() for p in root.glob(name) if p.is_file() and ".git" not in p.parts]
        return sha256_of_listing(root, paths) if paths else None
    path = root / name
    if name.endswith("/"):
        return sha256_of_listing(path, files_below(path)) if path.is_dir() else None
    return sha256_of_file(path) if path.is_file() else None
