"""A copy of the source tree, for what builds it changed."""

import pathlib
import shutil
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent


def copy_tree(target, added=None, left_out=lambda name: False):
    """Makes `target` hold the files that git knows or would add, as they are now, but for those whose name in the tree
    `left_out` tells, and `added`, sources by their names in the tree. A file that has not changed keeps its time, and the folder
    build stays, so that a copy from an earlier run is built again only where needed."""
    names = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True,
                           capture_output=True, text=True).stdout.split("\0")
    files = {name: ROOT / name for name in names if name and (ROOT / name).is_file() and not left_out(name)} | (added or {})
    for old in [path for path in target.rglob("*") if path.is_file()]:
        name = old.relative_to(target)
        if name.parts[0] != "build" and str(name) not in files:
            old.unlink()
    for name, source in files.items():
        copy = target / name
        if not copy.exists() or copy.read_bytes() != source.read_bytes():
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, copy)
