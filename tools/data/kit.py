"""tools/data.sh: brings the public measured data that the measured tests and the figures read."""
import argparse
import os
import shutil
import signal
import sys
from pathlib import Path

import upstream
from convert import COMPARED, EXPORTED
from table import KitError, read_table, sha256_of

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
MADE_HERE = ".made_here"  # sha256, one per line, of files made here whose bytes differ from the table's but compared well

TEXT = """\
Brings the public measured data that the measured tests and the figures read to this machine. tools/data/table.toml says of
each set: upstream repository, commit, paths, sha256, licence, converter, and what is known of it independently.

  tools/data.sh                        fetch all sets from their public repositories with git, convert them (some 170 MB to
                                       download, 80 MB to keep, a few minutes; needs tools/setup.sh --data once)
  tools/data.sh tuning_forks           only this one; several names are several sets
  tools/data.sh --from DIR             take them from a folder that has them: DIR/SET/FILE
  tools/data.sh --list                 what there is, from where, under which licence, and what of it is here
  tools/data.sh --check                whether the files here are those of the table

A file whose sha256 is not the table's is refused, and nothing is overwritten. What is here already is not fetched again.
Tests and figures read the folder that HOVERMODAL_DATA names, else ../shared/data beside the project where that exists, else
data in the project; without --to the data go there."""

ENDS = "Exit status: 0 done, 1 something is missing, failed or was refused, 2 wrong usage."


def default_folder():
    """As tests/support/measured_data.h and tools/figures/lib.sh find it."""
    if named := os.environ.get("HOVERMODAL_DATA"):
        return Path(named)
    shared = ROOT.parent / "shared" / "data"
    return shared if shared.is_dir() else ROOT / "data"


