"""Write the files of a design into its folder, one by one, and lose nothing of the user's.

1. A file is ours if the manifest lists it, and it has the SHA-256 of the manifest. All else is the
   user's, each link too. It is never replaced, moved or deleted. Where it is in the place of a file
   of ours, the build is refused before it changes anything.
2. All texts are on the disk, in temporary files, before the first file is replaced: a full disk
   changes nothing. Then come a manifest with the key ``unfinished``, the files, the deletion of
   outdated files, and the manifest without that key. So a folder is complete if its manifest has no
   such key, and its files have the sums of the manifest.
3. ``unfinished`` has the sums of our files from before. So the next build after a kill knows all
   our files, old or new, and completes the folder.
4. Only the path that the user named may have links. Below, each folder is opened in the one above
   it, without following links, and on the same mount.
5. A manifest may come from anyone: it deletes no file whose name is not like those of firm-hdl.
6. One build at a time writes. The lock is on the folder itself: it leaves no file, and ends with
   its process. Folders are never replaced, so programs in them can stay there.
"""

from __future__ import annotations

import errno
import hashlib
import json
import os
import re
import secrets
import stat
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from fcntl import LOCK_EX, LOCK_NB, flock
from pathlib import Path, PurePath
from typing import Any

from firm_hdl.export.backend import BuildError
from firm_hdl.export.manifest import MANIFEST, to_json
from firm_hdl.files import write_new

__all__ = ["build_folder", "check_folder", "read_manifest"]

LOCK_SECONDS = 60.0
"""Longest wait for another build that writes the folder. Writing takes less than a second."""

_UNFINISHED = "unfinished"
_TEMPORARY = re.compile(r"\.firm-hdl-[0-9a-f]{16}\.tmp")
_MOST_BYTES = 1 << 28
_MOST_NAME = 300

_OURS = (
    r"((vhdl|systemverilog|ip/\w+(/xgui)?)/)?(Makefile|((tb_)?DESIGN\w*|firm_hdl_\w+|"
    r"\w+_(cdr|ros1)_\d+\w*_pkg|README|bench_files|bitstream|component|datasheet|files|layout|"
    r"link|package|pins|plan|report|run_ghdl|run_iverilog|run_verilator|stimuli|summary|top|vivado|"
    r"vunit_run|waivers)\.(bin|bit|core|f|h|html|lpf|md|pcf|py|qip|rdl|sh|sv|svg|tcl|sdc|txt|v|veo|vhd|vlt|xdc|"
    r"xml|yaml))"
)
"""Names of the files that firm-hdl writes, and deletes if they are outdated."""


def build_folder(
    out: Path,
    folder: Path,
    inputs: Mapping[str, Any],
    make: Callable[[], tuple[Mapping[str, str], Mapping[str, Any]]],
    *,
    force: bool = False,
) -> tuple[str, ...] | None:
    """Write a folder of files, unless it is current.

    * `out`, `folder`: the path that the user named, and the folder below it.
    * `inputs`: what the files depend on, as the manifest has it.
    * `make`: returns texts by paths in the folder, and the manifest, which has their sums as
      ``files``.
    * `force`: write the folder even if it is current.

    Returns: outdated files that are the user's by now, and stay; `None` if the folder was current.

    Raises `BuildError` if something of the user's is in the way, or the folder cannot be written.
    """
    if not force and _is_current(out, folder, inputs):
        return None
    files, manifest = make()
    with _reported(folder):
        return _write(out, folder, files, manifest)


def check_folder(out: Path, folder: Path) -> dict[str, Any]:
    """Return the manifest of a folder that can be written; an empty mapping if it is new.

    Raises `BuildError` if firm-hdl did not make the folder, or it cannot be read.
    """
    with _reported(folder), suppress(FileNotFoundError), _opened(out, folder) as root:
        return _manifest_to_replace(root, folder)
    return {}


def read_manifest(folder: Path) -> dict[str, Any] | None:
    """Return a folder's manifest; `None` if firm-hdl did not make the folder."""
    with suppress(OSError), _opened(folder, folder) as root:
        return _manifest(root)
    return None


def _is_current(out: Path, folder: Path, inputs: Mapping[str, Any]) -> bool:
    """Return whether a folder is complete, and made from these inputs."""
    # The names in a manifest may be no names of files.
    with suppress(OSError, ValueError), _opened(out, folder) as root:
        _lock(root)
        found = _manifest(root)
        return (
            found is not None
            and found["inputs"] == inputs
            and _UNFINISHED not in found
            and all(_sum(root, name) == value for name, value in found["files"].items())
        )
    return False


