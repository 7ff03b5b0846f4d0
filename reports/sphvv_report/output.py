"""Writes a report so that a failure leaves nothing half-written: all files first go to a temporary folder inside the
target, then move into place by renaming, the page last.
"""

import os
import shutil
import tempfile

MANIFEST = "manifest.txt"  # what the last report wrote: the only files a new report may remove


def write_files(folder, files):
    for name, content in files.items():
        path = os.path.join(folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as stream:
            stream.write(content if isinstance(content, bytes) else content.encode("utf-8"))
            stream.flush()
            os.fsync(stream.fileno())  # a full disk may only show here


def is_ours(name):
    """Whether a line of a manifest names a file that a report may have written."""
    parts = name.split("/")
    return name in ("index.html", "guide.tex") or (len(parts) == 2 and parts[0] in ("tables", "figures") and parts[1] not in ("", ".", ".."))


def stale_files(folder, files):
    """Files of the previous report that the new one does not have."""
    try:
        with open(os.path.join(folder, MANIFEST), encoding="utf-8") as stream:
            listed = stream.read().splitlines()
    except (OSError, UnicodeDecodeError):
        return []
    return [name for name in listed if is_ours(name) and name not in files]


def refuse_blocked(folder, files):
    """Raises before anything is moved where a folder stands in the way of a file."""
    for name in files:
        path = os.path.join(folder, name)
        if os.path.isdir(path):
            raise IsADirectoryError(21, "a folder of that name is in the way", path)


def move_into_place(staging, folder, files):
    refuse_blocked(folder, files)
    stale = stale_files(folder, files)
    for part in sorted({os.path.dirname(name) for name in files} - {""}):
        os.makedirs(os.path.join(folder, part), exist_ok=True)
    for name in sorted(files, key=lambda entry: (entry == "index.html", entry)):
        os.replace(os.path.join(staging, name), os.path.join(folder, name))
    for name in stale:
        if os.path.isfile(os.path.join(folder, name)):
            os.remove(os.path.join(folder, name))


def missing_ancestors(folder):
    """The folders that will have to be made, deepest first."""
    missing = []
    while not os.path.lexists(folder):
        missing.append(folder)
        folder = os.path.dirname(folder)
    return missing


def write_report(folder, files):
    """Writes {relative name: text or bytes} and a manifest into the folder, which is made if need be. Raises OSError."""
    folder = os.path.abspath(folder)
    made = missing_ancestors(folder)
    complete = dict(files)
    complete[MANIFEST] = "\n".join(sorted(files)) + "\n"
    staging = None
    try:
        os.makedirs(folder, exist_ok=True)
        staging = tempfile.mkdtemp(prefix=".sphvv-report-", dir=folder)
        write_files(staging, complete)
        move_into_place(staging, folder, complete)
    except BaseException:
        if staging:
            shutil.rmtree(staging, ignore_errors=True)
        for path in made:
            try:
                os.rmdir(path)  # only if empty: nothing of the user's is ever removed
            except OSError:
                break
        raise
    shutil.rmtree(staging, ignore_errors=True)
