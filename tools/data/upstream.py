"""What a set is made of, out of its upstream repository: exactly one commit, only the paths that are needed."""
import os
import subprocess
import sys
from pathlib import Path

from table import KitError, sha256_of

PUBLIC = "https://github.com/"


def address(repository, mirror):
    """Where the repository is fetched: itself, or below another base, MIRROR/OWNER/NAME or MIRROR/OWNER/NAME.git."""
    if not mirror:
        return repository
    below = repository.removeprefix(PUBLIC)
    if "://" in mirror:
        return f"{mirror.rstrip('/')}/{below}"
    bare = Path(mirror).resolve() / (below + ".git")
    folder = bare if bare.exists() else bare.with_name(Path(below).name)
    if not folder.exists():
        raise KitError(f"no repository at {folder}: --mirror names a folder that holds OWNER/NAME or OWNER/NAME.git")
    return folder.as_uri()


def git(folder, *words, text=None, shown=False):
    command = ["git", "-C", str(folder), "-c", "core.autocrlf=false", "-c", "advice.detachedHead=false", *words]
    try:
        run = subprocess.run(command, input=text, text=True, check=False, env=dict(os.environ, GIT_TERMINAL_PROMPT="0"),
                             stdout=subprocess.PIPE, stderr=None if shown else subprocess.PIPE)
    except FileNotFoundError as error:
        raise KitError("git is not installed: tools/setup.sh installs it") from error
    if run.returncode != 0:
        told = (run.stderr or "").strip().splitlines()
        raise KitError(f"`git {' '.join(words)}` failed: {' / '.join(told[-2:]) or 'see above'}")


def pattern_of(path):
    """As a line of a sparse checkout: from the top, a folder with all below it."""
    return path.removeprefix("**/") if path.startswith("**/") else "/" + path


def fetch(data_set, mirror, folder):
    """Brings the files that the set's converters read into folder."""
    url = address(data_set.repository, mirror)
    paths = sorted({p for f in data_set.files for p in f.upstream})
    folder.mkdir(parents=True)
    print(f"  fetching {len(paths)} paths of {url} at {data_set.commit[:12]}", flush=True)
    shown = sys.stderr.isatty()
    try:
        git(folder, "init", "-q")
        git(folder, "remote", "add", "origin", url)
        progress = ["--progress"] if shown else []
        git(folder, "fetch", *progress, "--no-tags", "--depth", "1", "--filter=blob:none", "origin", data_set.commit, shown=shown)
        git(folder, "sparse-checkout", "set", "--no-cone", "--stdin", text="".join(pattern_of(p) + "\n" for p in paths))
        git(folder, "checkout", *progress, "--detach", "FETCH_HEAD", shown=shown)
    except KitError as error:
        raise KitError(f"{url} could not be fetched: {error}\n  Is there a network? A folder that has the data serves as well: "
                       "--from DIR; another place of the repositories: --mirror BASE") from error


def check(data_set, folder):
    """The files as the table knows them, or a refusal."""
    for file in data_set.files:
        for path, expected in zip(file.upstream, file.upstream_sha256):
            found = sha256_of(folder, path)
            if found != expected:
                raise KitError(f"{data_set.repository} {path}: sha256 differs\n  expected {expected}\n  found    {found or 'no such file'}\n"
                               "  The repository is not what the table was made of. Report it; nothing of it was used.")