def _write(
    out: Path, folder: Path, files: Mapping[str, str], manifest: Mapping[str, Any]
) -> tuple[str, ...]:
    new: Mapping[str, str] = manifest["files"]
    with _opened(out, folder, make=True) as root, ExitStack() as stack:
        _lock(root)
        known = _known(_manifest_to_replace(root, folder), new, folder.name)
        found: dict[str, str | None] = {}
        in_the_way: set[str] = set()
        kept: set[str] = set()
        for name in sorted({*known, *new}):
            place = name
            try:
                found[name] = _sum(root, name)
            except _InTheWayError as other:
                found[name], place = "", other.filename
            if found[name] not in {None, new.get(name), *known.get(name, ())}:
                (in_the_way if name in new else kept).add(place)
        if in_the_way:
            raise BuildError(
                f"'{folder}' has files of yours, or changed ones, where firm-hdl writes its own; "
                f"move them away, or delete them: {_listed(in_the_way)}"
            )
        changed = [name for name in new if found[name] != new[name]]
        outdated = [name for name in known if name not in new and found[name] in known[name]]
        for name in [*changed, *outdated]:
            with suppress(FileNotFoundError), _subfolder(root, name) as (where, _):
                if not os.access(".", os.W_OK | os.X_OK, dir_fd=where):
                    raise PermissionError(errno.EACCES, "its folder is read-only", name)

        def stage(name: str, text: str) -> str:
            temporary = f".firm-hdl-{secrets.token_hex(8)}.tmp"
            stack.callback(_discard, root, temporary)
            mode = 0o777 if name.endswith(".sh") else 0o666
            # Bytes of the user's files that are not UTF-8 stay as they are.
            data = text.encode("utf-8", "surrogateescape")
            write_new(temporary, data, mode, folder=root)
            return temporary

        before = {n: s if (s := found[n]) in known[n] else min(known[n]) for n in known}
        staged = {name: stage(name, files[name]) for name in changed}
        first = stage(MANIFEST, to_json({_UNFINISHED: before, **manifest}))
        last = stage(MANIFEST, to_json(manifest))
        # From here on, there are only renames and deletions.
        if changed or outdated:
            os.replace(first, MANIFEST, src_dir_fd=root, dst_dir_fd=root)
        for name in [*changed, *outdated]:
            if _sum(root, name) != found[name]:
                raise OSError(errno.EBUSY, "it was changed during the build", name)
            with _subfolder(root, name, make=True) as (where, own):
                if name in new:
                    os.replace(staged[name], own, src_dir_fd=root, dst_dir_fd=where)
                else:
                    os.unlink(own, dir_fd=where)
        # Inner folders first; one with files of the user's stays.
        for subfolder in sorted(_folders(known) - _folders(new), reverse=True):
            with suppress(OSError):
                os.rmdir(subfolder, dir_fd=root)
        os.replace(last, MANIFEST, src_dir_fd=root, dst_dir_fd=root)
    return tuple(sorted(kept))


def _known(old: Mapping[str, Any], new: Mapping[str, str], design: str) -> dict[str, set[str]]:
    """Return the files that are replaced or deleted, if they have one of the sums here."""
    ours = re.compile(_OURS.replace("DESIGN", re.escape(design)), re.ASCII | re.IGNORECASE)
    # Some file systems do not distinguish upper and lower case.
    folded = {name.casefold() for name in new}
    known: dict[str, set[str]] = {}
    for key in ("files", _UNFINISHED):
        for name, value in old.get(key, {}).items():
            is_ours = len(name) <= _MOST_NAME and ours.fullmatch(name)
            if name in new or (is_ours and name.casefold() not in folded):
                known.setdefault(name, set()).add(value)
    return known


def _folders(names: Iterable[str]) -> set[str]:
    """Return the subfolders of files, with all folders above them."""
    return {str(folder) for name in names for folder in PurePath(name).parents} - {"."}


def _listed(names: set[str]) -> str:
    first, rest = sorted(names)[:10], len(names) - 10
    return ", ".join(first) + (f" and {rest} more" if rest > 0 else "")


# A folder, its lock, and its manifest.


class _InTheWayError(OSError):
    """A link, a mount, or another kind of file is in the place of a file or folder of ours."""

    def __init__(self, place: str):
        super().__init__(errno.EEXIST, "something of yours is in the way", place)


