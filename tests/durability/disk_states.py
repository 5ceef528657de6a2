"""What a power cut may leave of the files of a process whose calls `tests/preload/io_record` has
written down.

The disk is a tree of folders and files in memory. A flush of a file makes its bytes durable, not
its name; a flush of a folder the names in it. Of what is not durable a cut leaves anything:

- of bytes: none, all, the right length with zeros (data=writeback of ext4), half, a first sector of
  zeros (sectors are written in any order);
- of names: none, all, those before some moment (the journal of ext4 keeps the order), any of them
  (file systems without such a journal). So a file that got its name without a flush may be empty.
"""

import os
import random

SECTOR = 512


class File:
    def __init__(self, data=b""):
        self.durable = data
        self.change(data)

    def change(self, data):
        self.bytes = data
        self.left = {}  # after a cut, by kind

    def write(self, offset, data):
        self.change(self.bytes[:offset].ljust(offset, b"\0") + data
                    + self.bytes[offset + len(data):])

    def truncate(self, length):
        self.change(self.bytes[:length].ljust(length, b"\0"))

    def flush(self):
        self.durable = self.bytes
        self.left = {}

    def after_cut(self, kind):
        if kind not in self.left:
            self.left[kind] = self.made_by_cut(kind)
        return self.left[kind]

    def made_by_cut(self, kind):
        new, old = self.bytes, self.durable
        if kind == "none" or new == old:
            return old
        same = len(old) if new.startswith(old) else len(os.path.commonprefix([new, old]))
        if kind == "zeros":
            return new[:same] + b"\0" * (len(new) - same)
        if kind == "half":
            return new[:same + (len(new) - same) // 2]
        if kind == "torn":
            end = min(len(new), (same // SECTOR + 1) * SECTOR)
            return new[:same] + b"\0" * (end - same) + new[end:]
        return new


class Folder:
    def __init__(self):
        self.names = {}
        self.durable = {}
        self.pending = []  # (moment, {name: node, None where it goes})

    def change(self, moment, names):
        self.pending.append((moment, names))
        self.apply(self.names, names)

    def flush(self):
        self.durable = dict(self.names)
        self.pending = []

    @staticmethod
    def apply(entries, names):
        for name, node in names.items():
            if node is None:
                entries.pop(name, None)
            else:
                entries[name] = node

    def after_cut(self, keeps):
        """Names, where keeps(moment) tells of each change that is not durable."""
        entries = dict(self.durable)
        for moment, names in self.pending:
            if keeps(moment):
                self.apply(entries, names)
        return entries


class Disk:
    """The folder `root`; what is there now is durable."""

    def __init__(self, root):
        self.root = root
        self.moment = 0
        self.flushed_at = 0  # what any flush of ext4 makes durable: all names before it
        self.top = self.load(root)

    def load(self, path):
        folder = Folder()
        for entry in os.scandir(path):
            if entry.is_dir():
                node = self.load(entry.path)
            else:
                with open(entry.path, "rb") as file:
                    node = File(file.read())
            folder.names[entry.name] = node
        folder.flush()
        return folder

    def find(self, path):
        """The folder that holds `path`, and its name there."""
        folder = self.top
        *parents, name = os.path.relpath(path, self.root).split("/")
        for parent in parents:
            folder = folder.names[parent]
        return folder, name

    def apply(self, call, path, number, data):
        self.moment += 1
        folder, name = self.find(path) if path != self.root else (Folder(), "")
        node = self.top if path == self.root else folder.names.get(name)
        if call == "mkdir":
            folder.change(self.moment, {name: Folder()})
        elif call == "create":
            folder.change(self.moment, {name: File()})
        elif call == "remove":
            folder.change(self.moment, {name: None})
        elif call in ("rename", "link"):
            target, new_name = self.find(data.decode())
            assert target is folder, "names change within a folder"
            folder.change(self.moment, {new_name: node} | ({name: None} if call == "rename" else {}))
        elif node is None:
            assert path.endswith(" (deleted)"), path
        elif call == "write":
            node.write(number, data)
        elif call == "truncate":
            node.truncate(number)
        else:
            assert call == "fsync", call
            node.flush()
            self.flushed_at = self.moment

    def cuts(self, seed):
        """States after a cut now, as (description, {path: bytes, None for a folder})."""
        chance = random.Random(seed * 1000003 + self.moment)
        until = chance.randint(self.flushed_at, self.moment)
        some = {moment: chance.random() < 0.5 for moment in range(self.moment + 1)}
        other = {moment: chance.random() < 0.8 for moment in range(self.moment + 1)}
        names = {"all": lambda _: True, "none": lambda _: False,
                 f"until {until}": lambda moment: moment <= until,
                 "half": some.get, "most": other.get}
        kinds = {kind: (lambda kind=kind: kind) for kind in ("none", "all", "zeros", "half", "torn")}
        kinds["any"] = lambda: chance.choice(("none", "all", "zeros", "half", "torn"))
        for of_names, keeps in names.items():
            for of_bytes, kind in kinds.items():
                yield (f"call {self.moment}, names {of_names}, bytes {of_bytes}",
                       dict(self.listed(self.top, "", keeps, kind)))

    def without_cut(self):
        return dict(self.listed(self.top, "", lambda _: True, lambda: "all"))

    def listed(self, folder, path, keeps, kind):
        for name, node in sorted(folder.after_cut(keeps).items()):
            if isinstance(node, Folder):
                yield path + name, None
                yield from self.listed(node, path + name + "/", keeps, kind)
            else:
                yield path + name, node.after_cut(kind())


def read_record(path):
    """The calls of a record: (call, path, number, bytes)."""
    with open(path, "rb") as file:
        while line := file.readline():
            call, name, number, size = line.decode().rstrip("\n").split("\t")
            yield call, name, int(number), file.read(int(size))


def put(state, root):
    """Writes a state to the empty folder `root`."""
    for name, data in state.items():
        if data is None:
            os.mkdir(os.path.join(root, name))
        else:
            with open(os.path.join(root, name), "wb") as file:
                file.write(data)