def arguments():
    parser = argparse.ArgumentParser(prog="tools/data.sh", description=TEXT, epilog=ENDS, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sets", nargs="*", metavar="SET", help="names of sets, as --list prints them (default: all)")
    parser.add_argument("--from", dest="source", metavar="DIR", type=Path, help="take the sets from this folder, not from the network")
    parser.add_argument("--to", metavar="DIR", type=Path, help="folder to bring them to (default: the one that tests and figures read)")
    parser.add_argument("--list", action="store_true", help="print the sets and end")
    parser.add_argument("--check", nargs="?", const="", metavar="DIR", help="compare the files in DIR (default: as --to) with the table and end")
    parser.add_argument("--mirror", metavar="BASE", help="fetch BASE/OWNER/NAME in place of https://github.com/OWNER/NAME: an address, or a folder")
    parser.add_argument("--table", metavar="FILE", type=Path, default=HERE / "table.toml", help=argparse.SUPPRESS)
    return parser.parse_args()


def state_of(data_set, folder):
    """Names of the set's files that are right, missing, and different (with the sha256 found) in folder/SET."""
    right, missing, different = [], [], {}
    compared = folder / data_set.name / MADE_HERE
    made_here = compared.read_text().split() if compared.is_file() else []
    for file in data_set.files:
        found = sha256_of(folder / data_set.name, file.name)
        if found is None:
            missing.append(file)
        elif file.accepts(found) or found in made_here:
            right.append(file)
        else:
            different[file] = found
    return right, missing, different


def print_list(sets, folder):
    for s in sets:
        right, missing, different = state_of(s, folder)
        here = "here" if not missing and not different else "not here" if not right and not different else f"{len(right)} of {len(s.files)} files here"
        print(f"{s.name} ({here} in {folder})\n  {s.what}\n  from     {s.repository} at {s.commit[:12]}\n  licence  {s.licence}")
        print(f"  known    {s.answer}\n  made by  {', '.join(sorted({f.converter for f in s.files}))}")
        if s.note:
            print(f"  note     {s.note}")


def refusal(path, file, found, remedy):
    also = "".join(f"\n        or {other}" for other in file.also)
    return KitError(f"{path}: refused, its sha256 is not the table's\n  expected {file.sha256}{also}\n  found    {found or 'no such file'}\n  {remedy}")


def check_folder(sets, folder):
    n_wrong = 0
    for s in sets:
        right, missing, different = state_of(s, folder)
        for file, found in different.items():
            print(refusal(folder / s.name / file.name, file, found, "Move it away and bring it again: tools/data.sh " + s.name))
        for file in missing:
            print(f"{folder / s.name / file.name}: not here (tools/data.sh {s.name} brings it)" if file.is_public else
                  f"{folder / s.name / file.name}: not here, and in no public repository (tools/data.sh --from DIR {s.name} takes it)")
        n_wrong += len(missing) + len(different)
        print(f"{s.name}: {len(right)} of {len(s.files)} as in the table")
    return 1 if n_wrong else 0


def take(data_set, files, source, part):
    """From a folder that has them."""
    for file in files:
        origin = source / data_set.name / file.name
        found = sha256_of(source / data_set.name, file.name)
        if found is None:
            raise KitError(f"{origin}: not there\n  --from names the folder that holds {data_set.name}/; without --from it is fetched.")
        if not file.accepts(found):
            raise refusal(origin, file, found, "Another version or a damaged copy: take it from elsewhere, or fetch it (without --from).")
        print(f"  {file.name}", flush=True)
        EXPORTED["copy"](source / data_set.name, [file.name], part / file.name.rstrip("/"))
        if sha256_of(part, file.name) != found:
            raise KitError(f"{part / file.name}: the copy differs from {origin}: is the disk full or damaged?")


def compare(data_set, file, repository, part):
    """Accepts or refuses what a converter has made: by its sha256, else by its content where its converter knows how."""
    found = sha256_of(part, file.name)
    if file.accepts(found):
        return
    remedy = "The converter gives other bytes on this machine: report its versions of python3, numpy, scipy, ffmpeg; or --from DIR."
    if file.converter in COMPARED:
        function, limit, unit = COMPARED[file.converter]
        value = function(repository, file.upstream, part / file.name)
        if value is not None and value <= limit:
            print(f"  {file.name} has other bytes than the table's (another version of a program); accepted: {value:.2f} {unit}", flush=True)
            with open(part / MADE_HERE, "a", encoding="utf-8") as accepted:
                accepted.write(found + "\n")
            return
        remedy = f"{'Frames are missing' if value is None else f'{value:.2f} {unit}'}; at most {limit} are accepted. " + remedy
    raise refusal(f"{data_set.name}/{file.name} as made here", file, found, remedy)


def make(data_set, files, mirror, part):
    """Out of the upstream repository."""
    repository = part.with_name(part.name + ".git")
    shutil.rmtree(repository, ignore_errors=True)
    try:
        upstream.fetch(data_set, mirror, repository)
        upstream.check(data_set, repository)
        for file in files:
            print(f"  {file.name}", flush=True)
            EXPORTED[file.converter](repository, file.upstream, part / file.name.rstrip("/"))
            compare(data_set, file, repository, part)
    finally:
        shutil.rmtree(repository, ignore_errors=True)


def bring(data_set, options, folder):
    """The files of one set that are not here yet: all of them come whole, or none. Returns those that no repository has."""
    right, missing, different = state_of(data_set, folder)
    for file, found in different.items():
        raise refusal(folder / data_set.name / file.name, file, found, "Nothing is overwritten: move it away and run this again, or bring the data elsewhere (--to).")
    wanted = missing if options.source else [f for f in missing if f.is_public]
    if wanted:
        print(f"{data_set.name}: {len(wanted)} of {len(data_set.files)} files to bring", flush=True)
        part = folder / f".{data_set.name}.part"
        shutil.rmtree(part, ignore_errors=True)
        part.mkdir(parents=True)
        try:
            take(data_set, wanted, options.source, part) if options.source else make(data_set, wanted, options.mirror, part)
            (folder / data_set.name).mkdir(exist_ok=True)
            for entry in sorted(part.iterdir()):
                os.replace(entry, folder / data_set.name / entry.name)
        finally:
            shutil.rmtree(part, ignore_errors=True)
    lacking = [f for f in missing if f not in wanted]
    print(f"{data_set.name}: {len(right) + len(wanted)} of {len(data_set.files)} files, {len(wanted)} of them new", flush=True)
    return lacking


def bring_all(sets, options, folder):
    if options.source and not options.source.is_dir():
        raise KitError(f"{options.source}: no such folder: --from names one that holds a folder for each set")
    n_refused = 0
    for s in sets:
        try:
            for file in bring(s, options, folder):
                print(f"  {file.name} is in no public repository: only --from DIR brings it", flush=True)
        except KitError as error:
            n_refused += 1
            print(f"{s.name}: {error}", file=sys.stderr, flush=True)
    if n_refused:
        print(f"data: {n_refused} of {len(sets)} sets could not be brought to {folder}", file=sys.stderr)
        return 1
    print(f"data: {len(sets)} sets in {folder}")
    if folder.resolve() != default_folder().resolve():
        print(f"  tests and figures read them with HOVERMODAL_DATA={folder}")
    return 0


def main():
    options = arguments()
    try:
        folder = options.to or default_folder()
        table = read_table(options.table)
        if options.check in table:  # --check SET: DIR was omitted
            options.sets.insert(0, options.check)
            options.check = ""
        for name in options.sets:
            if name not in table:
                raise KitError(f"{name}: no such set; there are {', '.join(table)}")
        sets = [table[name] for name in options.sets or table]
        if options.list:
            print_list(sets, folder)
            return 0
        if options.check is not None:
            return check_folder(sets, Path(options.check) if options.check else folder)
        return bring_all(sets, options, folder)
    except KitError as error:
        print(f"data: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"data: {error.filename or folder}: {error.strerror}: --to DIR brings the data to another folder", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("data: interrupted; sets that were whole stay, nothing of the others is left", file=sys.stderr)
        return 130


if __name__ == "__main__":
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    sys.exit(main())