@contextmanager
def _reported(folder: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        name = error.filename
        is_named = isinstance(name, str) and not _TEMPORARY.fullmatch(name)
        what = f" ('{name}')" if is_named else ""
        raise BuildError(f"'{folder}' cannot be written: {error.strerror}{what}") from None


@contextmanager
def _opened(out: Path, folder: Path, *, make: bool = False) -> Iterator[int]:
    """Open a folder below a path of the user's."""
    if make:
        # If the path is a link to nothing, what it leads to is made.
        with suppress(FileExistsError):
            os.makedirs(os.path.realpath(out))
    with ExitStack() as stack:
        root = os.open(out, os.O_RDONLY | os.O_DIRECTORY)
        stack.callback(os.close, root)
        for part in folder.relative_to(out).parts:
            above, root = root, _enter(root, part, make=make)
            stack.callback(os.close, root)
            if _mount(root) != _mount(above):
                raise _InTheWayError(part)
        yield root


@contextmanager
def _subfolder(root: int, name: str, *, make: bool = False) -> Iterator[tuple[int, str]]:
    """Open the subfolder of a file; yield it, and the file's own name."""
    *folders, own = name.split("/")
    with ExitStack() as stack:
        where = root
        for depth, part in enumerate(folders, 1):
            try:
                where = _enter(where, part, make=make)
            except NotADirectoryError:
                raise _InTheWayError("/".join(folders[:depth])) from None
            stack.callback(os.close, where)
            if _mount(where) != _mount(root):
                raise _InTheWayError("/".join(folders[:depth]))
        yield where, own


def _enter(above: int, name: str, *, make: bool) -> int:
    if make:
        with suppress(FileExistsError):
            os.mkdir(name, dir_fd=above)
    try:
        return os.open(name, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW, dir_fd=above)
    except OSError as error:
        if error.errno not in (errno.ELOOP, errno.ENOTDIR):
            raise
        raise NotADirectoryError(errno.ENOTDIR, "a link, or not a folder", name) from None


def _mount(file: int) -> str:
    """Return the mount of an open file; a bind mount has the device of another one."""
    with suppress(OSError, StopIteration), open(f"/proc/self/fdinfo/{file}", "rb") as lines:
        return str(next(line for line in lines if line.startswith(b"mnt_id:")))
    return str(os.fstat(file).st_dev)


def _lock(root: int) -> None:
    """Wait for the lock of a folder; delete temporary files that a killed build left."""
    end = time.monotonic() + LOCK_SECONDS
    while True:
        try:
            flock(root, LOCK_EX | LOCK_NB)
            break
        except BlockingIOError:
            if time.monotonic() > end:
                reason = "another process has been writing there for a minute"
                raise OSError(errno.EBUSY, reason) from None
            time.sleep(0.02)
        except OSError:
            # A file system without locks. The temporary files may be those of another build.
            return
    for name in filter(_TEMPORARY.fullmatch, os.listdir(root)):
        _discard(root, name)


def _discard(root: int, temporary: str) -> None:
    with suppress(OSError):
        if stat.S_ISREG(os.stat(temporary, dir_fd=root, follow_symlinks=False).st_mode):
            os.unlink(temporary, dir_fd=root)


def _manifest(root: int) -> dict[str, Any] | None:
    try:
        found = json.loads(_read(root, MANIFEST) or b"")
    except (OSError, ValueError, RecursionError):
        return None
    if not isinstance(found, dict) or not isinstance(found.get("inputs"), dict):
        return None
    for sums in (found.get("files"), found.get(_UNFINISHED, {})):
        if not isinstance(sums, dict) or not all(isinstance(each, str) for each in sums.values()):
            return None
    return found if isinstance(found.get("inputs_sha256"), str) else None


def _manifest_to_replace(root: int, folder: Path) -> dict[str, Any]:
    # Another build may be writing. Its manifest comes first, so it is looked for last.
    is_new = all(_TEMPORARY.fullmatch(name) for name in os.listdir(root))
    found = _manifest(root)
    if found is None and not is_new:
        with suppress(FileNotFoundError):
            is_file = stat.S_ISREG(os.stat(MANIFEST, dir_fd=root, follow_symlinks=False).st_mode)
            if is_file and not os.access(MANIFEST, os.R_OK, dir_fd=root):
                raise PermissionError(errno.EACCES, "its manifest cannot be read", MANIFEST)
        raise BuildError(f"'{folder}' is not a folder that firm-hdl made; move it away")
    return found or {}


# Its files.


def _read(root: int, name: str) -> bytes | None:
    """Return the content of a file, or `None` if nothing is in its place."""
    try:
        with _subfolder(root, name) as (where, own):
            status = os.stat(own, dir_fd=where, follow_symlinks=False)
            if not stat.S_ISREG(status.st_mode) or status.st_size > _MOST_BYTES:
                raise _InTheWayError(name)
            flags = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK
            with open(os.open(own, flags, dir_fd=where), "rb") as file:
                if _mount(file.fileno()) != _mount(where):
                    raise _InTheWayError(name)
                return file.read(_MOST_BYTES)
    except FileNotFoundError:
        return None
    except PermissionError:
        raise _InTheWayError(name) from None


def _sum(root: int, name: str) -> str | None:
    data = _read(root, name)
    return None if data is None else hashlib.sha256(data).hexdigest()
